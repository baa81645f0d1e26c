// Where the cells of an eighth of a brick are in a scan. Compiled again for each instruction set:
// include it after Highway's foreach_target.h.
#if defined(SKYHALO_LOCATE_CELLS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef SKYHALO_LOCATE_CELLS_INL
#undef SKYHALO_LOCATE_CELLS_INL
#else
#define SKYHALO_LOCATE_CELLS_INL
#endif

#include <hwy/highway.h>

#include <array>
#include <cmath>
#include <numbers>

#include "skyhalo/geometry/arc_tangent-inl.hpp"
#include "skyhalo/map/float_vectors-inl.hpp"
#include "skyhalo/map/sweep_brick.hpp"

HWY_BEFORE_NAMESPACE();

namespace skyhalo::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Vectors from this length on take the records of a window.
constexpr std::size_t kWindowLanes = 16;

/// A window is as many directions wide and high.
constexpr int kWindowEdge = 4;

/// Four directions and those of the three rows below them; of rows that there are.
struct Window {  // NOLINT(*-member-init): see `find_window`
  std::int32_t row = 0;
  std::int32_t col = 0;
  std::array<std::size_t, 4> first;  // direction of each row
};

/// Where the cells of an eighth of a brick are in a scan, and what they get.
struct Places {  // NOLINT(*-member-init): filled before it is read
  HWY_ALIGN std::array<float, kEighthCells> range_m;
  HWY_ALIGN std::array<float, kEighthCells> row;  // from the middle of the direction
  HWY_ALIGN std::array<float, kEighthCells> col;
  HWY_ALIGN std::array<std::int32_t, kEighthCells> row_index;
  HWY_ALIGN std::array<std::int32_t, kEighthCells> col_index;
  HWY_ALIGN std::array<std::int16_t, kEighthCells> increment;
  Window window;
  bool in_window;  // all of them
};

/// Finds the directions of one vector of cells.
HWY_INLINE void locate(const SweepInput& input,
                       const Eigen::Vector3f& first_m,
                       std::size_t i,
                       Places& places) {
  const Floats d;
  const Integers di;
  const ScanPatches& patches = input.patches;
  const Vector rows_per_rad = set(static_cast<float>(patches.rows) * std::numbers::inv_pi_v<float>);
  const Vector x = hn::Add(set(first_m.x()), hn::LoadU(d, input.offsets.x_m.data() + i));
  const Vector y = hn::Add(set(first_m.y()), hn::LoadU(d, input.offsets.y_m.data() + i));
  const Vector z = hn::Add(set(first_m.z()), hn::LoadU(d, input.offsets.z_m.data() + i));
  const Vector level2 = hn::MulAdd(x, x, hn::Mul(y, y));
  const Vector range_m = square_root(hn::MulAdd(z, z, level2));
  const Vector row = hn::Mul(fast_arc_tangent(square_root(level2), z), rows_per_rad);
  const Vector col =
      hn::Mul(hn::Add(fast_arc_tangent(y, x), set(std::numbers::pi_v<float>)), rows_per_rad);
  const Whole row_index = hn::Min(hn::ConvertTo(di, row), hn::Set(di, patches.rows - 1));
  const Whole col_index = hn::ConvertTo(di, col);
  const Whole wrapped = hn::IfThenElseZero(hn::Lt(col_index, hn::Set(di, patches.cols)), col_index);
  const Vector half = set(0.5F);
  hn::StoreU(range_m, d, places.range_m.data() + i);
  hn::StoreU(hn::Sub(hn::Sub(row, hn::ConvertTo(d, row_index)), half), d, places.row.data() + i);
  hn::StoreU(hn::Sub(hn::Sub(col, hn::ConvertTo(d, col_index)), half), d, places.col.data() + i);
  hn::StoreU(row_index, di, places.row_index.data() + i);
  hn::StoreU(wrapped, di, places.col_index.data() + i);
}

/// The middle of a narrow eighth, as the frame that its cells are found in.
struct Sight {
  Eigen::Vector3f first_m;
  float sin_theta;
  float cos_theta;
  float sin_phi;
  float cos_phi;
  float row;  // of the middle; from the middle of the first direction
  float col;
  float rows_per_rad;
};

HWY_INLINE Sight sight_of(const SweepInput& input,
                          const Eigen::Vector3f& first_m,
                          std::size_t eighth) {
  const float x = input.eighths.x_m[eighth];
  const float y = input.eighths.y_m[eighth];
  const float z = input.eighths.z_m[eighth];
  const float level2 = x * x + y * y;
  const float level_m = std::sqrt(level2);
  const float per_range = 1.0F / std::sqrt(level2 + z * z);
  const float per_level = 1.0F / level_m;
  const float rows_per_rad = static_cast<float>(input.patches.rows) * std::numbers::inv_pi_v<float>;
  return {first_m,
          level_m * per_range,
          z * per_range,
          y * per_level,
          x * per_level,
          input.verdicts.theta_rad[eighth] * rows_per_rad - 0.5F,
          input.verdicts.phi_rad[eighth] * rows_per_rad - 0.5F,
          rows_per_rad};
}

/// The angle of a small tangent, up to `kNarrowRad`, within 1e-7: fitted to least greatest error.
HWY_INLINE Vector small_arc_tangent(Vector x) {
  const Vector x2 = hn::Mul(x, x);
  const Vector bend = polynomial(x2, -0.33321537F, 0.19158428F);
  return hn::MulAdd(hn::Mul(x, x2), bend, x);
}

/// The longest side of a triangle with a right angle, by another one and the tangent between them,
/// up to `kNarrowRad`, within 2e-7 of it; fitted as well.
HWY_INLINE Vector longer_side(Vector side, Vector tangent) {
  const Vector x2 = hn::Mul(tangent, tangent);
  const Vector longer = polynomial(x2, 0.49995634F, -0.12152741F);
  return hn::MulAdd(hn::Mul(side, x2), longer, side);
}

/// Stores which direction holds a place, counted in directions, along one axis, and where in it.
HWY_INLINE void store_direction(Vector place, std::int32_t* index, float* within) {
  const Floats d;
  const Integers di;
  // Adding this leaves no bits behind the point.
  const Vector whole = set(12582912.0F);
  const Vector rounded = hn::Add(place, whole);
  hn::StoreU(hn::Sub(hn::BitCast(di, rounded), hn::BitCast(di, whole)), di, index);
  hn::StoreU(hn::Sub(place, hn::Sub(rounded, whole)), d, within);
}

/// The same as `locate` for a narrow eighth: by angles from its middle, which are small.
HWY_INLINE void locate_near(const SweepInput& input,
                            const Sight& sight,
                            std::size_t i,
                            Places& places) {
  const Floats d;
  const Vector x = hn::Add(set(sight.first_m.x()), hn::LoadU(d, input.offsets.x_m.data() + i));
  const Vector y = hn::Add(set(sight.first_m.y()), hn::LoadU(d, input.offsets.y_m.data() + i));
  const Vector z = hn::Add(set(sight.first_m.z()), hn::LoadU(d, input.offsets.z_m.data() + i));
  const Vector sin_phi = set(sight.sin_phi);
  const Vector cos_phi = set(sight.cos_phi);
  const Vector ahead = hn::MulAdd(sin_phi, y, hn::Mul(cos_phi, x));
  const Vector aside = hn::NegMulAdd(sin_phi, x, hn::Mul(cos_phi, y));
  const Vector across = hn::Mul(aside, reciprocal(ahead));
  const Vector level_m = longer_side(ahead, across);
  const Vector sin_theta = set(sight.sin_theta);
  const Vector cos_theta = set(sight.cos_theta);
  const Vector along = hn::MulAdd(sin_theta, level_m, hn::Mul(cos_theta, z));
  const Vector down = hn::NegMulAdd(sin_theta, z, hn::Mul(cos_theta, level_m));
  const Vector below = hn::Mul(down, reciprocal(along));
  const Vector rows_per_rad = set(sight.rows_per_rad);
  hn::StoreU(longer_side(along, below), d, places.range_m.data() + i);
  store_direction(hn::MulAdd(small_arc_tangent(below), rows_per_rad, set(sight.row)),
                  places.row_index.data() + i,
                  places.row.data() + i);
  store_direction(hn::MulAdd(small_arc_tangent(across), rows_per_rad, set(sight.col)),
                  places.col_index.data() + i,
                  places.col.data() + i);
}

}  // namespace skyhalo::HWY_NAMESPACE

HWY_AFTER_NAMESPACE();

#endif

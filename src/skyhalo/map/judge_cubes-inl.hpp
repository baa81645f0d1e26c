// What a pyramid of patches decides of cubes. Compiled again for each instruction set: include it
// after Highway's foreach_target.h.
#if defined(SKYHALO_JUDGE_CUBES_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef SKYHALO_JUDGE_CUBES_INL
#undef SKYHALO_JUDGE_CUBES_INL
#else
#define SKYHALO_JUDGE_CUBES_INL
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <array>
#include <numbers>

#include "skyhalo/geometry/arc_tangent-inl.hpp"
#include "skyhalo/map/float_vectors-inl.hpp"
#include "skyhalo/map/patch_pyramid.hpp"

HWY_BEFORE_NAMESPACE();

namespace skyhalo::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

HWY_INLINE void store_bytes(Whole values, std::uint8_t* bytes) {
  const hn::Rebind<std::uint8_t, Floats> d;
  hn::StoreU(hn::DemoteTo(d, values), d, bytes);
}

/// At least asin(x) for x in [0, 1], with room for what rounding does.
HWY_INLINE Vector arc_sine_bound(Vector x) {
  const Vector slope = hn::IfThenElse(hn::Lt(x, set(0.5F)), set(1.0472F), set(1.5708F));
  return hn::MulAdd(x, slope, set(1e-4F));
}

/// Room for rounding, as a part of the range.
constexpr float kRounding = 1e-4F;

/// How far `square_root` is off at most where it begins with few bits, as a part of the root.
constexpr float kRootError = 4e-6F;

HWY_INLINE float radius_of(const Cubes& cubes) {
  return std::numbers::sqrt3_v<float> * cubes.half_edge_m * (1.0F + 1e-5F);
}

/// Finds the windows of one vector of cubes, by the balls that hold them.
HWY_INLINE void find_windows(const PatchPyramid& pyramid,
                             const Cubes& cubes,
                             std::size_t i,
                             float* ranges_m,
                             Verdicts& verdicts) {
  Windows& windows = verdicts.windows;
  const Floats d;
  const Integers di;
  constexpr float kPi = std::numbers::pi_v<float>;
  const Vector rows_per_rad = set(static_cast<float>(pyramid.rows) / kPi);
  const Vector pi = set(kPi);
  const Vector x = hn::LoadU(d, cubes.x_m.data() + i);
  const Vector y = hn::LoadU(d, cubes.y_m.data() + i);
  const Vector z = hn::LoadU(d, cubes.z_m.data() + i);
  const Vector level2 = hn::MulAdd(x, x, hn::Mul(y, y));
  const Vector range_m = square_root(hn::MulAdd(z, z, level2));
  const Vector level_m = square_root(level2);
  const Vector per_range = reciprocal(hn::Max(range_m, set(1e-9F)));
  const Vector sine = hn::Min(hn::Mul(set(radius_of(cubes)), per_range), set(1.0F));
  const Vector half_rad = arc_sine_bound(sine);
  // Azimuths within asin(sin(half)/sin(theta)); near a pole, all.
  const Vector theta = fast_arc_tangent(level_m, z);
  const Vector phi = hn::Add(fast_arc_tangent(y, x), pi);
  const Vector sine_theta = hn::Max(hn::Mul(level_m, per_range), set(1e-6F));
  const Vector spread = hn::Mul(half_rad, reciprocal(sine_theta));
  const Truth has_pole =
      hn::Or(hn::Ge(spread, set(1.0F)),
             hn::Or(hn::Lt(theta, half_rad), hn::Gt(hn::Add(theta, half_rad), pi)));
  const Vector across_rad = hn::IfThenElse(has_pole, pi, arc_sine_bound(spread));
  const Vector extent_rad = hn::Add(hn::Max(half_rad, across_rad), set(1e-5F));
  const Truth before_seam = hn::Lt(hn::Add(phi, extent_rad), set(2.0F * kPi));
  const Truth narrow =
      hn::And(hn::Lt(extent_rad, set(kNarrowRad)), hn::And(before_seam, hn::Gt(phi, extent_rad)));
  store_bytes(hn::IfThenElseZero(hn::RebindMask(di, narrow), hn::Set(di, 1)),
              verdicts.narrow.data() + i);
  hn::StoreU(theta, d, verdicts.theta_rad.data() + i);
  hn::StoreU(phi, d, verdicts.phi_rad.data() + i);
  const Vector rows = hn::Floor(hn::Mul(hn::Sub(theta, half_rad), rows_per_rad));
  const Vector rows_end = hn::Floor(hn::Mul(hn::Add(theta, half_rad), rows_per_rad));
  const Vector cols = hn::Floor(hn::Mul(hn::Sub(phi, across_rad), rows_per_rad));
  const Vector cols_end = hn::Floor(hn::Mul(hn::Add(phi, across_rad), rows_per_rad));
  const Whole no_row = hn::Zero(di);
  const Whole last_row = hn::Set(di, pyramid.rows - 1);
  const Whole last_col = hn::Set(di, pyramid.cols - 1);
  const auto pole = hn::RebindMask(di, has_pole);
  hn::StoreU(hn::Min(hn::Max(hn::ConvertTo(di, rows), no_row), last_row),
             di,
             windows.first_row.data() + i);
  hn::StoreU(hn::Max(hn::Min(hn::ConvertTo(di, rows_end), last_row), no_row),
             di,
             windows.last_row.data() + i);
  hn::StoreU(hn::IfThenZeroElse(pole, hn::ConvertTo(di, cols)), di, windows.first_col.data() + i);
  hn::StoreU(
      hn::IfThenElse(pole, last_col, hn::ConvertTo(di, cols_end)), di, windows.last_col.data() + i);
  hn::StoreU(range_m, d, ranges_m + i);
}

/// Nodes that follow each other in a row, as many as are asked at a time.
using FewFloats = hn::CappedTag<float, 8>;

/// A cube on its way through the nodes that it lies in.
struct AskedCube {
  float x_m;
  float y_m;
  float z_m;
  float half_edge_m;
  float least_m;  // range of its nearest place at least
  float most_m;
};

/// Nodes in some rows of a level, in up to `kNodesAcross` columns.
struct NodeBlock {
  std::size_t first = 0;  ///< place of the first node
  std::size_t stride = 0;
  int rows = 0;
  std::size_t cols = 0;
};

/// What nodes say of a cube, in bits; of several nodes, what they agree on.
constexpr unsigned kCrossedBit = 1;
constexpr unsigned kNothingBit = 2;
constexpr unsigned kAllBits = kCrossedBit | kNothingBit;

/// Asks nodes that lie below each other, in a few columns: by their limits of range and by their
/// planes, as the product of a node's vector and a place is 1 on the plane. Of directions that are
/// not seen neither limit is above 0.
HWY_INLINE unsigned ask_nodes(const PatchNodes& nodes,
                              const NodeBlock& block,
                              const AskedCube& cube) {
  const FewFloats d;
  const auto asked = hn::FirstN(d, block.cols);
  auto not_crossed = hn::Lt(hn::Zero(d), hn::Zero(d));
  auto not_nothing = not_crossed;
  std::size_t at = block.first;
  for (int row = 0; row < block.rows; ++row, at += block.stride) {
    const auto x = hn::LoadU(d, nodes.x_per_m.data() + at);
    const auto y = hn::LoadU(d, nodes.y_per_m.data() + at);
    const auto z = hn::LoadU(d, nodes.z_per_m.data() + at);
    const auto bend = hn::LoadU(d, nodes.bend_per_m.data() + at);
    const auto size = hn::LoadU(d, nodes.size_per_m.data() + at);
    const auto xy = hn::MulAdd(x, hn::Set(d, cube.x_m), hn::Mul(y, hn::Set(d, cube.y_m)));
    const auto middle = hn::MulAdd(z, hn::Set(d, cube.z_m), xy);
    const auto doubt =
        hn::MulAdd(bend, hn::Set(d, cube.most_m), hn::Mul(size, hn::Set(d, cube.half_edge_m)));
    const auto before =
        hn::Sub(hn::Set(d, 1.0F - kRounding), hn::LoadU(d, nodes.before.data() + at));
    const auto behind =
        hn::Add(hn::Set(d, 1.0F + kRounding), hn::LoadU(d, nodes.behind.data() + at));
    const auto crossed =
        hn::Or(hn::Lt(hn::Set(d, cube.most_m), hn::LoadU(d, nodes.near_m.data() + at)),
               hn::Le(hn::Add(middle, doubt), before));
    const auto nothing =
        hn::Or(hn::Ge(hn::Set(d, cube.least_m), hn::LoadU(d, nodes.far_m.data() + at)),
               hn::Ge(hn::Sub(middle, doubt), behind));
    not_crossed = hn::Or(not_crossed, hn::AndNot(crossed, asked));
    not_nothing = hn::Or(not_nothing, hn::AndNot(nothing, asked));
  }
  return (hn::AllFalse(d, not_crossed) ? kCrossedBit : 0) |
         (hn::AllFalse(d, not_nothing) ? kNothingBit : 0);
}

/// The finest level of which so few nodes hold all of a window.
HWY_INLINE int level_of(const PatchPyramid& pyramid, const Windows& windows, std::size_t i) {
  const auto is_too_fine = [&](int level) {
    const int rows = (windows.last_row[i] >> level) - (windows.first_row[i] >> level);
    const int cols = (windows.last_col[i] >> level) - (windows.first_col[i] >> level);
    return std::max(rows, cols) >= kNodesAcross;
  };
  int level = 0;
  while (level + 1 < pyramid.levels && is_too_fine(level)) {
    ++level;
  }
  return level;
}

/// What the nodes of a window agree on of one cube.
HWY_INLINE unsigned ask_window(const PatchPyramid& pyramid,
                               const Windows& windows,
                               std::size_t i,
                               const AskedCube& cube) {
  const int level = level_of(pyramid, windows, i);
  const auto at = static_cast<std::size_t>(level);
  const int first_row = windows.first_row[i] >> level;
  const auto stride = static_cast<std::size_t>(pyramid.stride[at]);
  const std::size_t begin =
      static_cast<std::size_t>(pyramid.first[at]) + static_cast<std::size_t>(first_row) * stride;
  const int rows = (windows.last_row[i] >> level) - first_row + 1;
  unsigned agreed = kAllBits;
  const auto ask_columns = [&](int from, int to) HWY_ATTR {
    const auto end_col = static_cast<std::size_t>(to >> level) + 1;
    auto col = static_cast<std::size_t>(from >> level);
    for (; col < end_col && agreed != 0; col += hn::Lanes(FewFloats())) {
      agreed &= ask_nodes(pyramid.nodes, {begin + col, stride, rows, end_col - col}, cube);
    }
  };
  const int first_col = windows.first_col[i];
  const int last_col = windows.last_col[i];
  const int turn = pyramid.cols;
  if (first_col >= 0 && last_col < turn) {
    ask_columns(first_col, last_col);
  } else {
    // The window goes on at the other end of the rows.
    ask_columns(first_col < 0 ? first_col + turn : first_col, turn - 1);
    ask_columns(0, last_col < turn ? last_col : last_col - turn);
  }
  return agreed;
}

void judge_cubes(const PatchPyramid& pyramid, const Cubes& cubes, Verdicts& verdicts) {
  HWY_ALIGN std::array<float, kCubesAtOnce> ranges_m;  // NOLINT(*-member-init): as far as needed
  for (std::size_t i = 0; i < cubes.count; i += hn::Lanes(Floats())) {
    find_windows(pyramid, cubes, i, ranges_m.data(), verdicts);
  }
  const float radius_m = radius_of(cubes);
  for (std::size_t i = 0; i < cubes.count; ++i) {
    const float range_m = ranges_m[i];
    // What holds the body itself is in all directions.
    if (cubes.known[i] || range_m <= 1.01F * radius_m) {
      verdicts.verdict[i] = CubeVerdict::kMixed;
      continue;
    }
    const AskedCube cube{cubes.x_m[i],
                         cubes.y_m[i],
                         cubes.z_m[i],
                         cubes.half_edge_m,
                         (1.0F - kRootError) * range_m - radius_m,
                         (1.0F + kRootError) * range_m + radius_m};
    const unsigned agreed = ask_window(pyramid, verdicts.windows, i, cube);
    verdicts.verdict[i] = agreed == 0             ? CubeVerdict::kMixed
                          : agreed == kCrossedBit ? CubeVerdict::kCrossed
                                                  : CubeVerdict::kNothing;
  }
}

}  // namespace skyhalo::HWY_NAMESPACE

HWY_AFTER_NAMESPACE();

#endif

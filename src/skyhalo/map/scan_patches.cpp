#include "skyhalo/map/scan_patches.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "skyhalo/map/scan_patches.cpp"
#include <hwy/foreach_target.h>
// It must come after what includes this file again for each target.
#include <hwy/highway.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "skyhalo/geometry/arc_tangent-inl.hpp"
#include "skyhalo/map/float_vectors-inl.hpp"
#include "skyhalo/map/mark_ends-inl.hpp"

HWY_BEFORE_NAMESPACE();

namespace skyhalo::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

constexpr float kEvenShare = 0.1F;
constexpr float kMostTilt = 0.4999F;  // of 16 bits

/// 1/range of a row of directions. What goes past its end is overwritten by the next row.
void invert_row(const float* z_m, std::size_t cols, float* per_m) {
  const Floats d;
  for (std::size_t col = 0; col < cols; col += hn::Lanes(d)) {
    hn::StoreU(reciprocal(hn::LoadU(d, z_m + col)), d, per_m + col);
  }
}

/// A patch's tilt: the change of 1/range on the side where it goes on evenly for two directions. Of
/// two such sides that bend into each other the evener one; else the gentler of both changes, if
/// they agree in sign.
/// `per_m`: 1/range of the directions, which are `step` apart.
HWY_INLINE Vector tilt(Vector z_m, const float* per_m, std::ptrdiff_t step) {
  const Floats d;
  const Vector one = set(1.0F);
  const Vector before2_per_m = hn::LoadU(d, per_m - 2 * step);
  const Vector behind2_per_m = hn::LoadU(d, per_m + 2 * step);
  const Vector nearest = hn::Mul(z_m, hn::LoadU(d, per_m - step));
  const Vector next = hn::Mul(z_m, hn::LoadU(d, per_m + step));
  const Vector up = hn::Sub(one, nearest);
  const Vector down = hn::Sub(next, one);
  const Vector up_bend = hn::Abs(hn::Sub(up, hn::Sub(nearest, hn::Mul(z_m, before2_per_m))));
  const Vector down_bend = hn::Abs(hn::Sub(down, hn::Sub(hn::Mul(z_m, behind2_per_m), next)));
  const Vector even = set(kEvenShare);
  const auto up_goes_on = hn::Le(up_bend, hn::Mul(even, hn::Abs(up)));
  const auto down_goes_on = hn::Le(down_bend, hn::Mul(even, hn::Abs(down)));
  const Vector gentler = hn::IfThenElse(hn::Lt(hn::Abs(up), hn::Abs(down)), up, down);
  // A product with NaN is not above 0.
  const auto agree = hn::Gt(hn::Mul(up, down), hn::Zero(d));
  const Vector both = hn::IfThenElseZero(agree, gentler);
  const Vector without_up = hn::IfThenElse(hn::AndNot(up_goes_on, down_goes_on), down, both);
  const Vector one_side = hn::IfThenElse(hn::AndNot(down_goes_on, up_goes_on), up, without_up);
  // At a bend between two even sides the evener one.
  const Vector evener = hn::IfThenElse(hn::Lt(up_bend, down_bend), up, down);
  const auto bend = hn::AndNot(agree, hn::And(up_goes_on, down_goes_on));
  const Vector chosen = hn::IfThenElse(bend, evener, one_side);
  return hn::Max(hn::Min(chosen, set(kMostTilt)), set(-kMostTilt));
}

/// Both tilts in one number.
HWY_INLINE Whole packed(Vector tilt_theta, Vector tilt_phi) {
  const Integers di;
  const Whole low = hn::NearestInt(hn::Mul(tilt_theta, set(65536.0F)));
  const Whole high = hn::NearestInt(hn::Mul(tilt_phi, set(65536.0F)));
  return hn::Or(hn::ShiftLeft<16>(high), hn::And(low, hn::Set(di, 0xFFFF)));
}

/// Half the thickness of patches (m): how far, along the ray, a cell's middle may be from a plane
/// that still touches the cell: `voxel/2 |n|_1 / (n u)` with the plane's normal n, here scaled to
/// n u = 1. `per_theta`, `per_phi`: relative change of 1/range per rad of arc.
HWY_INLINE Vector half_thickness(const PatchRow& row,
                                 const CellFrame& frame,
                                 std::size_t col,
                                 Vector per_theta,
                                 Vector per_phi) {
  const Floats d;
  const Vector sine = hn::LoadU(d, row.sin_phi + col);
  const Vector cosine = hn::LoadU(d, row.cos_phi + col);
  const Vector level = hn::MulAdd(per_theta, set(row.cos_theta), set(row.sin_theta));
  const Vector x = hn::NegMulAdd(per_phi, sine, hn::Mul(level, cosine));
  const Vector y = hn::MulAdd(per_phi, cosine, hn::Mul(level, sine));
  const Vector z = hn::NegMulAdd(per_theta, set(row.sin_theta), set(row.cos_theta));
  const Vector size = hn::Add(hn::Abs(rotated(frame.R_map_body, 0, x, y, z)),
                              hn::Add(hn::Abs(rotated(frame.R_map_body, 1, x, y, z)),
                                      hn::Abs(rotated(frame.R_map_body, 2, x, y, z))));
  return hn::Mul(set(0.5F * frame.voxel_m), size);
}

/// Whole patches.
HWY_INLINE void find_vector(const PatchRow& row,
                            const IncrementTable& table,
                            const CellFrame& frame,
                            std::size_t col,
                            ScanPatches& patches) {
  const Floats d;
  const Integers di;
  const Vector z_m = hn::LoadU(d, row.z_m + col);
  const Vector tilt_theta = tilt(z_m, row.per_m + col, row.stride);
  const Vector tilt_phi = tilt(z_m, row.per_m + col, 1);
  const Vector thick_m =
      half_thickness(row,
                     frame,
                     col,
                     hn::Mul(tilt_theta, set(row.rows_per_rad)),
                     hn::Mul(tilt_phi, set(row.rows_per_rad / std::max(row.sin_theta, 0.5F))));
  const Vector half_m = frame.thick ? thick_m : hn::Zero(d);
  const Vector delta_m = hn::LoadU(d, row.delta_z_m + col);
  const Vector place =
      hn::Min(hn::MulAdd(delta_m, set(IncrementTable::kUncertaintiesPerM), set(0.5F)),
              set(IncrementTable::kUncertainties - 1));
  const Whole table_row = hn::GatherIndex(di, table.rows(), hn::ConvertTo(di, place));
  const Vector width_m = hn::Mul(delta_m, hn::GatherIndex(d, table.width_ratios(), table_row));
  // By how much 1/range differs at most between a patch's middle and its rim.
  const Vector rim = hn::Mul(set(0.5F), hn::Add(hn::Abs(tilt_theta), hn::Abs(tilt_phi)));
  const Vector one = set(1.0F);
  const Vector widths = set(IncrementTable::kWidths);
  const Vector nearest_m = hn::Sub(hn::Mul(z_m, reciprocal(hn::Add(one, rim))), half_m);
  const Vector farthest_m = hn::Add(hn::Mul(z_m, reciprocal(hn::Sub(one, rim))), half_m);
  const Vector near_m = hn::NegMulAdd(widths, delta_m, nearest_m);
  const Vector far_m = hn::MulAdd(widths, width_m, farthest_m);
  const Vector free_to_m = hn::LoadU(d, row.free_to_m + col);
  const auto is_free = hn::Gt(free_to_m, hn::Zero(d));
  const Vector free_m = hn::IfThenElse(is_free, hn::Sub(free_to_m, thick_m), set(-1.0F));
  const auto has_depth = hn::Gt(z_m, hn::Zero(d));
  const std::size_t at = row.first + col;
  hn::StoreInterleaved4(hn::IfThenElse(has_depth, near_m, free_m),
                        hn::IfThenElse(has_depth, far_m, free_m),
                        z_m,
                        hn::BitCast(d, packed(tilt_theta, tilt_phi)),
                        d,
                        &patches.places[at].near_m);
  const Vector steps = set(IncrementTable::kStepsPerWidth);
  const Whole middle = hn::Add(hn::Mul(table_row, hn::Set(di, IncrementTable::kCols)),
                               hn::Set(di, IncrementTable::kCentre));
  // What speaks for a thing in the cell that holds the end.
  const Whole peak = hn::GatherIndex(di, table.increments(), middle);
  hn::StoreU(hn::IfThenElseZero(hn::RebindMask(di, has_depth), peak),
             di,
             patches.ends.peak.data() + patches.cols + at);
  hn::StoreInterleaved4(half_m,
                        hn::Mul(steps, reciprocal(delta_m)),
                        hn::Mul(steps, reciprocal(hn::Max(width_m, set(1e-6F)))),
                        hn::BitCast(d, middle),
                        d,
                        &patches.models[at].half_m);
}

/// Where the rays' ends are along one axis; -1 where the place is NaN.
HWY_INLINE void store_ends(Vector place, std::int32_t* ends) {
  const Integers di;
  const Vector whole = hn::Floor(place);
  const Vector kept = hn::Max(hn::Min(whole, set(1e9F)), set(-1.0F));
  hn::StoreU(hn::ConvertTo(di, hn::IfThenElse(hn::Eq(whole, whole), kept, set(-1.0F))), di, ends);
}

/// The cells that hold the ends of rays.
HWY_INLINE void find_ends(const PatchRow& row,
                          const CellFrame& frame,
                          std::size_t col,
                          ScanPatches& patches) {
  const Floats d;
  const Vector cells = hn::Mul(hn::LoadU(d, row.z_m + col), set(1.0F / frame.voxel_m));
  const Vector level = hn::Mul(cells, set(row.sin_theta));
  const Vector x = hn::Mul(level, hn::LoadU(d, row.cos_phi + col));
  const Vector y = hn::Mul(level, hn::LoadU(d, row.sin_phi + col));
  const Vector z = hn::Mul(cells, set(row.cos_theta));
  const std::size_t at = static_cast<std::size_t>(patches.cols) + row.first + col;
  const Eigen::Vector3f& from = frame.origin_cells;
  store_ends(hn::Add(rotated(frame.R_map_body, 0, x, y, z), set(from.x())),
             patches.ends.x.data() + at);
  store_ends(hn::Add(rotated(frame.R_map_body, 1, x, y, z), set(from.y())),
             patches.ends.y.data() + at);
  store_ends(hn::Add(rotated(frame.R_map_body, 2, x, y, z), set(from.z())),
             patches.ends.z.data() + at);
}

/// What goes past the row's end is overwritten by the next row, or lies in the room behind the
/// last.
void find_row(const PatchRow& row,
              const IncrementTable& table,
              const CellFrame& frame,
              ScanPatches& patches) {
  const std::size_t lanes = hn::Lanes(Floats());
  for (std::size_t col = 0; col < static_cast<std::size_t>(patches.cols); col += lanes) {
    find_vector(row, table, frame, col, patches);
    find_ends(row, frame, col, patches);
  }
}

}  // namespace skyhalo::HWY_NAMESPACE

HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace skyhalo {

HWY_EXPORT(invert_row);
HWY_EXPORT(find_row);
HWY_EXPORT(mark_ends);

void ScanPatches::find(const RangeScan& scan, const IncrementTable& table, const CellFrame& frame) {
  if (scan.rows() != rows) {
    resize(scan.rows());
  }
  invert(scan);
  const auto width = static_cast<std::size_t>(cols);
  for (int r = 0; r < rows; ++r) {
    const auto at = static_cast<std::size_t>(r);
    const std::size_t first = at * width;
    const PatchRow row{
        .first = first,
        .z_m = scan.z_m().data() + first,
        .per_m = per_m_row(r),
        .stride = static_cast<std::ptrdiff_t>(width) + std::ptrdiff_t{2} * kNeighbours,
        .delta_z_m = scan.delta_z_m().data() + first,
        .free_to_m = scan.free_to_m().data() + first,
        .sin_phi = sin_phi.data(),
        .cos_phi = cos_phi.data(),
        .sin_theta = sin_theta[at],
        .cos_theta = cos_theta[at],
        .rows_per_rad = static_cast<float>(rows / std::numbers::pi)};
    HWY_DYNAMIC_DISPATCH(find_row)(row, table, frame, *this);
  }
}

/// Rows go on behind their ends, as the scan does; what is beyond the poles has no range.
void ScanPatches::invert(const RangeScan& scan) {
  const auto width = static_cast<std::size_t>(cols);
  for (int r = 0; r < rows; ++r) {
    float* const row = per_m_row(r);
    HWY_DYNAMIC_DISPATCH(invert_row)
    (scan.z_m().data() + static_cast<std::size_t>(r) * width, width, row);
    std::copy_n(row, kNeighbours, row + width);
    std::copy_n(row + width - kNeighbours, kNeighbours, row - kNeighbours);
  }
  std::fill(per_m_row(rows) - kNeighbours,
            per_m.data() + per_m.size(),
            std::numeric_limits<float>::quiet_NaN());
}

float* ScanPatches::per_m_row(int row) noexcept {
  const std::size_t stride = static_cast<std::size_t>(cols) + std::size_t{2} * kNeighbours;
  return per_m.data() + static_cast<std::size_t>(row + kNeighbours) * stride + kNeighbours;
}

void ScanPatches::mark_ends(const Eigen::Vector3i& from,
                            const CellBox& region,
                            EndMarks& marks) const {
  HWY_DYNAMIC_DISPATCH(mark_ends)(*this, from, region, marks);
}

void ScanPatches::resize(int scan_rows) {
  rows = scan_rows;
  cols = 2 * scan_rows;
  const auto width = static_cast<std::size_t>(cols);
  const std::size_t room = static_cast<std::size_t>(rows) * width + kScanPadding;
  places.assign(room, {});
  models.assign(room, {});
  for (std::vector<std::int32_t>* values : {&ends.x, &ends.y, &ends.z, &ends.peak}) {
    values->assign(width + room, 0);
  }
  const auto stride = width + std::size_t{2} * kNeighbours;
  per_m.assign(
      (static_cast<std::size_t>(rows) + std::size_t{2} * kNeighbours) * stride + kScanPadding,
      std::numeric_limits<float>::quiet_NaN());
  sin_theta.resize(static_cast<std::size_t>(rows));
  cos_theta.resize(static_cast<std::size_t>(rows));
  for (int row = 0; row < rows; ++row) {
    const double theta_rad = (row + 0.5) * std::numbers::pi / rows;
    sin_theta[static_cast<std::size_t>(row)] = static_cast<float>(std::sin(theta_rad));
    cos_theta[static_cast<std::size_t>(row)] = static_cast<float>(std::cos(theta_rad));
  }
  sin_phi.assign(width + kScanPadding, 0.0F);
  cos_phi.assign(width + kScanPadding, 0.0F);
  for (std::size_t col = 0; col < width; ++col) {
    const double phi_rad = (static_cast<double>(col) + 0.5) * std::numbers::pi / rows;
    sin_phi[col] = static_cast<float>(-std::sin(phi_rad));  // azimuths begin at -pi
    cos_phi[col] = static_cast<float>(-std::cos(phi_rad));
  }
}

}  // namespace skyhalo
#endif

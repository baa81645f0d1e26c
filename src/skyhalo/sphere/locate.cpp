#include "skyhalo/sphere/locate.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "skyhalo/sphere/locate.cpp"
#include <hwy/foreach_target.h>
// It must come after what includes this file again for each target.
#include <hwy/highway.h>

#include <limits>
#include <numbers>

#include "skyhalo/geometry/arc_tangent-inl.hpp"

HWY_BEFORE_NAMESPACE();

namespace skyhalo::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Floats = hn::ScalableTag<float>;
using Integers = hn::RebindToSigned<Floats>;
using Vector = hn::Vec<Floats>;
using Mask = hn::Mask<Floats>;

constexpr float kPi = std::numbers::pi_v<float>;
constexpr float kInfinite = std::numeric_limits<float>::infinity();

/// `x / tan(x)` of an angle's square, for angles up to 1.5 rad, within 1e-7.
HWY_INLINE Vector angle_by_tangent(Vector square) {
  return polynomial(square,
                    1.0F,
                    -0.33333341F,
                    -0.0222215313F,
                    -0.00211877147F,
                    -0.000207684428F,
                    -2.49055951e-05F,
                    -4.80287842e-07F,
                    -6.0187744e-07F);
}

HWY_INLINE Vector axis(const std::array<float, 3>& vector, std::size_t i) {
  return hn::Set(Floats(), vector[i]);
}

/// The cell of a direction, or none.
HWY_INLINE hn::Vec<Integers> cell_of(const LocateGrid& grid, Vector theta, Vector phi) {
  const Floats d;
  const Integers di;
  const Vector zero = hn::Zero(d);
  const Vector row =
      hn::Mul(hn::Sub(theta, hn::Set(d, grid.theta_min_rad)), hn::Set(d, grid.rows_per_rad));
  const Vector from_first = hn::Sub(phi, hn::Set(d, grid.phi_min_rad));
  const Vector turned = hn::IfThenElse(
      hn::Lt(from_first, zero), hn::Add(from_first, hn::Set(d, 2.0F * kPi)), from_first);
  const Vector col = hn::Mul(turned, hn::Set(d, grid.cols_per_rad));
  Mask inside = hn::And(hn::Ge(row, zero), hn::Ge(col, zero));
  // A whole number of NaN is undefined where vectors are emulated.
  auto row_index = hn::ConvertTo(di, hn::IfThenElseZero(inside, row));
  auto col_index = hn::ConvertTo(di, hn::IfThenElseZero(inside, col));
  const auto cols = hn::Set(di, grid.cols);
  if (grid.reaches_down) {
    row_index = hn::Min(row_index, hn::Set(di, grid.rows - 1));
  } else {
    inside = hn::And(inside, hn::Lt(row, hn::Set(d, static_cast<float>(grid.rows))));
  }
  if (grid.whole_circle) {
    col_index = hn::IfThenElse(hn::Lt(col_index, cols), col_index, hn::Zero(di));
  } else {
    inside = hn::And(inside, hn::Lt(col, hn::Set(d, static_cast<float>(grid.cols))));
  }
  const auto cell = hn::Add(hn::Mul(row_index, cols), col_index);
  return hn::IfThenElse(hn::RebindMask(di, inside), cell, hn::Set(di, grid.no_cell));
}

// What one vector of pixels sees, by function: vectors of SVE cannot be members of a struct.

/// Disparity with its offset.
HWY_INLINE Vector disparity_of(const PinholeRow& row, const float* disparity_px, int u) {
  const Floats d;
  return hn::Add(hn::LoadU(d, disparity_px + u), hn::Set(d, row.offset_px));
}

/// Parallax.
HWY_INLINE Vector disparity_of(const SphericalRow& row, const float* disparity_px, int u) {
  const Floats d;
  return hn::Mul(hn::LoadU(d, disparity_px + u), hn::Set(d, row.delta_theta_u_rad));
}

/// What a ray is multiplied with: 1/disparity.
HWY_INLINE Vector scale_of(const PinholeRow&, int, Vector disparity) {
  return hn::Div(hn::Set(Floats(), 1.0F), disparity);
}

/// The range k.
HWY_INLINE Vector scale_of(const SphericalRow& row, int u, Vector delta) {
  const Floats d;
  const Vector by_tangent = hn::Div(angle_by_tangent(hn::Mul(delta, delta)), delta);
  const Vector sine = hn::LoadU(d, row.sin_alpha + u);
  const Vector cosine = hn::LoadU(d, row.cos_alpha + u);
  const Vector k_m =
      hn::Mul(hn::Set(d, row.baseline_m), hn::Sub(hn::Mul(cosine, by_tangent), sine));
  return hn::IfThenElse(hn::Gt(delta, hn::Zero(d)), k_m, hn::Set(d, kInfinite));
}

HWY_INLINE Vector column_of(const PinholeRow& row, int u) {
  const Floats d;
  return hn::Sub(hn::Add(hn::Iota(d, 0.0F), hn::Set(d, static_cast<float>(u))),
                 hn::Set(d, row.principal_u_px));
}

/// A coordinate of the point, body frame.
HWY_INLINE Vector coordinate(const PinholeRow& row, int u, Vector per_px, std::size_t i) {
  const Vector ray = hn::MulAdd(column_of(row, u), axis(row.step_m_px, i), axis(row.base_m_px, i));
  return hn::MulAdd(per_px, ray, axis(row.origin_m, i));
}

HWY_INLINE Vector coordinate(const SphericalRow& row, int u, Vector k_m, std::size_t i) {
  const Floats d;
  const Vector sine = hn::LoadU(d, row.sin_alpha + u);
  const Vector cosine = hn::LoadU(d, row.cos_alpha + u);
  const Vector ray = hn::MulAdd(sine, axis(row.side, i), hn::Mul(cosine, axis(row.ahead, i)));
  return hn::MulAdd(k_m, ray, axis(row.origin_m, i));
}

/// Distance of the point from the camera.
HWY_INLINE Vector camera_range(const PinholeRow& row, int u, Vector per_px) {
  const Floats d;
  const Vector column = column_of(row, u);
  const Vector ray2 = hn::MulAdd(
      hn::Mul(column, column), hn::Set(d, row.step2_m2_px2), hn::Set(d, row.across2_m2_px2));
  return hn::Sqrt(hn::Mul(hn::Mul(per_px, per_px), ray2));
}

HWY_INLINE Vector camera_range(const SphericalRow&, int, Vector k_m) {
  return k_m;
}

/// Whether there is a disparity that the pixel can have.
HWY_INLINE Mask is_measured(const PinholeRow&, int, Vector disparity) {
  const Floats d;
  return hn::And(hn::Ge(disparity, hn::Zero(d)), hn::Lt(disparity, hn::Set(d, kInfinite)));
}

HWY_INLINE Mask is_measured(const SphericalRow& row, int u, Vector delta) {
  const Floats d;
  const Vector zero = hn::Zero(d);
  const Vector max_delta = hn::LoadU(d, row.max_delta_rad + u);
  return hn::And(hn::And(hn::Ge(delta, zero), hn::Lt(delta, max_delta)), hn::Gt(max_delta, zero));
}

/// Whether single precision is too little: here where the offset cancels.
HWY_INLINE Mask is_unsure(const PinholeRow& row, int, Vector disparity, Vector) {
  const Floats d;
  const Vector offset = hn::Abs(hn::Set(d, row.offset_px));
  return hn::Lt(hn::Mul(hn::Abs(disparity), hn::Set(d, 64.0F)), offset);
}

/// Here where the two terms of k cancel, as the left camera looks along the baseline, or the
/// parallax is beyond the polynomial.
HWY_INLINE Mask is_unsure(const SphericalRow& row, int u, Vector delta, Vector k_m) {
  const Floats d;
  const Mask cancels = hn::Lt(hn::Abs(k_m), hn::Set(d, row.baseline_m / 16.0F));
  const Mask wide = hn::Gt(delta, hn::Set(d, 1.5F));
  const Mask sees = hn::Gt(hn::LoadU(d, row.max_delta_rad + u), hn::Zero(d));
  return hn::And(hn::And(hn::Or(cancels, wide), sees), hn::Lt(delta, hn::Set(d, 2.0F * kPi)));
}

/// Writes and counts what one vector of pixels sees.
template <class Row>
HWY_INLINE void locate_pixels(const Row& row,
                              const LocateTarget& target,
                              const float* disparity_px,
                              int u,
                              LocatedCounts& counts) {
  const Floats d;
  const Integers di;
  const Vector disparity = disparity_of(row, disparity_px, u);
  const Vector scale = scale_of(row, u, disparity);
  const Vector x_m = coordinate(row, u, scale, 0);
  const Vector y_m = coordinate(row, u, scale, 1);
  const Vector z_m = coordinate(row, u, scale, 2);
  const Vector camera_m = camera_range(row, u, scale);
  const Mask measured = is_measured(row, u, disparity);

  const Vector level_m2 = hn::MulAdd(x_m, x_m, hn::Mul(y_m, y_m));
  const Vector range_m2 = hn::MulAdd(z_m, z_m, level_m2);
  const Vector theta = arc_tangent(hn::Sqrt(level_m2), z_m);
  const Vector phi = arc_tangent(y_m, x_m);
  const Vector infinite = hn::Set(d, kInfinite);
  const Mask near =
      hn::And(hn::Le(camera_m, hn::Set(d, target.limits.max_range_m)), hn::Lt(camera_m, infinite));
  const Mask valid = hn::And(measured, hn::Ge(camera_m, hn::Set(d, target.limits.min_range_m)));
  const Mask within = hn::And(near, valid);
  // Near the body origin the camera's offset cancels against the range.
  const Mask near_origin =
      hn::And(within, hn::Lt(hn::Mul(range_m2, hn::Set(d, 256.0F)), hn::Mul(camera_m, camera_m)));
  const Mask doubtful = hn::Or(is_unsure(row, u, disparity, scale), near_origin);

  auto cell = hn::IfThenElse(hn::RebindMask(di, within),
                             cell_of(target.grid, theta, phi),
                             hn::Set(di, target.grid.no_cell));
  cell = hn::IfThenElse(hn::RebindMask(di, doubtful), hn::Set(di, target.grid.doubtful_cell), cell);
  hn::StoreU(cell, di, target.located.cell + u);
  hn::StoreU(hn::Sqrt(range_m2), d, target.located.range_m + u);
  const Vector seen_m = hn::IfThenElse(near, camera_m, infinite);
  const Vector not_seen = hn::IfThenElse(measured, hn::Set(d, kTooNear), hn::Set(d, kInvalid));
  hn::StoreU(hn::IfThenElse(valid, seen_m, not_seen), d, target.located.seen_m + u);
  counts.measured += static_cast<int>(hn::CountTrue(d, hn::AndNot(doubtful, measured)));
  counts.used += static_cast<int>(hn::CountTrue(d, hn::AndNot(doubtful, within)));
  counts.doubtful += static_cast<int>(hn::CountTrue(d, doubtful));
}

template <class Row>
LocatedCounts locate_row(const Row& row,
                         const LocateTarget& target,
                         const float* disparity_px,
                         int width) {
  LocatedCounts counts;
  for (int u = 0; u < width; u += static_cast<int>(hn::Lanes(Floats()))) {
    locate_pixels(row, target, disparity_px, u, counts);
  }
  return counts;
}

LocatedCounts locate_pinhole(const PinholeRow& row,
                             const LocateTarget& target,
                             const float* disparity_px,
                             int width) {
  return locate_row(row, target, disparity_px, width);
}

LocatedCounts locate_spherical(const SphericalRow& row,
                               const LocateTarget& target,
                               const float* disparity_px,
                               int width) {
  return locate_row(row, target, disparity_px, width);
}

}  // namespace skyhalo::HWY_NAMESPACE

HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace skyhalo {

HWY_EXPORT(locate_pinhole);
HWY_EXPORT(locate_spherical);

LocateGrid::LocateGrid(const GridGeometry& geometry) noexcept
    : theta_min_rad(static_cast<float>(geometry.theta_min_rad)),
      rows_per_rad(static_cast<float>(1.0 / geometry.theta_step_rad)),
      phi_min_rad(static_cast<float>(geometry.phi_min_rad)),
      cols_per_rad(static_cast<float>(1.0 / geometry.phi_step_rad)),
      rows(geometry.rows),
      cols(geometry.cols),
      no_cell(geometry.cell_count()),
      doubtful_cell(geometry.cell_count() + 1),
      whole_circle(geometry.is_whole_circle()),
      reaches_down(geometry.reaches_down()) {}

LocatedCounts locate(const PinholeRow& row,
                     const LocateTarget& target,
                     const float* disparity_px,
                     int width) noexcept {
  return HWY_DYNAMIC_DISPATCH(locate_pinhole)(row, target, disparity_px, width);
}

LocatedCounts locate(const SphericalRow& row,
                     const LocateTarget& target,
                     const float* disparity_px,
                     int width) noexcept {
  return HWY_DYNAMIC_DISPATCH(locate_spherical)(row, target, disparity_px, width);
}

}  // namespace skyhalo
#endif

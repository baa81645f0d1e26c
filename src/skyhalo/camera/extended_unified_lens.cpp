#include "skyhalo/camera/extended_unified_lens.hpp"

#include <cmath>
#include <numbers>

#include "skyhalo/base/error.hpp"
#include "skyhalo/camera/sphere_domain.hpp"

namespace skyhalo {
namespace {

/// The angle of z > -w rho.
double domain_angle_rad(const ExtendedUnifiedLens::Shape& shape) noexcept {
  const double w = tangent_height(shape.alpha);
  const double behind = std::atan2(w * std::sqrt(shape.beta), std::sqrt(1.0 - w * w));
  return inside_edge_rad(std::numbers::pi / 2.0 + behind);
}

}  // namespace

ExtendedUnifiedLens::ExtendedUnifiedLens(const Intrinsics& intrinsics, const Shape& shape)
    : intrinsics_(intrinsics), shape_(shape) {
  check(intrinsics);
  if (!(shape.alpha >= 0.0 && shape.alpha <= 1.0) ||
      !(shape.beta > 0.0 && std::isfinite(shape.beta))) {
    throw Error(ErrorKind::kInput, "distortion: expected alpha in [0, 1] and beta above 0");
  }
  max_angle_rad_ = domain_angle_rad(shape);
}

std::optional<Eigen::Vector2d> ExtendedUnifiedLens::project(
    const Eigen::Vector3d& point) const noexcept {
  const std::optional<Eigen::Vector3d> p = scaled_to_one(point);
  if (!p || !within(*p, max_angle_rad_)) {
    return std::nullopt;
  }
  const double rho = std::sqrt(shape_.beta * p->head<2>().squaredNorm() + p->z() * p->z());
  const double n = shape_.alpha * rho + (1.0 - shape_.alpha) * p->z();
  return Eigen::Vector2d(intrinsics_.fx_px * p->x() / n + intrinsics_.cx_px,
                         intrinsics_.fy_px * p->y() / n + intrinsics_.cy_px);
}

std::optional<LensJacobian> ExtendedUnifiedLens::jacobian(
    const Eigen::Vector3d& point) const noexcept {
  const std::optional<Eigen::Vector3d> p = scaled_to_one(point);
  if (!p || !within(*p, max_angle_rad_)) {
    return std::nullopt;
  }
  const double rho = std::sqrt(shape_.beta * p->head<2>().squaredNorm() + p->z() * p->z());
  const double n = shape_.alpha * rho + (1.0 - shape_.alpha) * p->z();
  const Eigen::Vector3d drho =
      Eigen::Vector3d(shape_.beta * p->x(), shape_.beta * p->y(), p->z()) / rho;
  const Eigen::Vector3d dn = shape_.alpha * drho + (1.0 - shape_.alpha) * Eigen::Vector3d::UnitZ();
  return quotient_jacobian(*p, n, dn, intrinsics_) / point.cwiseAbs().maxCoeff();
}

std::optional<Eigen::Vector3d> ExtendedUnifiedLens::unproject(
    const Eigen::Vector2d& pixel_px) const noexcept {
  const double alpha = shape_.alpha;
  const double mx = (pixel_px.x() - intrinsics_.cx_px) / intrinsics_.fx_px;
  const double my = (pixel_px.y() - intrinsics_.cy_px) / intrinsics_.fy_px;
  const double beta_r2 = shape_.beta * (mx * mx + my * my);
  const double root2 = 1.0 - (2.0 * alpha - 1.0) * beta_r2;
  if (!(root2 >= 0.0) || !std::isfinite(beta_r2)) {
    return std::nullopt;
  }
  const double mz = (1.0 - alpha * alpha * beta_r2) / (alpha * std::sqrt(root2) + 1.0 - alpha);
  return ray_within(Eigen::Vector3d(mx, my, mz), max_angle_rad_);
}

}  // namespace skyhalo

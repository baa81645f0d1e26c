#include "skyhalo/camera/double_sphere_lens.hpp"

#include <cmath>

#include "skyhalo/base/error.hpp"
#include "skyhalo/camera/sphere_domain.hpp"

namespace skyhalo {
namespace {

/// Where the image folds or runs to infinity: at the angle psi = acos(-w1) around the second
/// sphere's centre, from which the law of sines leads to the first one's.
double domain_angle_rad(const DoubleSphereLens::Shape& shape) noexcept {
  const double psi = std::acos(-tangent_height(shape.alpha));
  return inside_edge_rad(psi + std::asin(shape.xi * std::sin(psi)));
}

}  // namespace

DoubleSphereLens::DoubleSphereLens(const Intrinsics& intrinsics, const Shape& shape)
    : intrinsics_(intrinsics), shape_(shape) {
  check(intrinsics);
  if (!(shape.xi > -1.0 && shape.xi <= 1.0) || !(shape.alpha >= 0.0 && shape.alpha <= 1.0)) {
    throw Error(ErrorKind::kInput, "distortion: expected xi in (-1, 1] and alpha in [0, 1]");
  }
  max_angle_rad_ = domain_angle_rad(shape);
}

std::optional<Eigen::Vector2d> DoubleSphereLens::project(
    const Eigen::Vector3d& point) const noexcept {
  const std::optional<Eigen::Vector3d> p = scaled_to_one(point);
  if (!p || !within(*p, max_angle_rad_)) {
    return std::nullopt;
  }
  const double k = shape_.xi * p->norm() + p->z();
  const double d2 = std::hypot(p->x(), p->y(), k);
  const double n = shape_.alpha * d2 + (1.0 - shape_.alpha) * k;
  return Eigen::Vector2d(intrinsics_.fx_px * p->x() / n + intrinsics_.cx_px,
                         intrinsics_.fy_px * p->y() / n + intrinsics_.cy_px);
}

std::optional<LensJacobian> DoubleSphereLens::jacobian(
    const Eigen::Vector3d& point) const noexcept {
  const std::optional<Eigen::Vector3d> p = scaled_to_one(point);
  if (!p || !within(*p, max_angle_rad_)) {
    return std::nullopt;
  }
  const double d1 = p->norm();
  const double k = shape_.xi * d1 + p->z();
  const double d2 = std::hypot(p->x(), p->y(), k);
  const double n = shape_.alpha * d2 + (1.0 - shape_.alpha) * k;
  const Eigen::Vector3d dk = shape_.xi / d1 * *p + Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d dd2 = (Eigen::Vector3d(p->x(), p->y(), 0.0) + k * dk) / d2;
  const Eigen::Vector3d dn = shape_.alpha * dd2 + (1.0 - shape_.alpha) * dk;
  return quotient_jacobian(*p, n, dn, intrinsics_) / point.cwiseAbs().maxCoeff();
}

std::optional<Eigen::Vector3d> DoubleSphereLens::unproject(
    const Eigen::Vector2d& pixel_px) const noexcept {
  const double alpha = shape_.alpha;
  const double xi = shape_.xi;
  const double mx = (pixel_px.x() - intrinsics_.cx_px) / intrinsics_.fx_px;
  const double my = (pixel_px.y() - intrinsics_.cy_px) / intrinsics_.fy_px;
  const double r2 = mx * mx + my * my;
  const double root2 = 1.0 - (2.0 * alpha - 1.0) * r2;
  if (!(root2 >= 0.0) || !std::isfinite(r2)) {
    return std::nullopt;
  }
  const double mz = (1.0 - alpha * alpha * r2) / (alpha * std::sqrt(root2) + 1.0 - alpha);
  const double k = (mz * xi + std::sqrt(mz * mz + (1.0 - xi * xi) * r2)) / (mz * mz + r2);
  return ray_within(Eigen::Vector3d(k * mx, k * my, k * mz - xi), max_angle_rad_);
}

}  // namespace skyhalo

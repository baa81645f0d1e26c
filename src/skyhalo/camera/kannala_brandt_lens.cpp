#include "skyhalo/camera/kannala_brandt_lens.hpp"

#include <algorithm>
#include <cmath>

#include "skyhalo/base/error.hpp"
#include "skyhalo/camera/monotone.hpp"
#include "skyhalo/geometry/angle.hpp"

namespace skyhalo {
namespace {

constexpr double kLargestAngle = rad_from_deg(179.0);

// Where the image grows less than this share of what it does on the axis, its inverse is not exact.
constexpr double kLeastGrowth = 1e-3;

/// r(theta) and its derivative.
ValueAndSlope image_radius(const KannalaBrandtLens::Distortion& k, double theta) noexcept {
  const double t2 = theta * theta;
  return {theta * (1.0 + t2 * (k[0] + t2 * (k[1] + t2 * (k[2] + t2 * k[3])))),
          1.0 + t2 * (3.0 * k[0] + t2 * (5.0 * k[1] + t2 * (7.0 * k[2] + t2 * 9.0 * k[3])))};
}

/// A point in the terms of the model.
struct PolarPoint {
  Eigen::Vector2d across;  ///< unit vector, (x, y)/rho
  double rho = 0.0;
  double theta_rad = 0.0;
};

PolarPoint to_polar(const Eigen::Vector3d& p) noexcept {
  const double rho = std::hypot(p.x(), p.y());
  // Below this the direction across is no longer a number to trust, and does not matter.
  constexpr double kOnAxis = 1e-150;
  const Eigen::Vector2d across =
      rho > kOnAxis ? Eigen::Vector2d(p.head<2>() / rho) : Eigen::Vector2d::UnitX();
  return {across, rho > kOnAxis ? rho : 0.0, std::atan2(rho, p.z())};
}

}  // namespace

KannalaBrandtLens::KannalaBrandtLens(const Intrinsics& intrinsics, const Distortion& distortion)
    : intrinsics_(intrinsics), distortion_(distortion) {
  check(intrinsics);
  if (!std::ranges::all_of(distortion, [](double k) { return std::isfinite(k); })) {
    throw Error(ErrorKind::kInput, "distortion: expected finite numbers k1 k2 k3 k4");
  }
  const auto grows = [&](double theta) {
    return image_radius(distortion, theta).slope > kLeastGrowth;
  };
  max_angle_rad_ = holds_until(grows, rad_from_deg(0.25), kLargestAngle);
  max_radius_ = image_radius(distortion, max_angle_rad_).value;
  if (!(max_angle_rad_ > rad_from_deg(1.0))) {
    throw Error(ErrorKind::kInput,
                "distortion: with these coefficients the image folds back at the optical axis");
  }
}

std::optional<Eigen::Vector2d> KannalaBrandtLens::project(
    const Eigen::Vector3d& point) const noexcept {
  const std::optional<Eigen::Vector3d> p = scaled_to_one(point);
  if (!p) {
    return std::nullopt;
  }
  const PolarPoint polar = to_polar(*p);
  if (!(polar.theta_rad <= max_angle_rad_)) {
    return std::nullopt;
  }
  const double r = image_radius(distortion_, polar.theta_rad).value;
  return Eigen::Vector2d(intrinsics_.fx_px * r * polar.across.x() + intrinsics_.cx_px,
                         intrinsics_.fy_px * r * polar.across.y() + intrinsics_.cy_px);
}

std::optional<LensJacobian> KannalaBrandtLens::jacobian(
    const Eigen::Vector3d& point) const noexcept {
  const std::optional<Eigen::Vector3d> p = scaled_to_one(point);
  if (!p) {
    return std::nullopt;
  }
  const auto [across, rho, theta] = to_polar(*p);
  if (!(theta <= max_angle_rad_)) {
    return std::nullopt;
  }
  const auto [r, slope] = image_radius(distortion_, theta);
  const double n2 = p->squaredNorm();
  const double sideways = rho > 0.0 ? r / rho : 1.0 / p->z();
  const double outwards = slope * p->z() / n2;  // dr/drho
  LensJacobian J;
  J.leftCols<2>() =
      sideways * Eigen::Matrix2d::Identity() + (outwards - sideways) * across * across.transpose();
  J.col(2) = -slope * rho / n2 * across;
  const Eigen::Vector2d f(intrinsics_.fx_px, intrinsics_.fy_px);
  // The derivative was taken at the scaled point.
  return LensJacobian(f.asDiagonal() * J / point.cwiseAbs().maxCoeff());
}

std::optional<Eigen::Vector3d> KannalaBrandtLens::unproject(
    const Eigen::Vector2d& pixel_px) const noexcept {
  const Eigen::Vector2d target((pixel_px.x() - intrinsics_.cx_px) / intrinsics_.fx_px,
                               (pixel_px.y() - intrinsics_.cy_px) / intrinsics_.fy_px);
  const double r = std::hypot(target.x(), target.y());
  if (!(r <= max_radius_ * (1.0 - 1e-12))) {
    return std::nullopt;
  }
  if (r == 0.0) {
    return Eigen::Vector3d::UnitZ();
  }
  const auto radius = [&](double theta) { return image_radius(distortion_, theta); };
  const double theta = solve_growing(radius, r, max_angle_rad_);
  const double across = std::sin(theta) / r;
  return Eigen::Vector3d(across * target.x(), across * target.y(), std::cos(theta)).normalized();
}

}  // namespace skyhalo

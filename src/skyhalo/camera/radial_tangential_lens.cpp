#include "skyhalo/camera/radial_tangential_lens.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "skyhalo/base/error.hpp"
#include "skyhalo/camera/monotone.hpp"
#include "skyhalo/geometry/angle.hpp"

namespace skyhalo {
namespace {

constexpr double kLargestAngle = rad_from_deg(89.0);

// Where the image grows less than this share of what it does on the axis, its inverse is not exact.
constexpr double kLeastGrowth = 1e-3;

/// A point of the distorted plane and how it moves with the undistorted one. The Jacobian is
/// symmetric, so that the map is one to one on every disc where it is positive definite.
struct Distorted {
  Eigen::Vector2d at;
  Eigen::Matrix2d J;
};

/// The radial factor g and its derivative by r^2.
ValueAndSlope radial_factor(const RadialTangentialLens::Distortion& d, double r2) noexcept {
  const auto& [k1, k2, p1, p2, k3, k4, k5, k6] = d;
  const double above = 1.0 + r2 * (k1 + r2 * (k2 + r2 * k3));
  const double below = 1.0 + r2 * (k4 + r2 * (k5 + r2 * k6));
  const double above_slope = k1 + r2 * (2.0 * k2 + 3.0 * r2 * k3);
  const double below_slope = k4 + r2 * (2.0 * k5 + 3.0 * r2 * k6);
  const double g = above / below;
  return {g, (above_slope - g * below_slope) / below};
}

Distorted distort(const RadialTangentialLens::Distortion& d, const Eigen::Vector2d& xy) noexcept {
  const double p1 = d[2];
  const double p2 = d[3];
  const double x = xy.x();
  const double y = xy.y();
  const double r2 = xy.squaredNorm();
  const auto [g, slope] = radial_factor(d, r2);
  const double across = 2.0 * (x * y * slope + p1 * x + p2 * y);
  Distorted out;
  out.at = {x * g + 2.0 * p1 * x * y + p2 * (r2 + 2.0 * x * x),
            y * g + p1 * (r2 + 2.0 * y * y) + 2.0 * p2 * x * y};
  out.J << g + 2.0 * x * x * slope + 2.0 * p1 * y + 6.0 * p2 * x, across, across,
      g + 2.0 * y * y * slope + 6.0 * p1 * y + 2.0 * p2 * x;
  return out;
}

/// True when the image grows outwards in all directions at this angle from the axis, and the
/// denominator of the radial factor has not passed through zero.
bool grows_at(const RadialTangentialLens::Distortion& d, double angle_rad) noexcept {
  const double r = std::tan(angle_rad);
  const double r2 = r * r;
  if (!(1.0 + r2 * (d[5] + r2 * (d[6] + r2 * d[7])) > 0.0)) {
    return false;
  }
  constexpr int kDirections = 32;
  for (int i = 0; i < kDirections; ++i) {
    const double azimuth = 2.0 * std::numbers::pi * i / kDirections;
    const Eigen::Matrix2d J = distort(d, {r * std::cos(azimuth), r * std::sin(azimuth)}).J;
    const double middle = 0.5 * J.trace();
    const double least = middle - std::hypot(0.5 * (J(0, 0) - J(1, 1)), J(0, 1));
    if (!(least > kLeastGrowth)) {
      return false;
    }
  }
  return true;
}

}  // namespace

RadialTangentialLens::RadialTangentialLens(const Intrinsics& intrinsics,
                                           const Distortion& distortion)
    : intrinsics_(intrinsics), distortion_(distortion) {
  check(intrinsics);
  if (!std::ranges::all_of(distortion, [](double k) { return std::isfinite(k); })) {
    throw Error(ErrorKind::kInput, "distortion: expected finite numbers k1 k2 p1 p2 k3 k4 k5 k6");
  }
  const auto grows = [&](double angle_rad) { return grows_at(distortion, angle_rad); };
  max_angle_rad_ = holds_until(grows, rad_from_deg(0.25), kLargestAngle);
  max_radius_ = std::tan(max_angle_rad_);
  if (!(max_angle_rad_ > rad_from_deg(1.0))) {
    throw Error(ErrorKind::kInput,
                "distortion: with these coefficients the image folds back at the optical axis");
  }
}

std::optional<Eigen::Vector2d> RadialTangentialLens::project(
    const Eigen::Vector3d& point) const noexcept {
  const std::optional<Eigen::Vector3d> p = scaled_to_one(point);
  if (!p || !(p->head<2>().norm() <= max_radius_ * p->z())) {
    return std::nullopt;
  }
  const Eigen::Vector2d at = distort(distortion_, p->head<2>() / p->z()).at;
  return Eigen::Vector2d(intrinsics_.fx_px * at.x() + intrinsics_.cx_px,
                         intrinsics_.fy_px * at.y() + intrinsics_.cy_px);
}

std::optional<LensJacobian> RadialTangentialLens::jacobian(
    const Eigen::Vector3d& point) const noexcept {
  const std::optional<Eigen::Vector3d> p = scaled_to_one(point);
  if (!p || !(p->head<2>().norm() <= max_radius_ * p->z())) {
    return std::nullopt;
  }
  const Eigen::Vector2d xy = p->head<2>() / p->z();
  LensJacobian flattening;  // of (x, y) by the point
  flattening << 1.0, 0.0, -xy.x(), 0.0, 1.0, -xy.y();
  flattening /= p->z();
  const Eigen::Vector2d f(intrinsics_.fx_px, intrinsics_.fy_px);
  // The derivative was taken at the scaled point.
  return LensJacobian(f.asDiagonal() * distort(distortion_, xy).J * flattening /
                      point.cwiseAbs().maxCoeff());
}

std::optional<Eigen::Vector3d> RadialTangentialLens::unproject(
    const Eigen::Vector2d& pixel_px) const noexcept {
  const Eigen::Vector2d target((pixel_px.x() - intrinsics_.cx_px) / intrinsics_.fx_px,
                               (pixel_px.y() - intrinsics_.cy_px) / intrinsics_.fy_px);
  const double target_radius = target.norm();
  if (!std::isfinite(target_radius)) {
    return std::nullopt;
  }
  if (target_radius == 0.0) {
    return Eigen::Vector3d::UnitZ();
  }
  // The radial part alone is near enough for Newton's method to end it.
  const auto radius = [&](double r) {
    const auto [g, slope] = radial_factor(distortion_, r * r);
    return ValueAndSlope{r * g, g + 2.0 * r * r * slope};
  };
  Eigen::Vector2d xy = target * (solve_growing(radius, target_radius, max_radius_) / target_radius);
  double residual = 0.0;
  for (int i = 0; i < 20; ++i) {
    const Distorted image = distort(distortion_, xy);
    const Eigen::Vector2d step = image.J.inverse() * (target - image.at);
    residual = step.norm();
    xy += step;
    const double r = xy.norm();
    if (r > 1.01 * max_radius_) {
      xy *= max_radius_ / r;
    }
    if (!(residual > 1e-15 * (1.0 + r))) {
      break;
    }
  }
  if (!(residual <= 1e-11 * (1.0 + max_radius_)) || !(xy.norm() <= max_radius_ * (1.0 - 1e-12))) {
    return std::nullopt;
  }
  return Eigen::Vector3d(xy.x(), xy.y(), 1.0).normalized();
}

}  // namespace skyhalo

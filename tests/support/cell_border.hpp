#pragma once

#include <Eigen/Core>
#include <cmath>

namespace skyhalo::testing {

/// True when a point (m, body) lies so near to a border between cells of this step that a grid of
/// single precision may take either: within 1e-5 rad, across the border.
inline bool is_near_border(const Eigen::Vector3d& p_body_m, double step_rad) {
  const double rho_m = p_body_m.norm();
  const double level_m = std::hypot(p_body_m.x(), p_body_m.y());
  const double theta = std::atan2(level_m, p_body_m.z());
  const double phi = std::atan2(p_body_m.y(), p_body_m.x());
  const auto to_border = [step_rad](double angle) {
    return std::abs(angle - step_rad * std::round(angle / step_rad));
  };
  return to_border(theta) < 1e-5 || to_border(phi) * level_m / rho_m < 1e-5;
}

}  // namespace skyhalo::testing

#include "skyhalo/sphere/grid_geometry.hpp"

#include <cmath>
#include <numbers>
#include <string>

#include "skyhalo/base/error.hpp"
#include "skyhalo/geometry/angle.hpp"

namespace skyhalo {
namespace {

constexpr double kSlack = 1e-6;
constexpr double kMaxCells = 1e7;

void require(bool holds, const std::string& message) {
  if (!holds) {
    throw Error(ErrorKind::kInput, "spherical grid: " + message);
  }
}

/// The bound as a whole number of steps.
double steps_to(double bound_rad, double step_rad, const char* name) {
  const double steps = bound_rad / step_rad;
  const double whole = std::round(steps);
  require(std::abs(steps - whole) < kSlack,
          std::string(name) + " (" + std::to_string(deg_from_rad(bound_rad)) +
              " deg) must be a multiple of the step (" + std::to_string(deg_from_rad(step_rad)) +
              " deg)");
  return whole;
}

}  // namespace

GridGeometry make_grid_geometry(const GridBounds& bounds) {
  constexpr double kPi = std::numbers::pi;
  require(bounds.step_rad > 0.0 && bounds.step_rad < kPi, "the step must lie in (0, 180) deg");
  require(bounds.theta_min_rad >= -kSlack && bounds.theta_max_rad <= kPi + kSlack &&
              bounds.theta_min_rad < bounds.theta_max_rad,
          "theta bounds must satisfy 0 <= min < max <= 180 deg");
  require(bounds.phi_min_rad >= -kPi - kSlack && bounds.phi_max_rad <= kPi + kSlack &&
              bounds.phi_min_rad < bounds.phi_max_rad,
          "phi bounds must satisfy -180 <= min < max <= 180 deg");
  const double step = bounds.step_rad;
  const double rows = steps_to(bounds.theta_max_rad, step, "theta_max") -
                      steps_to(bounds.theta_min_rad, step, "theta_min");
  const double cols =
      steps_to(bounds.phi_max_rad, step, "phi_max") - steps_to(bounds.phi_min_rad, step, "phi_min");
  require(rows * cols <= kMaxCells, "more than 10^7 cells; choose a larger step");
  return {.theta_min_rad = bounds.theta_min_rad,
          .theta_step_rad = step,
          .rows = static_cast<int>(rows),
          .phi_min_rad = bounds.phi_min_rad,
          .phi_step_rad = step,
          .cols = static_cast<int>(cols)};
}

}  // namespace skyhalo

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

void require(bool holds, const std::string& key, const std::string& expected) {
  if (!holds) {
    throw Error(ErrorKind::kInput, "sphere." + key + ": expected " + expected);
  }
}

/// The bound as a whole number of steps.
double steps_to(double bound_rad, double step_rad, const char* name) {
  const double steps = bound_rad / step_rad;
  const double whole = std::round(steps);
  require(std::abs(steps - whole) < kSlack,
          name,
          "a multiple of the step (" + std::to_string(deg_from_rad(step_rad)) + " deg), found " +
              std::to_string(deg_from_rad(bound_rad)) + " deg");
  return whole;
}

}  // namespace

GridGeometry make_grid_geometry(const GridBounds& bounds) {
  constexpr double kPi = std::numbers::pi;
  const double step = bounds.step_rad;
  require(step > 0.0 && step < kPi, "step_deg", "an angle in (0, 180) deg");
  require(bounds.theta_min_rad >= -kSlack, "theta_min_deg", "an angle of at least 0 deg");
  require(bounds.theta_max_rad <= kPi + kSlack && bounds.theta_max_rad > bounds.theta_min_rad,
          "theta_max_deg",
          "an angle above theta_min and at most 180 deg");
  require(bounds.phi_min_rad >= -kPi - kSlack && bounds.phi_min_rad < kPi - kSlack,
          "phi_min_deg",
          "an angle of at least -180 and below 180 deg");
  require(bounds.phi_max_rad <= bounds.phi_min_rad + 2.0 * kPi + kSlack &&
              bounds.phi_max_rad > bounds.phi_min_rad,
          "phi_max_deg",
          "an angle above phi_min and at most a whole turn from it");
  const double rows = steps_to(bounds.theta_max_rad, step, "theta_max_deg") -
                      steps_to(bounds.theta_min_rad, step, "theta_min_deg");
  const double cols = steps_to(bounds.phi_max_rad, step, "phi_max_deg") -
                      steps_to(bounds.phi_min_rad, step, "phi_min_deg");
  require(rows * cols <= kMaxCells, "step_deg", "a step that leaves at most 10^7 cells");
  return {.theta_min_rad = bounds.theta_min_rad,
          .theta_step_rad = step,
          .rows = static_cast<int>(rows),
          .phi_min_rad = bounds.phi_min_rad,
          .phi_step_rad = step,
          .cols = static_cast<int>(cols)};
}

GridGeometry whole_sphere(double step_rad) {
  constexpr double kPi = std::numbers::pi;
  return make_grid_geometry({.theta_min_rad = 0.0,
                             .theta_max_rad = kPi,
                             .phi_min_rad = -kPi,
                             .phi_max_rad = kPi,
                             .step_rad = step_rad});
}

}  // namespace skyhalo

#include "skyhalo/sim/path_check.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "skyhalo/sim/setting_range.hpp"

namespace skyhalo {
namespace {

constexpr double kStepM = 0.05;
constexpr double kStepS = 0.01;

/// Whether the straight way between two points is cut by a surface.
bool is_cut(const SceneMoment& moment, const Eigen::Vector3d& from_m, const Eigen::Vector3d& to_m) {
  const Eigen::Vector3d way_m = to_m - from_m;
  const double length_m = way_m.norm();
  if (!(length_m > 0.0)) {
    return false;
  }
  const SceneHit hit = moment.trace({from_m.cast<float>(), (way_m / length_m).cast<float>(), 0.5F},
                                    static_cast<float>(length_m));
  return hit.object == SceneHit::kFixed;
}

/// The moments at which a path is looked at: every 10 ms, and between them wherever it went on by
/// more than the step.
std::vector<double> moments_s(const Trajectory& trajectory, double end_s) {
  std::vector<double> moments{0.0};
  const auto at_m = [&](double t_s) -> Eigen::Vector3d {
    return trajectory.T_map_body(t_s).translation();
  };
  const auto steps = static_cast<int>(std::ceil(end_s / kStepS));
  for (int i = 1; i <= steps; ++i) {
    const double from_s = (i - 1) * kStepS;
    const double to_s = std::min(i * kStepS, end_s);
    const int pieces =
        std::max(1, static_cast<int>(std::ceil((at_m(to_s) - at_m(from_s)).norm() / kStepM)));
    for (int piece = 1; piece <= pieces; ++piece) {
      moments.push_back(from_s + (to_s - from_s) * piece / pieces);
    }
  }
  return moments;
}

}  // namespace

std::optional<Approach> first_collision(const SceneTracer& tracer,
                                        const Trajectory& trajectory,
                                        double until_s,
                                        double body_radius_m) {
  check_setting(body_radius_m, {.name = "the body's radius (m)", .least = 0.0, .most = 1000.0});
  const SceneMoment moment(tracer, {});
  std::optional<Approach> nearest;
  Eigen::Vector3d asked_m = trajectory.T_map_body(0.0).translation();
  bool first = true;
  for (const double t_s : moments_s(trajectory, std::min(until_s, trajectory.duration_s()))) {
    const Eigen::Vector3d position_m = trajectory.T_map_body(t_s).translation();
    const double moved_m = (position_m - asked_m).norm();
    if (!first && moved_m == 0.0) {
      continue;
    }
    const bool cut = is_cut(moment, asked_m, position_m);
    const double distance_m = cut ? 0.0 : tracer.clearance_m(position_m, body_radius_m);
    first = false;
    asked_m = position_m;
    if (!cut && !(distance_m < body_radius_m)) {
      if (nearest) {
        return nearest;  // the first approach is over
      }
      continue;
    }
    if (!nearest || distance_m < nearest->distance_m) {
      nearest = {t_s, position_m, distance_m};
    }
  }
  return nearest;
}

}  // namespace skyhalo

#include "skyhalo/sim/path_check.hpp"

#include <algorithm>
#include <cmath>

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

}  // namespace

std::optional<Approach> first_collision(const SceneTracer& tracer,
                                        const Trajectory& trajectory,
                                        double until_s,
                                        double body_radius_m) {
  const SceneMoment moment(tracer, {});
  const double end_s = std::min(until_s, trajectory.duration_s());
  const auto steps = static_cast<int>(std::ceil(end_s / kStepS)) + 1;
  std::optional<Approach> nearest;
  Eigen::Vector3d asked_m = Eigen::Vector3d::Constant(1e30);
  for (int i = 0; i < steps; ++i) {
    const double t_s = std::min(i * kStepS, end_s);
    const Eigen::Vector3d position_m = trajectory.T_map_body(t_s).translation();
    if (i > 0 && (position_m - asked_m).norm() < kStepM && i + 1 < steps) {
      continue;  // hardly moved
    }
    const bool cut = i > 0 && is_cut(moment, asked_m, position_m);
    asked_m = position_m;
    const double distance_m = cut ? 0.0 : tracer.clearance_m(position_m, body_radius_m);
    if (!(distance_m < body_radius_m)) {
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

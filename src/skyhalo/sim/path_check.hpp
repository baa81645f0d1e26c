#pragma once

#include <Eigen/Core>
#include <optional>

#include "skyhalo/sim/scene_tracer.hpp"
#include "skyhalo/sim/trajectory.hpp"

namespace skyhalo {

/// Where a flight comes nearest to what stands still.
struct Approach {
  double t_s = 0.0;
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();
  double distance_m = 0.0;  ///< from the body's origin to the nearest surface
};

/// The first moment at which a flight, up to a time (s), comes nearer than `body_radius_m` to a
/// surface that stands still, and the nearest it comes about then; none when it never does. The
/// path is looked at every 5 cm or closer, so that no wall is skipped. Movers are not asked: they
/// are somewhere else by then.
[[nodiscard]] std::optional<Approach> first_collision(const SceneTracer& tracer,
                                                      const Trajectory& trajectory,
                                                      double until_s,
                                                      double body_radius_m);

}  // namespace skyhalo

#include "skyhalo/sim/clear_orbit.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <vector>

#include "skyhalo/sim/path_check.hpp"

namespace skyhalo {
namespace {

constexpr double kLeastRadiusM = 0.5;
constexpr double kShrinking = 0.8;     // of the radius from try to try
constexpr double kSidewaysMps2 = 3.0;  // a gentle bank

OrbitSettings orbit_about(const Eigen::Vector3d& centre_m, double radius_m, double speed_mps) {
  OrbitSettings orbit;
  orbit.centre_m = centre_m;
  orbit.radius_m = radius_m;
  orbit.speed_mps = std::min(speed_mps, std::sqrt(kSidewaysMps2 * radius_m));
  return orbit;
}

}  // namespace

std::optional<OrbitSettings> clear_orbit(const Scene& scene,
                                         double speed_mps,
                                         double body_radius_m) {
  if (scene.route_m.empty()) {
    return std::nullopt;
  }
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& point_m : scene.route_m) {
    box.extend(point_m);
  }
  std::vector<Eigen::Vector3d> centres_m{box.center()};
  centres_m.insert(centres_m.end(), scene.route_m.begin(), scene.route_m.end());
  const SceneTracer tracer(scene);
  const double widest_m = std::max(0.5 * box.sizes().head<2>().minCoeff(), 10.0 * kLeastRadiusM);
  for (int tries = 0;; ++tries) {
    const double radius_m = widest_m * std::pow(kShrinking, tries);
    if (radius_m < kLeastRadiusM) {
      return std::nullopt;
    }
    for (const Eigen::Vector3d& centre_m : centres_m) {
      const OrbitSettings orbit = orbit_about(centre_m, radius_m, speed_mps);
      const Trajectory flight = fly_orbit(orbit);
      if (!first_collision(tracer, flight, flight.duration_s(), body_radius_m)) {
        return orbit;
      }
    }
  }
}

}  // namespace skyhalo

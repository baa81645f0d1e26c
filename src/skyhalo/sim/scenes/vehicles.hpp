#pragma once

#include <cstdint>

#include "skyhalo/sim/scene.hpp"

namespace skyhalo {

/// The materials of a car.
struct CarCover {
  std::uint16_t paint = 0;
  std::uint16_t glass = 0;
  std::uint16_t rubber = 0;
  std::uint16_t light = 0;
};

/// Length, width and height of `car_mesh` (m).
inline const Eigen::Vector3d kCarSizeM{4.3, 1.84, 1.5};

/// Adds the materials, the paint in several colours: one cover each.
std::vector<CarCover> add_car_covers(Scene& scene, std::uint64_t seed);

/// A car: x forward, z up, origin in the middle of its underside, on the ground.
[[nodiscard]] TriangleMesh car_mesh(const CarCover& cover);

/// Puts a car at rest on a flat place (m), turned by `yaw_rad` from x towards y.
void park_car(TriangleMesh& mesh,
              const CarCover& cover,
              const Eigen::Vector3f& place_m,
              float yaw_rad);

}  // namespace skyhalo

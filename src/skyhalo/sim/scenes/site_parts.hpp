#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "skyhalo/sim/shapes.hpp"
#include "skyhalo/sim/triangle_mesh.hpp"

namespace skyhalo {

/// The materials of a house.
struct HouseCover {
  std::uint16_t wall = 0;
  float wall_edge_m = 12.0F;  ///< length of the wall's texture
  std::uint16_t roof = 0;
  std::uint16_t trim = 0;  ///< cornice, doors, frames
};

/// A block with a cornice along its fronts, those at either end of its own y; blocks may stand side
/// by side. The shape's foot is below the ground by a little.
void add_block(TriangleMesh& mesh, const BoxShape& block, const HouseCover& cover);

/// A house with a pitched roof whose ridge runs along its own x axis.
void add_gabled_house(TriangleMesh& mesh, const BoxShape& house, const HouseCover& cover);

/// A lamp post with an arm of `arm_m`, pointing to `yaw_rad`.
void add_lamp_post(TriangleMesh& mesh,
                   const Eigen::Vector3f& foot_m,
                   float height_m,
                   float yaw_rad,
                   const Cover& cover);

/// A cable that sags.
struct CableShape {
  Eigen::Vector3f from_m = Eigen::Vector3f::Zero();
  Eigen::Vector3f to_m = Eigen::Vector3f::UnitX();
  float sag_m = 0.3F;
  float radius_m = 0.01F;
  int pieces = 10;
};

void add_cable(TriangleMesh& mesh, const CableShape& cable, std::uint16_t material);

/// A shipping container on the ground, 6 m by 2.4 m by 2.6 m, turned by `yaw_rad`.
void add_container(TriangleMesh& mesh,
                   const Eigen::Vector3f& place_m,
                   float yaw_rad,
                   std::uint16_t sheet,
                   std::uint16_t frame);

/// Even ground at z = 0.
inline float flat_ground(float /*x*/, float /*y*/) noexcept {
  return 0.0F;
}

}  // namespace skyhalo

#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "skyhalo/sim/random_numbers.hpp"
#include "skyhalo/sim/scenes/flight_lane.hpp"
#include "skyhalo/sim/triangle_mesh.hpp"

namespace skyhalo {

/// Where plants grow: into a mesh, beside a lane that stays clear.
struct Plot {
  TriangleMesh& mesh;
  const FlightLane& lane;
  RandomNumbers random;
};

/// The materials of a plant. Those of leaves go by the vertices' places in the texture.
struct PlantCover {
  std::uint16_t bark = 0;
  std::uint16_t leaf = 0;
};

struct TreeShape {
  Eigen::Vector3f foot_m = Eigen::Vector3f::Zero();
  float height_m = 10.0F;
  float trunk_radius_m = 0.2F;    ///< at the foot
  float branch_radius_m = 0.04F;  ///< where a branch begins
  float crown_from_m = 3.5F;      ///< height of the lowest branches over the foot
  float crown_radius_m = 3.0F;
  int leaves = 500;
};

/// A tree with a round crown: branches that carry clumps of leaves.
void add_broadleaf(Plot& plot, const TreeShape& tree, const PlantCover& cover);

/// A fir: storeys of branches, shorter towards the top, all over the trunk above `crown_from_m`.
void add_conifer(Plot& plot, const TreeShape& tree, const PlantCover& cover);

/// A trunk with a few dead branches.
void add_snag(Plot& plot, const TreeShape& tree, const PlantCover& cover);

/// A ball of leaves of this radius on the ground.
void add_bush(Plot& plot, const Eigen::Vector3f& foot_m, float radius_m, const PlantCover& cover);

/// Upright blades from one foot, as of ferns, grass or reed.
struct TuftShape {
  Eigen::Vector3f foot_m = Eigen::Vector3f::Zero();
  float height_m = 0.5F;
  float width_m = 0.06F;  ///< of a blade
  float lean = 0.5F;      ///< how far a blade's tip is aside, in heights
  int blades = 10;
};

void add_tuft(Plot& plot, const TuftShape& tuft, std::uint16_t material);

}  // namespace skyhalo

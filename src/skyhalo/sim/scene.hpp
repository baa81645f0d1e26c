#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "skyhalo/sim/lighting.hpp"
#include "skyhalo/sim/material.hpp"
#include "skyhalo/sim/moving_object.hpp"
#include "skyhalo/sim/texture.hpp"
#include "skyhalo/sim/triangle_mesh.hpp"

namespace skyhalo {

/// A place to fly in: what stands, what moves, and the light. Its frame has z up.
struct Scene {
  std::string name;
  std::vector<Texture> textures;
  std::vector<Material> materials;  ///< of all meshes
  TriangleMesh fixed;               ///< all that stands still
  std::vector<MovingObject> movers;
  Lighting lighting;
  std::vector<Eigen::Vector3d> route_m;  ///< a way for a flight that shows the scene; may be none
  bool route_closed = false;
};

/// Throws `Error` (input) for a mesh that `check` refuses, a material or texture that is not there
/// and a mover without a way.
void check(const Scene& scene);

}  // namespace skyhalo

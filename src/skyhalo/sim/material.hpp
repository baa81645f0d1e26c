#pragma once

#include <Eigen/Core>
#include <string>

namespace skyhalo {

/// How a triangle's points find their place in the texture.
enum class TextureMapping {
  kVertices,  ///< by the mesh's `uvs`
  kPosition,  ///< by the position in the mesh's frame, seen along the axis nearest to the normal
};

/// What a surface looks like, to cameras and to the laser.
struct Material {
  std::string name;
  Eigen::Vector3f colour_bgr = Eigen::Vector3f::Constant(0.5F);  ///< share of light thrown back
  int texture = -1;  ///< index among the scene's, multiplied with the colour; negative: none
  TextureMapping mapping = TextureMapping::kPosition;
  float texture_edge_m = 2.0F;  ///< `kPosition`: how long one texture is on the surface, > 0
  float variation = 0.0F;       ///< 0...1: how much pairs of triangles (quads) differ in brightness
  float mirror = 0.0F;          ///< 0...1: share of the sky's reflection, as of water
  float laser_reflectivity = 0.4F;  ///< 0...1; 0 sends nothing back
};

}  // namespace skyhalo

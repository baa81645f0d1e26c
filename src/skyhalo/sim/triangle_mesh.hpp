#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include "skyhalo/geometry/pose.hpp"

namespace skyhalo {

/// Triangles in a frame of their own or the scene's (m), seen from both sides.
struct TriangleMesh {
  std::vector<Eigen::Vector3f> vertices_m;
  std::vector<Eigen::Vector2f>
      uvs;  ///< place in the texture, 1 is a whole one; per vertex, or none
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< indices of vertices
  std::vector<std::uint16_t> materials;                 ///< of each triangle, by index
};

/// Adds a mesh, moved by `T_whole_part`, to another one, not to itself. A mesh with and one without
/// places in the texture may meet: those of the latter are zero.
void append(TriangleMesh& whole, const TriangleMesh& part, const Pose& T_whole_part);

/// The smallest box round the vertices (m); empty without any.
[[nodiscard]] Eigen::AlignedBox3d bounds_of(const TriangleMesh& mesh);

/// Throws `Error` (input) beginning with `name` for a mesh without triangles, a coordinate that is
/// not finite or beyond 100 km, a triangle whose vertex is not there, and lists of unequal lengths.
void check(const TriangleMesh& mesh, std::string_view name);

}  // namespace skyhalo

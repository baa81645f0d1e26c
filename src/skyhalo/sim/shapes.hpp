#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "skyhalo/sim/triangle_mesh.hpp"

namespace skyhalo {

// Each function adds one body to a mesh, with places in the texture, all of one material. Every
// body but a leaf, a quad and a ground is closed, and its triangles come in pairs that make one
// quad, counter-clockwise seen from outside. The meshes must have places in the texture or be
// empty.

/// What a surface is covered with.
struct Cover {
  std::uint16_t material = 0;
  float texture_edge_m = 0.0F;  ///< one texture's length on it; 0: one texture per face
};

/// A box that stands upright.
struct BoxShape {
  Eigen::Vector3f middle_m = Eigen::Vector3f::Zero();
  Eigen::Vector3f size_m = Eigen::Vector3f::Ones();  ///< along its own axes, > 0
  float yaw_rad = 0.0F;                              ///< of its own x axis, from x towards y
};

void add_box(TriangleMesh& mesh, const BoxShape& box, const Cover& cover);

/// A round bar that may taper.
struct TubeShape {
  Eigen::Vector3f from_m = Eigen::Vector3f::Zero();
  Eigen::Vector3f to_m = Eigen::Vector3f::UnitZ();  ///< elsewhere than `from_m`
  float from_radius_m = 0.1F;                       ///< > 0
  float to_radius_m = 0.1F;                         ///< >= 0; 0 makes a cone
  int sides = 6;                                    ///< even, >= 4
};

void add_tube(TriangleMesh& mesh, const TubeShape& tube, const Cover& cover);

/// A body with the same outline across its whole width.
struct PrismShape {
  /// Convex, an even number of (forward, up) points, counter-clockwise seen from the right (-y).
  std::vector<Eigen::Vector2f> outline_m;
  Eigen::Vector3f middle_m = Eigen::Vector3f::Zero();  ///< where (0, 0) is, halfway across
  float width_m = 1.0F;                                ///< > 0
  float yaw_rad = 0.0F;                                ///< of forward, from x towards y
};

void add_prism(TriangleMesh& mesh, const PrismShape& prism, const Cover& cover);

/// A ball with a radius of its own along each axis.
struct EllipsoidShape {
  Eigen::Vector3f middle_m = Eigen::Vector3f::Zero();
  Eigen::Vector3f radius_m = Eigen::Vector3f::Ones();  ///< > 0
  int sides = 8;                                       ///< round the upright axis; even, >= 4
  int rings = 4;                                       ///< from pole to pole, >= 2
};

void add_ellipsoid(TriangleMesh& mesh, const EllipsoidShape& ball, const Cover& cover);

/// An ellipsoid whose points are moved in and out by up to `roughness` (0...1) of the radius.
void add_rock(TriangleMesh& mesh,
              const EllipsoidShape& ball,
              float roughness,
              std::uint64_t seed,
              const Cover& cover);

/// Four corners, counter-clockwise from the lower left one as the texture has it.
void add_quad(TriangleMesh& mesh,
              const std::array<Eigen::Vector3f, 4>& corners_m,
              const Cover& cover);

/// A leaf: a pointed quad of two triangles.
struct LeafShape {
  Eigen::Vector3f middle_m = Eigen::Vector3f::Zero();
  Eigen::Vector3f along_m = Eigen::Vector3f::UnitX();  ///< from the middle to the tip
  Eigen::Vector3f aside_m = Eigen::Vector3f::UnitY();  ///< from the middle to the side
  Eigen::Vector2f uv = Eigen::Vector2f::Zero();        ///< where its piece of the texture begins
};

/// `uv_edge` is the size of the piece of the texture on it.
void add_leaf(TriangleMesh& mesh, const LeafShape& leaf, float uv_edge, std::uint16_t material);

/// A rectangle of ground.
struct GroundShape {
  Eigen::Vector2f from_m = Eigen::Vector2f::Zero();  ///< its corner with the least x and y
  Eigen::Vector2f to_m = Eigen::Vector2f::Ones();    ///< and that with the greatest
  int cells_x = 1;                                   ///< quads along x, > 0
  int cells_y = 1;                                   ///< and along y
};

/// `height_m` gives z at (x, y).
void add_ground(TriangleMesh& mesh,
                const GroundShape& ground,
                const std::function<float(float, float)>& height_m,
                const Cover& cover);

}  // namespace skyhalo

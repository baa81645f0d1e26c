#include "skyhalo/sim/scenes/vehicles.hpp"

#include "skyhalo/sim/scenes/scene_parts.hpp"
#include "skyhalo/sim/shapes.hpp"

namespace skyhalo {
namespace {

using Eigen::Vector3f;

constexpr float kPaintEdgeM = 1.3F;

void add_body(TriangleMesh& mesh, const CarCover& cover) {
  add_prism(mesh,
            {.outline_m = {{-2.08F, 0.24F},
                           {2.08F, 0.24F},
                           {2.15F, 0.60F},
                           {1.85F, 0.80F},
                           {-2.02F, 0.92F},
                           {-2.15F, 0.60F}},
             .width_m = 1.76F},
            {cover.paint, kPaintEdgeM});
  add_prism(mesh,
            {.outline_m = {{-1.85F, 0.85F}, {1.10F, 0.75F}, {0.30F, 1.43F}, {-1.35F, 1.45F}},
             .width_m = 1.56F},
            {cover.glass, kPaintEdgeM});
  add_prism(mesh,
            {.outline_m = {{-1.40F, 1.42F}, {0.34F, 1.40F}, {0.20F, 1.48F}, {-1.25F, 1.50F}},
             .width_m = 1.62F},
            {cover.paint, kPaintEdgeM});
  for (const float x : {-0.62F, 0.28F}) {  // pillars
    add_prism(mesh,
              {.outline_m = {{x, 0.8F}, {x + 0.1F, 0.8F}, {x + 0.05F, 1.43F}, {x - 0.05F, 1.43F}},
               .width_m = 1.60F},
              {cover.paint, kPaintEdgeM});
  }
}

}  // namespace

std::vector<CarCover> add_car_covers(Scene& scene, std::uint64_t seed) {
  CarCover cover;
  cover.paint = add_surface(scene, {.name = "car paint", .pattern = Pattern::kMetal}, seed);
  cover.glass = add_plain(scene, "car glass", {0.10F, 0.09F, 0.08F});
  scene.materials.back().mirror = 0.25F;
  cover.rubber = add_plain(scene, "rubber", {0.06F, 0.06F, 0.06F});
  cover.light = add_plain(scene, "car light", {0.75F, 0.85F, 0.9F});
  std::vector<CarCover> covers;
  const std::array<Vector3f, 6> colours{Vector3f(0.15F, 0.15F, 0.75F),
                                        Vector3f(0.70F, 0.35F, 0.12F),
                                        Vector3f(0.85F, 0.85F, 0.85F),
                                        Vector3f(0.20F, 0.21F, 0.22F),
                                        Vector3f(0.15F, 0.65F, 0.85F),
                                        Vector3f(0.30F, 0.45F, 0.20F)};
  for (const Vector3f& colour : colours) {
    CarCover painted = cover;
    painted.paint = add_tinted(scene, cover.paint, colour);
    covers.push_back(painted);
  }
  return covers;
}

TriangleMesh car_mesh(const CarCover& cover) {
  TriangleMesh mesh;
  add_body(mesh, cover);
  for (const float x : {-1.32F, 1.30F}) {
    for (const float y : {-0.80F, 0.80F}) {
      const float half = 0.12F;
      add_tube(mesh,
               {{x, y - half, 0.32F}, {x, y + half, 0.32F}, 0.32F, 0.32F, 14},
               {cover.rubber, 0.0F});
      add_tube(mesh,
               {{x, y - half - 0.01F, 0.32F}, {x, y + half + 0.01F, 0.32F}, 0.17F, 0.17F, 8},
               {cover.light, 0.0F});
    }
  }
  for (const float y : {-0.62F, 0.62F}) {
    add_box(mesh, {{2.08F, y, 0.62F}, {0.14F, 0.34F, 0.13F}}, {cover.light, 0.0F});
    add_box(mesh, {{-2.08F, y, 0.68F}, {0.12F, 0.30F, 0.14F}}, {cover.paint, 0.0F});
  }
  return mesh;
}

void park_car(TriangleMesh& mesh,
              const CarCover& cover,
              const Eigen::Vector3f& place_m,
              float yaw_rad) {
  const Eigen::AngleAxisd turn(yaw_rad, Eigen::Vector3d::UnitZ());
  append(mesh, car_mesh(cover), make_pose(turn.toRotationMatrix(), place_m.cast<double>()));
}

}  // namespace skyhalo

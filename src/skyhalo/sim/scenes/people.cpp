#include "skyhalo/sim/scenes/people.hpp"

#include <array>

#include "skyhalo/sim/scenes/scene_parts.hpp"
#include "skyhalo/sim/shapes.hpp"

namespace skyhalo {
namespace {

using Eigen::Vector3f;

constexpr float kClothEdgeM = 0.5F;

void add_leg(TriangleMesh& mesh, const PersonCover& cover, float y, float step_m) {
  const Vector3f hip(0.0F, y, 0.90F);
  const Vector3f knee(0.5F * step_m + 0.05F, y, 0.48F);
  const Vector3f ankle(step_m, y, 0.08F);
  add_tube(mesh, {hip, knee, 0.10F, 0.075F, 8}, {cover.trousers, kClothEdgeM});
  add_tube(mesh, {knee, ankle, 0.075F, 0.06F, 8}, {cover.trousers, kClothEdgeM});
  add_box(mesh, {ankle + Vector3f(0.06F, 0.0F, -0.03F), {0.26F, 0.10F, 0.1F}}, {cover.hair, 0.0F});
}

void add_arm(TriangleMesh& mesh, const PersonCover& cover, float y, float swing_m) {
  const Vector3f shoulder(0.0F, y, 1.42F);
  const Vector3f elbow(0.4F * swing_m, 1.15F * y, 1.13F);
  const Vector3f hand(swing_m + 0.06F, 1.1F * y, 0.90F);
  add_tube(mesh, {shoulder, elbow, 0.06F, 0.05F, 6}, {cover.shirt, kClothEdgeM});
  add_tube(mesh, {elbow, hand, 0.045F, 0.04F, 6}, {cover.skin, kClothEdgeM});
}

}  // namespace

std::vector<PersonCover> add_person_covers(Scene& scene, std::uint64_t seed) {
  const std::uint16_t checked = add_surface(scene, {"shirt", Pattern::kCloth}, seed);
  const std::uint16_t plain =
      add_surface(scene, {"trousers", Pattern::kMetal, 0.0F, {0.45F, 0.30F, 0.22F}}, seed);
  const std::uint16_t skin = add_plain(scene, "skin", {0.45F, 0.56F, 0.75F});
  const std::uint16_t hair = add_plain(scene, "hair", {0.08F, 0.11F, 0.15F});
  std::vector<PersonCover> covers;
  covers.reserve(4);
  const std::array<Vector3f, 4> colours{Vector3f(1.0F, 1.0F, 1.1F),
                                        Vector3f(0.5F, 0.7F, 1.5F),
                                        Vector3f(1.5F, 0.9F, 0.5F),
                                        Vector3f(0.6F, 1.3F, 0.8F)};
  for (const Vector3f& colour : colours) {
    covers.push_back({add_tinted(scene, checked, colour), plain, skin, hair});
  }
  return covers;
}

TriangleMesh person_mesh(const PersonCover& cover) {
  TriangleMesh mesh;
  add_leg(mesh, cover, 0.10F, 0.24F);
  add_leg(mesh, cover, -0.10F, -0.26F);
  add_tube(mesh,
           {{0.0F, 0.0F, 0.84F}, {0.0F, 0.0F, 1.25F}, 0.17F, 0.20F, 10},
           {cover.shirt, kClothEdgeM});
  add_ellipsoid(
      mesh, {{0.0F, 0.0F, 1.28F}, {0.16F, 0.23F, 0.24F}, 10, 6}, {cover.shirt, kClothEdgeM});
  add_arm(mesh, cover, 0.23F, -0.20F);
  add_arm(mesh, cover, -0.23F, 0.22F);
  add_tube(mesh, {{0.0F, 0.0F, 1.42F}, {0.01F, 0.0F, 1.58F}, 0.06F, 0.06F, 6}, {cover.skin, 1.0F});
  add_ellipsoid(mesh, {{0.02F, 0.0F, 1.64F}, {0.11F, 0.09F, 0.13F}, 10, 6}, {cover.skin, 1.0F});
  add_ellipsoid(mesh, {{-0.02F, 0.0F, 1.68F}, {0.11F, 0.10F, 0.10F}, 10, 6}, {cover.hair, 1.0F});
  return mesh;
}

}  // namespace skyhalo

#include "skyhalo/sim/scenes/fence.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "skyhalo/sim/random_numbers.hpp"
#include "skyhalo/sim/scenes/plants.hpp"
#include "skyhalo/sim/scenes/scene_parts.hpp"
#include "skyhalo/sim/scenes/site_parts.hpp"
#include "skyhalo/sim/shapes.hpp"

namespace skyhalo {
namespace {

using Eigen::Vector2f;
using Eigen::Vector3f;

constexpr float kCourtX = 15.0F;  // half the court within the nets
constexpr float kCourtY = 9.0F;
constexpr float kNetM = 4.0F;  // height of the nets

FlightLane lane_of() {
  return {closed_curve(48,
                       [](double angle) -> Eigen::Vector3d {
                         // Between the nets and the pales, an oval that is nearly a rectangle.
                         const double c = std::cos(angle);
                         const double s = std::sin(angle);
                         const auto bent = [](double x) {
                           return std::copysign(std::pow(std::abs(x), 0.7), x);
                         };
                         return {20.0 * bent(c), 14.0 * bent(s), 2.9 + 0.5 * std::sin(3.0 * angle)};
                       }),
          true};
}

/// The materials of the ground.
struct Ground {
  std::uint16_t grass = 0;
  std::uint16_t court = 0;
  std::uint16_t line = 0;
  std::uint16_t wire = 0;
  std::uint16_t post = 0;
  std::uint16_t pale = 0;
  HouseCover house;
  PlantCover tree;
};

Ground add_materials(Scene& scene, std::uint64_t seed) {
  Ground ground;
  ground.grass = add_surface(scene, {"grass", Pattern::kGrass}, seed);
  ground.court = add_surface(scene, {"court", Pattern::kAsphalt, 0.0F, {0.9F, 1.2F, 2.6F}}, seed);
  ground.line = add_plain(scene, "line", {0.85F, 0.85F, 0.85F});
  ground.wire = add_plain(scene, "net wire", {0.45F, 0.62F, 0.45F});
  ground.post = add_surface(scene, {"post", Pattern::kMetal, 0.0F, {0.4F, 0.6F, 0.4F}}, seed);
  ground.pale = add_surface(scene, {"pale", Pattern::kPlanks, 0.0F, {1.6F, 1.5F, 1.4F}}, seed);
  const auto brick = add_surface(scene, {"brick", Pattern::kBrick}, seed);
  const auto roof = add_surface(scene, {"roof", Pattern::kTiles, 0.0F, {0.5F, 0.55F, 0.9F}}, seed);
  ground.house = {brick, 3.0F, roof, ground.pale};
  ground.tree.bark = add_surface(scene, {"bark", Pattern::kBark}, seed);
  ground.tree.leaf =
      add_surface(scene, {"leaves", Pattern::kLeaf, 0.0F, {0.9F, 1.1F, 1.0F}, 0.4F}, seed);
  return ground;
}

/// An upright panel from one foot to another.
struct Panel {
  Vector2f from_m;
  Vector2f to_m;
  float height_m;

  /// A point along it and up (m).
  [[nodiscard]] Vector3f at(float along_m, float up_m) const {
    const Vector2f p = from_m + along_m * (to_m - from_m).normalized();
    return {p.x(), p.y(), up_m};
  }

  [[nodiscard]] float length_m() const { return (to_m - from_m).norm(); }
};

void add_bar(TriangleMesh& mesh,
             const Vector3f& from_m,
             const Vector3f& to_m,
             float radius_m,
             std::uint16_t material) {
  add_tube(mesh, {from_m, to_m, radius_m, radius_m, 4}, {material, 1.0F});
}

/// Wires that cross at right angles, aslant, `mesh_m` apart, with a post at either end.
void add_net(TriangleMesh& mesh, const Panel& panel, float mesh_m, const Ground& ground) {
  const float step_m = mesh_m * 1.41421356F;
  const float low_m = 0.08F;
  const float high_m = panel.height_m;
  const float length_m = panel.length_m();
  for (const float start : spaced(-(high_m - low_m) + 0.5F * step_m, length_m, step_m)) {
    const float begin = std::max(0.0F, start);
    const float end = std::min(length_m, start + high_m - low_m);
    if (end - begin > 0.02F) {
      const float rise = low_m + begin - start;
      const float top = low_m + end - start;
      add_bar(mesh, panel.at(begin, rise), panel.at(end, top), 0.006F, ground.wire);
      add_bar(mesh,
              panel.at(length_m - begin, rise),
              panel.at(length_m - end, top),
              0.006F,
              ground.wire);
    }
  }
  for (const float up_m : {low_m, high_m}) {
    add_bar(mesh, panel.at(0.0F, up_m), panel.at(length_m, up_m), 0.02F, ground.post);
  }
  add_tube(mesh,
           {panel.at(0.0F, -0.1F), panel.at(0.0F, high_m + 0.1F), 0.045F, 0.045F, 8},
           {ground.post, 1.0F});
}

/// The nets round the court, in panels of about 3 m, with a gate in one side.
void add_court(TriangleMesh& mesh, float mesh_m, const Ground& ground) {
  const std::array<Vector2f, 4> corners{Vector2f(-kCourtX, -kCourtY),
                                        Vector2f(kCourtX, -kCourtY),
                                        Vector2f(kCourtX, kCourtY),
                                        Vector2f(-kCourtX, kCourtY)};
  for (std::size_t side = 0; side < 4; ++side) {
    const Vector2f& from = corners[side];
    const Vector2f way = corners[(side + 1) % 4] - from;
    const int panels = static_cast<int>(way.norm() / 3.0F);
    for (int i = 0; i < panels; ++i) {
      if (side == 0 && i == panels / 2) {
        continue;  // the gate
      }
      const float step = 1.0F / static_cast<float>(panels);
      const float share = static_cast<float>(i) * step;
      add_net(mesh, {from + share * way, from + (share + step) * way, kNetM}, mesh_m, ground);
    }
  }
  add_box(mesh,
          {{0.0F, 0.0F, 0.01F}, {2.0F * kCourtX - 0.2F, 2.0F * kCourtY - 0.2F, 0.06F}},
          {ground.court, 5.0F});
  for (const float x : {-12.0F, -6.0F, 6.0F, 12.0F}) {
    add_box(mesh, {{x, 0.0F, 0.03F}, {0.08F, 11.0F, 0.03F}}, {ground.line, 0.0F});
  }
  for (const float y : {-5.5F, 5.5F}) {
    add_box(mesh, {{0.0F, y, 0.03F}, {24.0F, 0.08F, 0.034F}}, {ground.line, 0.0F});
  }
  add_net(mesh, {{0.0F, -6.0F}, {0.0F, 6.0F}, 1.1F}, std::max(mesh_m, 0.12F), ground);
}

/// Upright boards, all the same, with two rails.
void add_pales(TriangleMesh& mesh, const Panel& panel, float pitch_m, const Ground& ground) {
  const Vector2f way = (panel.to_m - panel.from_m).normalized();
  const float yaw_rad = std::atan2(way.y(), way.x());
  const float length_m = panel.length_m();
  for (const float s : spaced(0.5F * pitch_m, length_m, pitch_m)) {
    add_box(mesh,
            {panel.at(s, 0.5F * panel.height_m), {0.55F * pitch_m, 0.03F, panel.height_m}, yaw_rad},
            {ground.pale, 1.5F});
  }
  for (const float up_m : {0.25F * panel.height_m, 0.8F * panel.height_m}) {
    add_box(mesh,
            {panel.at(0.5F * length_m, up_m), {length_m, 0.09F, 0.1F}, yaw_rad},
            {ground.pale, 1.5F});
  }
}

/// Fences of pales and railings round the place, and across the route with gaps for it.
void add_fences(TriangleMesh& mesh, float pitch_m, const Ground& ground) {
  add_pales(mesh, {{-28.0F, -19.0F}, {28.0F, -19.0F}, 2.6F}, pitch_m, ground);
  add_pales(mesh, {{28.0F, -18.9F}, {28.0F, 19.0F}, 3.6F}, pitch_m, ground);
  add_pales(mesh, {{27.9F, 19.0F}, {-28.0F, 19.0F}, 2.6F}, pitch_m, ground);
  add_pales(mesh, {{-28.0F, 18.9F}, {-28.0F, -18.9F}, 3.6F}, pitch_m, ground);
  for (const float side : {-1.0F, 1.0F}) {
    for (const float x : {-8.0F, 9.0F}) {
      add_pales(mesh, {{x, side * 9.1F}, {x, side * 11.0F}, 4.2F}, pitch_m, ground);
      add_pales(mesh, {{x, side * 16.6F}, {x, side * 18.9F}, 4.2F}, pitch_m, ground);
    }
    add_net(mesh, {{side * 15.2F, 3.0F}, {side * 17.3F, 3.0F}, 4.5F}, 2.0F * pitch_m, ground);
    add_net(mesh, {{side * 22.7F, 3.0F}, {side * 27.8F, 3.0F}, 4.5F}, 2.0F * pitch_m, ground);
  }
}

void add_surroundings(Scene& scene,
                      const FlightLane& lane,
                      const Ground& ground,
                      std::uint64_t seed) {
  Plot plot{scene.fixed, lane, RandomNumbers(stirred(seed, 19))};
  RandomNumbers& random = plot.random;
  for (int i = 0; i < 26; ++i) {
    const float angle = 6.2832F * static_cast<float>(i) / 26.0F;
    const float x = 38.0F * std::cos(angle) + random.uniform(-3.0F, 3.0F);
    TreeShape tree{.foot_m = {x, 29.0F * std::sin(angle), 0.0F},
                   .height_m = random.uniform(6.0F, 11.0F),
                   .crown_from_m = 2.0F,
                   .crown_radius_m = random.uniform(1.8F, 2.8F),
                   .leaves = 620};
    add_broadleaf(plot, tree, ground.tree);
  }
  for (int i = 0; i < 7; ++i) {
    const float x = -48.0F + 16.0F * static_cast<float>(i);
    const float side = i % 2 == 0 ? 1.0F : -1.0F;
    add_gabled_house(scene.fixed, {{x, side * 44.0F, 2.6F}, {12.0F, 9.0F, 5.6F}}, ground.house);
  }
}

}  // namespace

Scene make_fence(double difficulty, std::uint64_t seed) {
  Scene scene;
  scene.name = "fence";
  const FlightLane lane = lane_of();
  const Ground ground = add_materials(scene, seed);
  add_ground(scene.fixed,
             {{-110.0F, -110.0F}, {110.0F, 110.0F}, 22, 22},
             flat_ground,
             {ground.grass, 4.5F});
  add_court(scene.fixed, graded(difficulty, 0.32F, 0.12F), ground);
  add_fences(scene.fixed, graded(difficulty, 0.30F, 0.13F), ground);
  add_surroundings(scene, lane, ground, seed);
  scene.lighting.sun_direction = sun_at(-125.0F, 48.0F);
  finish_scene(scene, lane, seed);
  return scene;
}

}  // namespace skyhalo

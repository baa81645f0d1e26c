#include "skyhalo/sim/scenes/street.hpp"

#include <cmath>
#include <vector>

#include "skyhalo/sim/random_numbers.hpp"
#include "skyhalo/sim/scenes/plants.hpp"
#include "skyhalo/sim/scenes/scene_parts.hpp"
#include "skyhalo/sim/scenes/site_parts.hpp"
#include "skyhalo/sim/scenes/vehicles.hpp"
#include "skyhalo/sim/shapes.hpp"

namespace skyhalo {
namespace {

using Eigen::Vector3f;

constexpr float kHalfLengthM = 62.0F;
constexpr float kHalfRoadM = 5.0F;
constexpr float kFrontM = 8.5F;  // from the middle of the road to the houses
constexpr float kDepthM = 12.0F;
constexpr float kKerbM = 0.15F;

FlightLane lane_of() {
  return {open_curve(31,
                     [](double share) -> Eigen::Vector3d {
                       const double x = -52.0 + 104.0 * share;
                       return {x, 1.8 * std::sin(x / 9.0), 3.6 + 0.9 * std::sin(x / 13.0)};
                     }),
          false};
}

/// The materials of the street.
struct Town {
  std::vector<HouseCover> houses;
  std::uint16_t road = 0;
  std::uint16_t pavement = 0;
  std::uint16_t line = 0;
  std::uint16_t trim = 0;
  std::uint16_t glass = 0;
  std::uint16_t metal = 0;
  PlantCover plane_tree;
};

Town add_materials(Scene& scene, double difficulty, std::uint64_t seed) {
  Town town;
  town.road = add_surface(scene, {"road", Pattern::kAsphalt}, seed);
  town.pavement = add_surface(scene, {"pavement", Pattern::kTiles}, seed);
  town.trim = add_surface(scene, {"trim", Pattern::kConcrete}, seed);
  town.line = add_plain(scene, "road line", {0.8F, 0.82F, 0.82F});
  town.metal = add_surface(scene, {"metal", Pattern::kMetal, 0.0F, {0.4F, 0.42F, 0.4F}}, seed);
  town.glass = add_plain(scene, "glass front", {0.30F, 0.24F, 0.18F});
  scene.materials.back().mirror = 0.35F;
  scene.materials.back().laser_reflectivity = 0.05F;
  const float fade = graded(difficulty, 0.0F, 0.6F);
  const auto plaster = add_faded(scene, {"plaster front", Pattern::kFacade}, fade, seed);
  const auto other = add_faded(scene, {"other front", Pattern::kFacade}, fade, seed + 1);
  const auto brick = add_faded(scene, {"brick front", Pattern::kBrick}, fade, seed);
  town.houses = {{plaster, 12.0F, town.trim, town.trim},
                 {other, 13.0F, town.trim, town.trim},
                 {add_tinted(scene, other, {0.75F, 0.95F, 1.1F}), 12.0F, town.trim, town.trim},
                 {add_tinted(scene, plaster, {1.05F, 0.95F, 0.8F}), 11.0F, town.trim, town.trim},
                 {brick, 4.0F, town.trim, town.trim}};
  town.plane_tree.bark =
      add_surface(scene, {"bark", Pattern::kBark, 0.0F, {1.3F, 1.4F, 1.4F}}, seed);
  town.plane_tree.leaf =
      add_surface(scene, {"leaves", Pattern::kLeaf, 0.0F, {0.9F, 1.15F, 1.1F}, 0.4F}, seed);
  return town;
}

void add_road(TriangleMesh& mesh, const Town& town) {
  add_ground(mesh, {{-90.0F, -40.0F}, {90.0F, 40.0F}, 20, 10}, flat_ground, {town.road, 6.0F});
  for (const float side : {-1.0F, 1.0F}) {
    const float middle_m = side * 0.5F * (kHalfRoadM + kFrontM + 0.5F);
    add_box(mesh,
            {{0.0F, middle_m, 0.5F * kKerbM - 0.1F},
             {2.0F * kHalfLengthM, kFrontM + 0.5F - kHalfRoadM, kKerbM + 0.2F}},
            {town.pavement, 4.0F});
  }
  for (const float x : spaced(-58.0F, 58.0F, 6.0F)) {
    add_box(mesh, {{x, 0.0F, 0.0F}, {3.0F, 0.15F, 0.02F}}, {town.line, 0.0F});
  }
  for (const float y : spaced(-4.2F, 4.5F, 1.2F)) {  // a crossing
    add_box(mesh, {{14.0F, y, 0.0F}, {4.0F, 0.6F, 0.024F}}, {town.line, 0.0F});
  }
}

/// Rows of windows with ledges, or of blank panes, before the front of a house.
void add_front(
    TriangleMesh& mesh, const BoxShape& house, float side, bool glass, const Town& town) {
  const float front_y = house.middle_m.y() - side * 0.5F * house.size_m.y();
  const float left_x = house.middle_m.x() - 0.5F * house.size_m.x();
  const int columns = static_cast<int>(house.size_m.x() / 3.0F);
  const float pitch_m = house.size_m.x() / static_cast<float>(columns);
  const int storeys = static_cast<int>((house.size_m.z() - 1.0F) / 3.0F);
  for (int storey = 0; storey < storeys; ++storey) {
    const float z = 1.9F + 3.0F * static_cast<float>(storey);
    if (!glass) {
      add_box(mesh,
              {{house.middle_m.x(), front_y, z + 1.5F}, {house.size_m.x() - 0.1F, 0.24F, 0.22F}},
              {town.trim, 2.0F});
    }
    for (int column = 0; column < columns; ++column) {
      const float x = left_x + pitch_m * (static_cast<float>(column) + 0.5F);
      if (glass) {
        add_box(mesh, {{x, front_y, z + 0.1F}, {pitch_m - 0.25F, 0.1F, 2.7F}}, {town.glass, 0.0F});
      } else if (storey > 0 && (column + storey) % 4 == 1) {
        const float y = front_y - side * 0.5F;
        add_box(mesh, {{x, y, z - 1.35F}, {2.2F, 1.0F, 0.18F}}, {town.trim, 2.0F});
        add_box(mesh, {{x, y - side * 0.45F, z - 0.8F}, {2.2F, 0.08F, 1.0F}}, {town.metal, 1.0F});
      }
    }
  }
}

void add_doors(TriangleMesh& mesh, const BoxShape& house, float side, const Town& town) {
  const float front_y = house.middle_m.y() - side * 0.5F * house.size_m.y();
  const float x = house.middle_m.x();
  add_box(mesh, {{x, front_y, 1.2F}, {1.5F, 0.3F, 2.3F}}, {town.metal, 2.0F});
  add_box(
      mesh, {{x - 3.5F, front_y - side * 0.6F, 2.75F}, {3.2F, 1.2F, 0.12F}}, {town.metal, 1.0F});
}

void add_houses(Scene& scene, const Town& town, double difficulty, RandomNumbers& random) {
  for (const float side : {-1.0F, 1.0F}) {
    float x = -kHalfLengthM;
    while (x < kHalfLengthM) {
      const float width_m = 9.0F + 3.0F * static_cast<float>(random.below(4));
      const float height_m =
          9.6F + 3.0F * static_cast<float>(random.below(4)) + random.uniform(0.0F, 0.4F);
      const float back_m = random.uniform(0.0F, 0.35F);
      const BoxShape house{
          {x + 0.5F * width_m, side * (kFrontM + back_m + 0.5F * kDepthM), 0.5F * height_m - 0.3F},
          {width_m - 0.05F, kDepthM, height_m}};
      const bool glass = random.chance(graded(difficulty, 0.0F, 0.65F));
      HouseCover cover = town.houses[static_cast<std::size_t>(random.below(5))];
      cover.wall = glass ? town.trim : cover.wall;
      add_block(scene.fixed, house, cover);
      add_front(scene.fixed, house, side, glass, town);
      add_doors(scene.fixed, house, side, town);
      x += width_m;
    }
  }
  for (const float x : {-78.0F, 78.0F}) {  // where the street ends
    add_block(scene.fixed, {{x, 0.0F, 6.0F}, {10.0F, 60.0F, 13.0F}}, town.houses[0]);
  }
}

void add_furniture(Scene& scene, const Town& town, const FlightLane& lane, RandomNumbers& random) {
  Plot plot{scene.fixed, lane, RandomNumbers(random.bits())};
  for (const float x : spaced(-52.0F, 54.0F, 15.0F)) {
    add_lamp_post(scene.fixed, {x, kHalfRoadM + 0.6F, kKerbM}, 6.6F, -1.5708F, {town.metal, 1.0F});
    add_lamp_post(
        scene.fixed, {x + 7.0F, -kHalfRoadM - 0.6F, kKerbM}, 6.6F, 1.5708F, {town.metal, 1.0F});
    TreeShape tree{.foot_m = {x + 4.0F, kHalfRoadM + 1.2F, kKerbM},
                   .height_m = random.uniform(5.5F, 7.5F),
                   .trunk_radius_m = 0.14F,
                   .crown_from_m = 2.4F,
                   .crown_radius_m = 1.7F,
                   .leaves = 850};
    add_broadleaf(plot, tree, town.plane_tree);
    tree.foot_m = {x - 1.0F, -kHalfRoadM - 1.2F, kKerbM};
    add_broadleaf(plot, tree, town.plane_tree);
    add_box(scene.fixed, {{x + 10.0F, 6.8F, 0.6F}, {0.6F, 0.5F, 1.1F}}, {town.metal, 1.0F});
  }
  for (const float x : {-33.0F, 27.0F}) {  // wires over the street, far above the route
    add_cable(scene.fixed,
              {{x, -kFrontM - 0.2F, 8.2F}, {x + 1.0F, kFrontM + 0.2F, 8.4F}, 0.5F, 0.02F},
              town.metal);
  }
}

void park_cars(Scene& scene, double difficulty, RandomNumbers& random) {
  const auto covers = add_car_covers(scene, random.bits());
  const float share = graded(difficulty, 0.25F, 0.9F);
  for (const float side : {-1.0F, 1.0F}) {
    for (const float x : spaced(-50.0F, 52.0F, 6.2F)) {
      const auto& cover = covers[static_cast<std::size_t>(random.below(6))];
      const float jitter_m = random.uniform(-0.5F, 0.5F);
      if (random.chance(share) && std::abs(x - 14.0F) > 4.5F) {
        const Vector3f place(x + jitter_m, side * (kHalfRoadM - 1.05F), 0.0F);
        park_car(scene.fixed, cover, place, side > 0.0F ? 3.1416F : 0.0F);
      }
    }
  }
}

}  // namespace

Scene make_street(double difficulty, std::uint64_t seed) {
  Scene scene;
  scene.name = "street";
  RandomNumbers random(stirred(seed, 11));
  const FlightLane lane = lane_of();
  const Town town = add_materials(scene, difficulty, seed);
  add_road(scene.fixed, town);
  add_houses(scene, town, difficulty, random);
  add_furniture(scene, town, lane, random);
  park_cars(scene, difficulty, random);
  scene.lighting.sun_direction = sun_at(-60.0F, 58.0F);
  scene.lighting.ambient_bgr = {0.55F, 0.52F, 0.50F};
  finish_scene(scene, lane, seed);
  return scene;
}

}  // namespace skyhalo

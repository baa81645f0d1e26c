#include "skyhalo/sim/scenes/yard.hpp"

#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "skyhalo/sim/random_numbers.hpp"
#include "skyhalo/sim/scenes/people.hpp"
#include "skyhalo/sim/scenes/plants.hpp"
#include "skyhalo/sim/scenes/scene_parts.hpp"
#include "skyhalo/sim/scenes/site_parts.hpp"
#include "skyhalo/sim/scenes/vehicles.hpp"
#include "skyhalo/sim/shapes.hpp"

namespace skyhalo {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::Vector3f;

/// Over the heads of people (1.8 m) and beside the cars' ways, or well over them.
FlightLane lane_of() {
  return {closed_curve(44,
                       [](double angle) -> Vector3d {
                         return {19.0 * std::cos(angle),
                                 12.0 * std::sin(angle) + 1.5 * std::sin(3.0 * angle),
                                 3.7 + 0.4 * std::sin(2.0 * angle)};
                       }),
          true};
}

/// The materials of the yard.
struct Court {
  std::uint16_t asphalt = 0;
  std::uint16_t paving = 0;
  std::uint16_t grass = 0;
  std::uint16_t concrete = 0;
  std::uint16_t door = 0;
  std::uint16_t metal = 0;
  std::uint16_t line = 0;
  std::uint16_t crate = 0;
  std::array<std::uint16_t, 3> sheets{};
  HouseCover flats;
  HouseCover hall;
  HouseCover garage;
  PlantCover tree;
};

Court add_materials(Scene& scene, std::uint64_t seed) {
  Court court;
  court.asphalt =
      add_surface(scene, {"asphalt", Pattern::kAsphalt, 0.0F, {1.4F, 1.4F, 1.4F}}, seed);
  court.paving = add_surface(scene, {"paving", Pattern::kTiles}, seed);
  court.grass = add_surface(scene, {"grass", Pattern::kGrass}, seed);
  court.concrete = add_surface(scene, {"concrete", Pattern::kConcrete}, seed);
  court.metal = add_surface(scene, {"metal", Pattern::kMetal, 0.0F, {0.45F, 0.45F, 0.42F}}, seed);
  court.line = add_plain(scene, "line", {0.8F, 0.82F, 0.82F});
  court.crate = add_surface(scene, {"crate", Pattern::kCrate}, seed);
  court.sheets[0] =
      add_surface(scene, {"container", Pattern::kCorrugated, 0.0F, {0.30F, 0.40F, 1.0F}}, seed);
  court.sheets[1] = add_tinted(scene, court.sheets[0], {1.0F, 0.6F, 0.25F});
  court.sheets[2] = add_tinted(scene, court.sheets[0], {0.45F, 0.9F, 0.5F});
  court.door = add_tinted(scene, court.sheets[0], {0.75F, 0.85F, 0.9F});
  const auto front = add_surface(scene, {"flats", Pattern::kFacade}, seed);
  const auto brick = add_surface(scene, {"brick", Pattern::kBrick}, seed);
  const auto plaster =
      add_surface(scene, {"plaster", Pattern::kPlaster, 0.0F, {0.75F, 0.9F, 1.0F}}, seed);
  court.flats = {front, 12.0F, court.concrete, court.concrete};
  court.hall = {brick, 4.0F, court.concrete, court.concrete};
  court.garage = {plaster, 4.0F, court.concrete, court.concrete};
  court.tree.bark = add_surface(scene, {"bark", Pattern::kBark}, seed);
  court.tree.leaf =
      add_surface(scene, {"leaves", Pattern::kLeaf, 0.0F, {0.9F, 1.1F, 1.1F}, 0.4F}, seed);
  return court;
}

void add_grounds(TriangleMesh& mesh, const Court& court) {
  add_ground(mesh, {{-90.0F, -90.0F}, {90.0F, 90.0F}, 20, 20}, flat_ground, {court.asphalt, 5.0F});
  add_box(mesh, {{0.0F, 0.0F, 0.03F}, {14.0F, 8.0F, 0.2F}}, {court.grass, 4.0F});
  add_box(mesh, {{0.0F, 0.0F, 0.0F}, {16.0F, 10.0F, 0.16F}}, {court.paving, 4.0F});
  for (const float side : {-1.0F, 1.0F}) {
    add_box(mesh, {{0.0F, side * 21.5F, 0.0F}, {58.0F, 3.0F, 0.24F}}, {court.paving, 4.0F});
  }
  for (const float x : spaced(-22.0F, 23.0F, 2.75F)) {  // parking places
    add_box(mesh, {{x, -17.4F, 0.0F}, {0.1F, 4.6F, 0.02F}}, {court.line, 0.0F});
  }
}

void add_buildings(TriangleMesh& mesh, const Court& court) {
  add_block(mesh, {{-14.0F, 30.0F, 5.9F}, {30.0F, 12.0F, 12.0F}}, court.flats);
  add_block(mesh, {{19.0F, 31.0F, 4.4F}, {32.0F, 12.0F, 9.0F}}, court.hall);
  add_block(mesh, {{-36.0F, 4.0F, 4.4F}, {8.0F, 36.0F, 9.0F}}, court.hall);
  for (const float z : {1.5F, 4.5F, 7.5F}) {
    for (const float y : spaced(-8.0F, 18.0F, 4.0F)) {
      add_box(mesh, {{-31.95F, y, z + 0.2F}, {0.3F, 1.8F, 1.5F}}, {court.metal, 1.5F});
    }
    for (const float x : spaced(8.0F, 34.0F, 4.0F)) {
      add_box(mesh, {{x, 24.95F, z + 0.2F}, {1.8F, 0.3F, 1.5F}}, {court.metal, 1.5F});
    }
  }
  for (int i = 0; i < 12; ++i) {  // a row of garages
    const float x = -30.0F + 5.0F * static_cast<float>(i);
    const float lift_m = 0.05F * static_cast<float>(i % 3);
    add_block(mesh, {{x, -26.5F, 1.35F + lift_m}, {4.9F, 6.0F, 2.9F}}, court.garage);
    add_box(mesh, {{x, -23.5F, 1.15F}, {2.9F, 0.12F, 2.3F}}, {court.door, 2.4F});
  }
  add_box(mesh, {{33.0F, -4.0F, 1.3F}, {0.35F, 52.0F, 2.9F}}, {court.hall.wall, 4.0F});
  add_box(mesh, {{33.0F, -4.0F, 2.8F}, {0.55F, 52.0F, 0.12F}}, {court.concrete, 2.0F});
  add_block(mesh, {{60.0F, 0.0F, 7.0F}, {14.0F, 50.0F, 14.5F}}, court.flats);
  add_block(mesh, {{5.0F, -52.0F, 7.5F}, {56.0F, 14.0F, 15.5F}}, court.flats);
  add_block(mesh, {{-46.0F, -42.0F, 5.5F}, {24.0F, 14.0F, 11.5F}}, court.hall);
}

void add_goods(TriangleMesh& mesh, const Court& court) {
  add_container(mesh, {28.0F, 10.0F, 0.0F}, 1.57F, court.sheets[0], court.metal);
  add_container(mesh, {28.2F, 16.5F, 0.0F}, 1.60F, court.sheets[1], court.metal);
  add_container(mesh, {28.1F, 10.2F, 2.66F}, 1.55F, court.sheets[2], court.metal);
  add_container(mesh, {-27.0F, 16.0F, 0.0F}, 0.15F, court.sheets[2], court.metal);
  for (const auto& [x, y, size] : {std::array{-4.0F, 1.0F, 1.0F},
                                   std::array{-2.8F, 1.3F, 0.8F},
                                   std::array{29.0F, -12.0F, 1.2F},
                                   std::array{29.4F, -10.4F, 0.9F},
                                   std::array{-29.5F, -12.0F, 1.1F},
                                   std::array{-29.0F, -10.5F, 1.0F}}) {
    add_box(mesh, {{x, y, 0.5F * size + 0.131F}, {size, size, size}, x}, {court.crate, 0.0F});
  }
  for (const float x : {-12.0F, 12.0F}) {
    add_lamp_post(mesh, {x, 7.0F, 0.0F}, 6.5F, 1.5708F, {court.metal, 1.0F});
    add_lamp_post(mesh, {x, -6.0F, 0.0F}, 6.5F, -1.5708F, {court.metal, 1.0F});
    add_box(mesh, {{x * 0.4F, -4.4F, 0.5F}, {1.8F, 0.5F, 0.12F}}, {court.crate, 0.0F});
    add_box(mesh, {{x * 0.4F, -4.4F, 0.2F}, {0.12F, 0.4F, 0.6F}}, {court.metal, 0.0F});
  }
}

void add_trees(Scene& scene, const FlightLane& lane, const Court& court, std::uint64_t seed) {
  Plot plot{scene.fixed, lane, RandomNumbers(stirred(seed, 37))};
  for (const auto& [x, y] : {std::pair{-5.0F, -1.5F},
                             std::pair{5.5F, 1.5F},
                             std::pair{1.0F, 2.5F},
                             std::pair{-26.0F, 8.0F},
                             std::pair{26.0F, -16.0F},
                             std::pair{-27.0F, -4.0F},
                             std::pair{24.0F, 21.0F},
                             std::pair{-3.0F, 21.5F},
                             std::pair{38.0F, 12.0F},
                             std::pair{39.0F, -9.0F}}) {
    const TreeShape tree{.foot_m = {x, y, 0.0F},
                         .height_m = plot.random.uniform(5.5F, 8.0F),
                         .trunk_radius_m = 0.15F,
                         .crown_from_m = 2.0F,
                         .crown_radius_m = plot.random.uniform(1.6F, 2.2F),
                         .leaves = 900};
    add_broadleaf(plot, tree, court.tree);
  }
  for (int i = 0; i < 14; ++i) {
    const float x = -6.5F + static_cast<float>(i);
    add_bush(plot, {x, i % 2 == 0 ? 3.4F : -3.4F, 0.1F}, 0.45F, court.tree);
  }
}

/// Takes a route's corners from the ground plan to the scene.
std::vector<Vector3d> on_ground(const std::vector<Vector2d>& plan_m) {
  std::vector<Vector3d> points;
  points.reserve(plan_m.size());
  for (const Vector2d& point : plan_m) {
    points.emplace_back(point.x(), point.y(), 0.0);
  }
  return points;
}

/// A ring round the green, `out_m` further out than the innermost.
std::vector<Vector2d> ring(double out_m) {
  const double x = 10.5 + out_m;
  const double y = 6.8 + out_m;
  return {{-x, -y + 2.0},
          {-x + 2.0, -y},
          {x - 2.0, -y},
          {x, -y + 2.0},
          {x, y - 2.0},
          {x - 2.0, y},
          {-x + 2.0, y},
          {-x, y - 2.0}};
}

void add_cars(Scene& scene,
              const std::vector<CarCover>& covers,
              double difficulty,
              RandomNumbers& random) {
  const int count = graded_count(difficulty, 1, 6);
  const double speed_mps = static_cast<double>(graded(difficulty, 1.5F, 6.0F));
  for (int i = 0; i < count; ++i) {
    const int row = i / 2;  // two side by side
    Route route{.points_m = on_ground(ring(i % 2 == 0 ? 0.0 : 3.2)),
                .speed_mps = speed_mps * (i % 2 == 0 ? 1.0 : 0.8),
                .start_m = 9.0 + 23.0 * row,
                .closed = true};
    if (i % 2 == 1) {  // the outer lane goes the other way
      route.points_m.assign(route.points_m.rbegin(), route.points_m.rend());
    }
    const auto& cover = covers[static_cast<std::size_t>(random.below(6))];
    scene.movers.push_back(
        {"Car", static_cast<int>(scene.movers.size()), car_mesh(cover), kCarSizeM, route});
  }
}

void add_people(Scene& scene, double difficulty, RandomNumbers& random) {
  const auto covers = add_person_covers(scene, random.bits());
  const std::vector<std::vector<Vector2d>> ways{
      {{-26.0, 20.6}, {-8.0, 20.8}, {4.0, 20.4}, {24.0, 20.7}},
      {{-24.0, -21.0}, {-6.0, -20.6}, {10.0, -21.2}, {25.0, -20.8}},
      {{24.0, 5.0}, {22.5, 0.0}, {24.5, -6.0}},
      {{-28.0, -1.0}, {-22.0, 3.0}, {-23.0, 10.0}, {-18.0, 18.0}},
      {{-7.5, -4.6}, {7.4, -4.6}, {7.4, 4.6}, {-7.5, 4.6}},
      {{20.0, 22.0}, {8.0, 21.6}, {-12.0, 21.9}},
      {{-22.0, -14.0}, {0.0, -14.3}, {20.0, -13.9}}};
  const int count = graded_count(difficulty, 2, 14);
  for (int i = 0; i < count; ++i) {
    const std::size_t way = static_cast<std::size_t>(i) % ways.size();
    const double speed = static_cast<double>(graded(difficulty, 0.7F, 1.9F));
    Route route{.points_m = on_ground(ways[way]),
                .speed_mps = speed * static_cast<double>(random.uniform(0.8F, 1.2F)),
                .start_m = static_cast<double>(random.uniform(0.0F, 30.0F)),
                .closed = way == 4};
    for (Vector3d& point : route.points_m) {
      point.z() = std::abs(point.y()) > 20.0 ? 0.12 : 0.0;  // on the pavement
      point.z() = way == 4 ? 0.08 : point.z();
    }
    const auto& cover = covers[static_cast<std::size_t>(i) % covers.size()];
    scene.movers.push_back({"Pedestrian",
                            static_cast<int>(scene.movers.size()),
                            person_mesh(cover),
                            kPersonSizeM,
                            route});
  }
}

}  // namespace

Scene make_yard(double difficulty, std::uint64_t seed) {
  Scene scene;
  scene.name = "yard";
  RandomNumbers random(stirred(seed, 41));
  const FlightLane lane = lane_of();
  const Court court = add_materials(scene, seed);
  add_grounds(scene.fixed, court);
  add_buildings(scene.fixed, court);
  add_goods(scene.fixed, court);
  add_trees(scene, lane, court, seed);
  const auto covers = add_car_covers(scene, random.bits());
  for (int i = 0; i < 15; i += random.chance(0.3F) ? 2 : 1) {
    const auto& cover = covers[static_cast<std::size_t>(random.below(6))];
    park_car(scene.fixed, cover, {-20.6F + 2.75F * static_cast<float>(i), -17.3F, 0.0F}, 1.5708F);
  }
  add_cars(scene, covers, difficulty, random);
  add_people(scene, difficulty, random);
  scene.lighting.sun_direction = sun_at(-115.0F, 44.0F);
  finish_scene(scene, lane, seed);
  return scene;
}

}  // namespace skyhalo

#include "skyhalo/sim/scenes/wires.hpp"

#include <array>
#include <cmath>
#include <utility>

#include "skyhalo/sim/noise.hpp"
#include "skyhalo/sim/random_numbers.hpp"
#include "skyhalo/sim/scenes/plants.hpp"
#include "skyhalo/sim/scenes/scene_parts.hpp"
#include "skyhalo/sim/scenes/site_parts.hpp"
#include "skyhalo/sim/shapes.hpp"

namespace skyhalo {
namespace {

using Eigen::Vector3f;

constexpr float kTurnRad = 6.2831853F;

FlightLane lane_of() {
  return {closed_curve(44,
                       [](double angle) -> Eigen::Vector3d {
                         return {25.0 * std::cos(angle),
                                 11.0 * std::sin(angle) + 2.0 * std::sin(3.0 * angle),
                                 3.0 + 0.4 * std::sin(2.0 * angle)};
                       }),
          true};
}

/// The materials of the fields.
struct Field {
  std::uint16_t meadow = 0;
  std::uint16_t soil = 0;
  std::uint16_t road = 0;
  std::uint16_t wood = 0;
  std::uint16_t wire = 0;
  std::uint16_t steel = 0;
  std::uint16_t cloth = 0;
  HouseCover house;
  PlantCover tree;
  float radius_m = 0.01F;  ///< of the wires
};

Field add_materials(Scene& scene, double difficulty, std::uint64_t seed) {
  Field field;
  field.meadow = add_surface(scene, {"meadow", Pattern::kGrass, 0.0F, {1.0F, 1.1F, 1.25F}}, seed);
  field.soil = add_surface(scene, {"soil", Pattern::kSoil}, seed);
  field.road = add_surface(scene, {"road", Pattern::kGravel}, seed);
  field.wood = add_surface(scene, {"pole", Pattern::kBark, 0.0F, {1.3F, 1.3F, 1.35F}}, seed);
  field.wire = add_plain(scene, "wire", {0.10F, 0.10F, 0.11F});
  field.steel = add_surface(scene, {"steel", Pattern::kMetal, 0.0F, {0.6F, 0.6F, 0.6F}}, seed);
  field.cloth = add_surface(scene, {"washing", Pattern::kCloth}, seed);
  const auto wall = add_surface(scene, {"plaster", Pattern::kFacade}, seed);
  const auto roof = add_surface(scene, {"roof", Pattern::kTiles, 0.0F, {0.45F, 0.5F, 0.9F}}, seed);
  field.house = {wall, 11.0F, roof, field.road};
  field.tree.bark = add_tinted(scene, field.wood, {1.0F, 1.0F, 1.0F});
  field.tree.leaf =
      add_surface(scene, {"leaves", Pattern::kLeaf, 0.0F, {0.9F, 1.1F, 1.1F}, 0.4F}, seed);
  field.radius_m = graded(difficulty, 0.03F, 0.004F);
  return field;
}

void add_fields(TriangleMesh& mesh, const Field& field, std::uint64_t seed) {
  const auto far_hills = [&](float x, float y) {
    const float far_m = std::max(0.0F, std::hypot(x, y) - 60.0F);
    return far_m * (0.10F + 0.06F * hill_noise(x / 30.0F, y / 30.0F, seed));
  };
  add_ground(mesh, {{-180.0F, -180.0F}, {180.0F, 180.0F}, 60, 60}, far_hills, {field.meadow, 5.0F});
  add_box(mesh, {{0.0F, 0.0F, 0.0F}, {84.0F, 4.0F, 0.08F}}, {field.road, 2.5F});
  add_box(mesh, {{0.0F, 27.0F, 0.0F}, {70.0F, 14.0F, 0.12F}}, {field.soil, 3.0F});
}

/// A pole with a cross-bar and insulators.
void add_pole(TriangleMesh& mesh, const Vector3f& foot_m, float height_m, const Field& field) {
  const Vector3f top = foot_m + Vector3f(0.0F, 0.0F, height_m);
  add_tube(mesh, {foot_m - Vector3f(0.0F, 0.0F, 0.3F), top, 0.14F, 0.10F, 8}, {field.wood, 1.2F});
  add_box(mesh, {top - Vector3f(0.0F, 0.0F, 0.5F), {0.12F, 2.2F, 0.14F}}, {field.wood, 1.2F});
  for (const float y : {-1.0F, -0.35F, 0.35F, 1.0F}) {
    add_tube(mesh,
             {top + Vector3f(0.0F, y, -0.43F), top + Vector3f(0.0F, y, -0.2F), 0.05F, 0.03F, 6},
             {field.steel, 0.0F});
  }
}

/// The line along the track: poles with four cables and guy ropes at its ends.
void add_power_line(TriangleMesh& mesh, float y, float height_m, const Field& field) {
  constexpr float kSpanM = 17.0F;
  for (int i = 0; i < 6; ++i) {
    const float x = -38.0F + kSpanM * static_cast<float>(i);
    add_pole(mesh, {x, y, 0.0F}, height_m, field);
    for (const float aside : {-1.0F, -0.35F, 0.35F, 1.0F}) {
      const Vector3f from(x, y + aside, height_m - 0.2F);
      if (i < 5) {
        add_cable(mesh,
                  {from, from + Vector3f(kSpanM, 0.0F, 0.0F), 0.7F, field.radius_m, 12},
                  field.wire);
      }
    }
  }
  for (const float side : {-1.0F, 1.0F}) {
    const Vector3f top(4.5F + side * 42.5F, y, height_m - 0.8F);
    add_cable(mesh, {top, {4.5F + side * 48.0F, y, 0.0F}, 0.05F, field.radius_m, 4}, field.wire);
  }
}

/// A guyed mast of three legs with bracing.
void add_mast(TriangleMesh& mesh, const Vector3f& foot_m, float height_m, const Field& field) {
  constexpr float kSectionM = 0.9F;
  const auto leg = [&](int k, float up_m) -> Vector3f {
    const float angle = kTurnRad * static_cast<float>(k) / 3.0F;
    return foot_m + Vector3f(0.35F * std::cos(angle), 0.35F * std::sin(angle), up_m);
  };
  for (const float up : spaced(0.0F, height_m - kSectionM + 0.01F, kSectionM)) {
    for (int k = 0; k < 3; ++k) {
      add_tube(mesh, {leg(k, up), leg(k, up + kSectionM), 0.03F, 0.03F, 6}, {field.steel, 1.0F});
      add_tube(
          mesh, {leg(k, up), leg(k + 1, up + kSectionM), 0.014F, 0.014F, 4}, {field.steel, 1.0F});
      add_tube(mesh, {leg(k, up), leg(k + 1, up), 0.014F, 0.014F, 4}, {field.steel, 1.0F});
    }
  }
  for (int k = 0; k < 3; ++k) {
    const float angle = kTurnRad * (static_cast<float>(k) + 0.5F) / 3.0F;
    const Vector3f anchor = foot_m + 4.6F * Vector3f(std::cos(angle), std::sin(angle), 0.0F);
    for (const float share : {0.55F, 0.95F}) {
      add_cable(mesh, {leg(k, share * height_m), anchor, 0.05F, field.radius_m, 5}, field.wire);
    }
  }
}

/// Posts with three wires, as round a pasture.
void add_pasture_fence(TriangleMesh& mesh,
                       const std::pair<Vector3f, Vector3f>& ends_m,
                       const Field& field) {
  const Vector3f way = ends_m.second - ends_m.first;
  const int spans = static_cast<int>(way.norm() / 4.0F);
  for (int i = 0; i <= spans; ++i) {
    const Vector3f foot = ends_m.first + static_cast<float>(i) / static_cast<float>(spans) * way;
    add_tube(
        mesh,
        {foot - Vector3f(0.0F, 0.0F, 0.2F), foot + Vector3f(0.0F, 0.0F, 1.4F), 0.06F, 0.05F, 6},
        {field.wood, 1.0F});
    for (const float up_m : {0.5F, 0.9F, 1.3F}) {
      const Vector3f from = foot + Vector3f(0.0F, 0.0F, up_m);
      if (i < spans) {
        add_cable(mesh,
                  {from, from + way / static_cast<float>(spans), 0.03F, 0.6F * field.radius_m, 2},
                  field.wire);
      }
    }
  }
}

/// Two posts with a line between them from which washing hangs.
void add_washing_line(TriangleMesh& mesh,
                      const Vector3f& from_m,
                      const Field& field,
                      RandomNumbers& random) {
  constexpr float kHeightM = 2.6F;
  const Vector3f to_m = from_m + Vector3f(8.0F, 0.0F, 0.0F);
  for (const Vector3f& foot : {from_m, to_m}) {
    add_tube(
        mesh, {foot, foot + Vector3f(0.0F, 0.0F, kHeightM), 0.06F, 0.05F, 6}, {field.wood, 1.0F});
  }
  const Vector3f up(0.0F, 0.0F, kHeightM - 0.05F);
  add_cable(mesh, {from_m + up, to_m + up, 0.1F, field.radius_m, 8}, field.wire);
  float s = 1.0F;
  while (s < 7.0F) {
    const float height_m = random.uniform(0.6F, 1.2F);
    add_box(mesh,
            {from_m + up + Vector3f(s, 0.0F, -0.12F - 0.5F * height_m), {0.75F, 0.03F, height_m}},
            {field.cloth, 0.8F});
    s += random.uniform(0.9F, 1.5F);
  }
}

void add_surroundings(Scene& scene,
                      const FlightLane& lane,
                      const Field& field,
                      std::uint64_t seed) {
  Plot plot{scene.fixed, lane, RandomNumbers(stirred(seed, 23))};
  RandomNumbers& random = plot.random;
  for (int i = 0; i < 30; ++i) {
    const float angle = kTurnRad * (static_cast<float>(i) + random.uniform()) / 30.0F;
    const float far_m = random.uniform(38.0F, 56.0F);
    TreeShape tree{.foot_m = {far_m * std::cos(angle), far_m * std::sin(angle), 0.0F},
                   .height_m = random.uniform(5.0F, 10.0F),
                   .crown_from_m = 1.8F,
                   .crown_radius_m = random.uniform(1.8F, 2.6F),
                   .leaves = 520};
    if (std::abs(tree.foot_m.y()) > 9.0F) {
      add_broadleaf(plot, tree, field.tree);
    }
  }
  for (int i = 0; i < 500; ++i) {
    const float x = random.uniform(-44.0F, 44.0F);
    const TuftShape tuft{.foot_m = {x, random.uniform(-26.0F, 20.0F), 0.0F},
                         .height_m = random.uniform(0.2F, 0.6F),
                         .blades = 7};
    if (std::abs(tuft.foot_m.y()) > 2.3F) {
      add_tuft(plot, tuft, field.tree.leaf);
    }
  }
  add_gabled_house(scene.fixed, {{-12.0F, -29.0F, 2.6F}, {11.0F, 8.0F, 5.6F}}, field.house);
  add_gabled_house(scene.fixed, {{16.0F, -32.0F, 2.6F}, {13.0F, 9.0F, 5.8F}, 0.4F}, field.house);
}

}  // namespace

Scene make_wires(double difficulty, std::uint64_t seed) {
  Scene scene;
  scene.name = "wires";
  RandomNumbers random(stirred(seed, 29));
  const FlightLane lane = lane_of();
  const Field field = add_materials(scene, difficulty, seed);
  TriangleMesh& mesh = scene.fixed;
  add_fields(mesh, field, seed);
  add_power_line(mesh, 3.2F, 7.4F, field);
  add_power_line(mesh, -20.0F, 6.6F, field);
  add_power_line(mesh, 18.0F, 8.5F, field);
  for (const float x : {-4.0F, 13.0F}) {  // lines that cross the route
    add_cable(
        mesh, {{x, 3.2F, 6.8F}, {x + 2.0F, -20.0F, 6.0F}, 0.5F, field.radius_m, 14}, field.wire);
    add_cable(
        mesh, {{x, 3.2F, 6.9F}, {x - 1.0F, 18.0F, 7.9F}, 0.4F, field.radius_m, 14}, field.wire);
  }
  add_mast(mesh, {3.0F, -4.0F, 0.0F}, 11.0F, field);
  add_mast(mesh, {34.0F, 8.0F, 0.0F}, 14.0F, field);
  add_mast(mesh, {-34.5F, -8.0F, 0.0F}, 14.0F, field);
  add_pasture_fence(mesh, {{-32.0F, -15.5F, 0.0F}, {32.0F, -15.5F, 0.0F}}, field);
  add_pasture_fence(mesh, {{-32.0F, 15.5F, 0.0F}, {32.0F, 15.5F, 0.0F}}, field);
  add_washing_line(mesh, {-17.0F, -18.2F, 0.0F}, field, random);
  add_washing_line(mesh, {6.0F, 5.0F, 0.0F}, field, random);
  add_surroundings(scene, lane, field, seed);
  scene.lighting.sun_direction = sun_at(-70.0F, 42.0F);
  finish_scene(scene, lane, seed);
  return scene;
}

}  // namespace skyhalo

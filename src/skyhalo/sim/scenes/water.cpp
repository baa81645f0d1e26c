#include "skyhalo/sim/scenes/water.hpp"

#include <algorithm>
#include <cmath>

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
constexpr float kHalfLakeX = 36.0F;
constexpr float kHalfLakeY = 26.0F;

/// How far from the middle: 1 is on the shore.
float out(float x, float y, std::uint64_t seed) {
  return std::hypot(x / kHalfLakeX, y / kHalfLakeY) +
         0.10F * hill_noise(x / 11.0F, y / 11.0F, seed);
}

/// The lake's bed, a shore that rises gently and hills behind it; the water is at 0.
float ground_m(float x, float y, std::uint64_t seed) {
  const float beyond = out(x, y, seed) - 1.0F;
  const float hills = std::max(0.0F, beyond - 0.7F);
  return std::clamp(5.0F * beyond, -1.5F, 0.9F) + 5.0F * hills +
         0.12F * hill_noise(x / 3.0F, y / 3.0F, seed + 1);
}

FlightLane lane_of() {
  return {closed_curve(44,
                       [](double angle) -> Eigen::Vector3d {
                         return {8.0 + 25.0 * std::cos(angle),
                                 -8.0 + 15.0 * std::sin(angle),
                                 3.2 + 0.8 * std::sin(2.0 * angle)};
                       }),
          true};
}

/// The materials of the lake.
struct Lake {
  std::uint16_t water = 0;
  std::uint16_t grass = 0;
  std::uint16_t sand = 0;
  std::uint16_t plank = 0;
  std::uint16_t post = 0;
  std::uint16_t hull = 0;
  std::uint16_t buoy = 0;
  std::uint16_t stone = 0;
  std::uint16_t reed = 0;
  HouseCover hut;
  PlantCover tree;
};

Lake add_materials(Scene& scene, double difficulty, std::uint64_t seed) {
  Lake lake;
  lake.water = add_faded(scene,
                         {"water", Pattern::kRipples, 0.0F, {0.42F, 0.40F, 0.34F}},
                         static_cast<float>(difficulty),
                         seed);
  scene.materials[lake.water].mirror = graded(difficulty, 0.35F, 0.85F);
  scene.materials[lake.water].laser_reflectivity = 0.0F;
  lake.grass = add_surface(scene, {"grass", Pattern::kGrass}, seed);
  lake.plank = add_surface(scene, {"plank", Pattern::kPlanks, 0.0F, {1.25F, 1.2F, 1.15F}}, seed);
  lake.post = add_surface(scene, {"post", Pattern::kBark}, seed);
  lake.hull = add_surface(scene, {"hull", Pattern::kMetal, 0.0F, {0.9F, 0.5F, 0.25F}}, seed);
  lake.buoy = add_tinted(scene, lake.hull, {0.1F, 0.25F, 1.0F});
  lake.stone = add_surface(scene, {"stone", Pattern::kStone}, seed);
  lake.tree.bark = lake.post;
  lake.tree.leaf =
      add_surface(scene, {"leaves", Pattern::kLeaf, 0.0F, {0.9F, 1.1F, 1.1F}, 0.4F}, seed);
  lake.reed = add_tinted(scene, lake.tree.leaf, {0.9F, 1.2F, 1.4F});
  const auto roof = add_surface(scene, {"roof", Pattern::kTiles, 0.0F, {0.45F, 0.5F, 0.8F}}, seed);
  lake.hut = {lake.plank, 1.6F, roof, lake.stone};
  return lake;
}

void add_lake(TriangleMesh& mesh, const Lake& lake, double difficulty, std::uint64_t seed) {
  add_ground(mesh,
             {{-130.0F, -130.0F}, {130.0F, 130.0F}, 130, 130},
             [&](float x, float y) { return ground_m(x, y, seed); },
             {lake.grass, 4.0F});
  const float wave_m = graded(difficulty, 0.05F, 0.0F);
  add_ground(mesh,
             {{-48.0F, -36.0F}, {48.0F, 36.0F}, 120, 90},
             [&](float x, float y) {
               return wave_m * (hill_noise(x / 4.0F, y / 2.6F, seed + 2) +
                                0.3F * hill_noise(x / 2.0F, y / 1.7F, seed + 3));
             },
             {lake.water, 4.0F});
}

/// A jetty from the shore into the lake, with posts, a rail and a ladder.
void add_jetty(TriangleMesh& mesh, const Lake& lake) {
  constexpr float kDeckM = 0.75F;
  for (const float y : spaced(-30.0F, -13.0F, 0.30F)) {
    add_box(mesh, {{8.0F, y, kDeckM}, {2.2F, 0.26F, 0.06F}}, {lake.plank, 1.6F});
  }
  for (const float y : spaced(-30.0F, -12.9F, 2.8F)) {
    for (const float x : {6.95F, 9.05F}) {
      add_tube(mesh, {{x, y, -1.6F}, {x, y, 1.75F}, 0.11F, 0.10F, 8}, {lake.post, 1.2F});
    }
  }
  for (const float up_m : {1.25F, 1.65F}) {
    add_tube(
        mesh, {{6.95F, -30.0F, up_m}, {6.95F, -13.2F, up_m}, 0.045F, 0.045F, 6}, {lake.post, 1.2F});
  }
  add_box(mesh, {{8.0F, -13.4F, kDeckM + 0.35F}, {0.9F, 0.6F, 0.6F}}, {lake.plank, 0.0F});
}

/// A rowing boat whose keel lies along `yaw_rad`.
void add_boat(TriangleMesh& mesh, const Vector3f& place_m, float yaw_rad, const Lake& lake) {
  add_prism(mesh,
            {.outline_m = {{-1.6F, -0.15F}, {1.5F, -0.15F}, {2.3F, 0.50F}, {-1.9F, 0.42F}},
             .middle_m = place_m,
             .width_m = 1.3F,
             .yaw_rad = yaw_rad},
            {lake.hull, 1.4F});
  const Vector3f way(std::cos(yaw_rad), std::sin(yaw_rad), 0.0F);
  for (const float along_m : {-1.0F, 0.0F, 1.0F}) {
    add_box(mesh,
            {place_m + along_m * way + Vector3f(0.0F, 0.0F, 0.52F), {0.3F, 1.36F, 0.1F}, yaw_rad},
            {lake.plank, 1.0F});
  }
}

/// A sailing boat at anchor: hull, cabin, mast and stays.
void add_sailing_boat(TriangleMesh& mesh,
                      const Vector3f& place_m,
                      float yaw_rad,
                      const Lake& lake) {
  add_prism(mesh,
            {.outline_m = {{-2.6F, -0.3F}, {2.4F, -0.3F}, {3.6F, 0.85F}, {-3.0F, 0.7F}},
             .middle_m = place_m,
             .width_m = 2.1F,
             .yaw_rad = yaw_rad},
            {lake.hull, 1.6F});
  add_box(mesh,
          {place_m + Vector3f(0.0F, 0.0F, 1.0F), {2.4F, 1.4F, 0.7F}, yaw_rad},
          {lake.plank, 1.5F});
  const Vector3f top = place_m + Vector3f(0.0F, 0.0F, 8.0F);
  const Vector3f way(std::cos(yaw_rad), std::sin(yaw_rad), 0.0F);
  add_tube(mesh, {place_m + Vector3f(0.0F, 0.0F, 0.6F), top, 0.08F, 0.05F, 8}, {lake.post, 1.0F});
  add_tube(mesh,
           {place_m + Vector3f(0.0F, 0.0F, 1.9F),
            place_m - 2.8F * way + Vector3f(0.0F, 0.0F, 1.9F),
            0.16F,
            0.12F,
            8},
           {lake.tree.leaf, 1.0F});
  for (const float along_m : {-2.9F, 3.4F}) {
    add_cable(mesh,
              {top, place_m + along_m * way + Vector3f(0.0F, 0.0F, 0.8F), 0.03F, 0.012F, 4},
              lake.post);
  }
}

void add_buoys(TriangleMesh& mesh, const Lake& lake) {
  for (int i = 0; i < 7; ++i) {
    const float angle = 0.4F + 0.37F * static_cast<float>(i);
    const Vector3f place(8.0F + 19.0F * std::cos(angle), -8.0F + 10.5F * std::sin(angle), 0.0F);
    add_ellipsoid(mesh, {place, {0.4F, 0.4F, 0.35F}, 12, 6}, {lake.buoy, 1.0F});
    add_tube(mesh, {place, place + Vector3f(0.0F, 0.0F, 1.5F), 0.05F, 0.03F, 6}, {lake.buoy, 1.0F});
    add_box(
        mesh, {place + Vector3f(0.0F, 0.0F, 1.5F), {0.4F, 0.06F, 0.3F}, angle}, {lake.hull, 0.5F});
  }
}

/// A place on or near the shore: `beyond` is how far outside, as a share of the lake's size.
Vector3f on_shore(float angle, float beyond, std::uint64_t seed) {
  float low = 0.3F;
  float high = 3.0F;
  const auto at = [&](float reach) -> Vector3f {
    return {reach * kHalfLakeX * std::cos(angle), reach * kHalfLakeY * std::sin(angle), 0.0F};
  };
  for (int i = 0; i < 24; ++i) {
    const float middle = 0.5F * (low + high);
    const Vector3f point = at(middle);
    (out(point.x(), point.y(), seed) < 1.0F + beyond ? low : high) = middle;
  }
  Vector3f place = at(low);
  place.z() = ground_m(place.x(), place.y(), seed);
  return place;
}

void add_plants(Plot& plot, const Lake& lake, std::uint64_t seed) {
  RandomNumbers& random = plot.random;
  for (int i = 0; i < 900; ++i) {  // reeds, in thickets
    const float angle = random.uniform(0.0F, kTurnRad);
    if (hill_noise(4.0F * angle, 0.5F, seed + 5) < 0.0F) {
      continue;
    }
    const Vector3f foot = on_shore(angle, random.uniform(-0.12F, 0.01F), seed);
    add_tuft(plot, {foot, random.uniform(1.3F, 2.4F), 0.05F, 0.25F, 7}, lake.reed);
  }
  for (int i = 0; i < 42; ++i) {
    const float angle = kTurnRad * (static_cast<float>(i) + random.uniform()) / 42.0F;
    TreeShape tree{.foot_m = on_shore(angle, random.uniform(0.2F, 0.75F), seed),
                   .height_m = random.uniform(6.0F, 12.0F),
                   .crown_from_m = 1.8F,
                   .crown_radius_m = random.uniform(2.0F, 3.2F),
                   .leaves = 430};
    if (plot.lane.distance_on_map_m(tree.foot_m) > 2.5F) {
      add_broadleaf(plot, tree, lake.tree);
    }
  }
  for (int i = 0; i < 45; ++i) {
    const float size_m = random.uniform(0.25F, 0.8F);
    const Vector3f place =
        on_shore(random.uniform(0.0F, kTurnRad), random.uniform(-0.08F, 0.06F), seed);
    add_rock(plot.mesh,
             {place, {1.3F * size_m, size_m, 0.8F * size_m}, 10, 6},
             0.18F,
             random.bits(),
             {lake.stone, 1.5F});
  }
}

}  // namespace

Scene make_water(double difficulty, std::uint64_t seed) {
  Scene scene;
  scene.name = "water";
  const FlightLane lane = lane_of();
  const Lake lake = add_materials(scene, difficulty, seed);
  TriangleMesh& mesh = scene.fixed;
  add_lake(mesh, lake, difficulty, seed);
  add_jetty(mesh, lake);
  add_boat(mesh, {11.0F, -17.0F, 0.05F}, 1.3F, lake);
  add_boat(mesh, {-5.0F, 3.0F, 0.05F}, 0.5F, lake);
  add_sailing_boat(mesh, {18.0F, -3.0F, 0.0F}, 2.2F, lake);
  add_sailing_boat(mesh, {-13.0F, 10.0F, 0.0F}, -0.4F, lake);
  add_buoys(mesh, lake);
  for (const float x : {-6.0F, 24.0F}) {
    const float z = ground_m(x, -36.0F, seed);
    add_gabled_house(mesh, {{x, -36.0F, z + 1.3F}, {7.0F, 5.0F, 3.4F}, 0.1F}, lake.hut);
  }
  Plot plot{mesh, lane, RandomNumbers(stirred(seed, 31))};
  add_plants(plot, lake, seed);
  scene.lighting.sun_direction = sun_at(120.0F, 46.0F);
  finish_scene(scene, lane, seed);
  return scene;
}

}  // namespace skyhalo

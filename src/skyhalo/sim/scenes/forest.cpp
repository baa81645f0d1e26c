#include "skyhalo/sim/scenes/forest.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "skyhalo/sim/noise.hpp"
#include "skyhalo/sim/random_numbers.hpp"
#include "skyhalo/sim/scenes/plants.hpp"
#include "skyhalo/sim/scenes/scene_parts.hpp"
#include "skyhalo/sim/shapes.hpp"

namespace skyhalo {
namespace {

using Eigen::Vector2f;
using Eigen::Vector3f;

constexpr float kHalfWoodM = 52.0F;
constexpr float kTurnRad = 2.0F * std::numbers::pi_v<float>;

/// Gentle hills that rise towards the far edge, where the woods go on as a picture.
float ground_m(float x, float y, std::uint64_t seed) {
  const float far_m = std::max(0.0F, std::hypot(x, y) - 68.0F);
  return 1.3F * hill_noise(x / 26.0F, y / 26.0F, seed) +
         0.45F * hill_noise(x / 9.0F, y / 9.0F, seed + 1) +
         0.07F * hill_noise(x / 1.7F, y / 1.7F, seed + 2) + 0.35F * far_m;
}

FlightLane lane_of(std::uint64_t seed) {
  return {closed_curve(44,
                       [&](double angle) -> Eigen::Vector3d {
                         const double radius_m =
                             17.5 + 3.2 * std::sin(3.0 * angle + 0.5) + 1.6 * std::sin(5.0 * angle);
                         const double x = radius_m * std::cos(angle);
                         const double y = radius_m * std::sin(angle);
                         const float z =
                             ground_m(static_cast<float>(x), static_cast<float>(y), seed);
                         return {x, y, z + 3.0 + 0.35 * std::sin(4.0 * angle)};
                       }),
          true};
}

/// The materials of the wood.
struct Woods {
  std::uint16_t floor = 0;
  std::uint16_t hills = 0;
  std::uint16_t stone = 0;
  std::uint16_t grass = 0;
  PlantCover oak;
  PlantCover birch;
  PlantCover fir;
};

Woods add_materials(Scene& scene, std::uint64_t seed) {
  Woods woods;
  woods.floor = add_surface(
      scene, {"forest floor", Pattern::kForestFloor, 5.0F, Vector3f::Constant(1.15F)}, seed);
  woods.oak.bark = add_surface(scene, {"bark", Pattern::kBark, 0.0F, {1.2F, 1.2F, 1.25F}}, seed);
  woods.oak.leaf =
      add_surface(scene, {"leaves", Pattern::kLeaf, 0.0F, {0.9F, 1.15F, 1.1F}, 0.45F}, seed);
  woods.stone = add_surface(scene, {"stone", Pattern::kStone, 1.5F}, seed);
  woods.birch.bark = add_tinted(scene, woods.oak.bark, {2.3F, 2.2F, 2.1F});
  woods.birch.leaf = add_tinted(scene, woods.oak.leaf, {0.9F, 1.35F, 1.5F});
  woods.fir.bark = add_tinted(scene, woods.oak.bark, {0.9F, 1.0F, 1.25F});
  woods.fir.leaf = add_tinted(scene, woods.oak.leaf, {1.0F, 0.85F, 0.65F});
  woods.grass = add_tinted(scene, woods.oak.leaf, {0.9F, 1.4F, 1.3F});
  woods.hills =
      add_surface(scene, {"far woods", Pattern::kLeaf, 14.0F, {0.9F, 0.85F, 0.75F}}, seed);
  return woods;
}

void add_terrain(TriangleMesh& mesh, const Woods& woods, std::uint64_t seed) {
  const auto height = [&](float x, float y) { return ground_m(x, y, seed); };
  constexpr float kNear = 72.0F;
  constexpr float kFar = 160.0F;
  add_ground(mesh, {{-kNear, -kNear}, {kNear, kNear}, 120, 120}, height, {woods.floor, 5.0F});
  add_ground(mesh, {{-kFar, kNear}, {kFar, kFar}, 64, 16}, height, {woods.hills, 14.0F});
  add_ground(mesh, {{-kFar, -kFar}, {kFar, -kNear}, 64, 16}, height, {woods.hills, 14.0F});
  add_ground(mesh, {{-kFar, -kNear}, {-kNear, kNear}, 16, 28}, height, {woods.hills, 14.0F});
  add_ground(mesh, {{kNear, -kNear}, {kFar, kNear}, 16, 28}, height, {woods.hills, 14.0F});
}

/// Random places in the wood that keep their distances.
class Places {
 public:
  Places(const FlightLane& lane, std::uint64_t seed) : lane_(lane), seed_(seed), random_(~seed) {}

  /// What the ground's shape goes by.
  [[nodiscard]] std::uint64_t seed() const noexcept { return seed_; }

  /// A point on the ground at least `spacing_m` from those before and `lane_m` from the lane, as
  /// seen from above; the last try when there is no room.
  Vector3f next(float spacing_m, float lane_m) {
    Vector3f place = Vector3f::Zero();
    for (int attempt = 0; attempt < 60; ++attempt) {
      place.x() = random_.uniform(-kHalfWoodM, kHalfWoodM);
      place.y() = random_.uniform(-kHalfWoodM, kHalfWoodM);
      if (lane_.distance_on_map_m(place) > lane_m && has_room(place, spacing_m)) {
        break;
      }
      place.x() = kHalfWoodM + random_.uniform(1.0F, 12.0F);  // at the wood's edge, if need be
    }
    taken_.emplace_back(place.head<2>());
    place.z() = ground_m(place.x(), place.y(), seed_);
    return place;
  }

 private:
  [[nodiscard]] bool has_room(const Vector3f& place, float spacing_m) const {
    return std::none_of(taken_.begin(), taken_.end(), [&](const Vector2f& other) {
      return (other - place.head<2>()).squaredNorm() < spacing_m * spacing_m;
    });
  }

  const FlightLane& lane_;
  std::uint64_t seed_;
  RandomNumbers random_;
  std::vector<Vector2f> taken_;
};

void add_trees(Plot& plot, Places& places, const Woods& woods, double difficulty) {
  const int count = graded_count(difficulty, 150, 390);
  for (int i = 0; i < count; ++i) {
    RandomNumbers& random = plot.random;
    TreeShape tree;
    tree.foot_m = places.next(2.2F, kLaneM + 0.75F);
    tree.height_m = random.uniform(7.5F, 15.0F);
    tree.trunk_radius_m = 0.018F * tree.height_m * random.uniform(0.7F, 1.3F);
    tree.branch_radius_m = graded(difficulty, 0.06F, 0.02F) * random.uniform(0.8F, 1.3F);
    tree.crown_from_m = random.uniform(2.6F, 0.45F * tree.height_m);
    tree.crown_radius_m = 0.24F * tree.height_m * random.uniform(0.8F, 1.25F);
    tree.leaves = graded_count(difficulty, 330, 880);
    const float kind = random.uniform();
    if (kind < 0.42F) {
      add_broadleaf(plot, tree, woods.oak);
    } else if (kind < 0.62F) {
      tree.trunk_radius_m *= 0.7F;
      add_broadleaf(plot, tree, woods.birch);
    } else if (kind < 0.94F) {
      tree.crown_from_m = random.uniform(0.8F, 3.5F);
      tree.crown_radius_m *= 0.75F;
      tree.leaves += tree.leaves / 2;
      add_conifer(plot, tree, woods.fir);
    } else {
      tree.height_m *= 0.7F;
      add_snag(plot, tree, woods.oak);
    }
  }
}

void add_undergrowth(Plot& plot, Places& places, const Woods& woods, double difficulty) {
  RandomNumbers& random = plot.random;
  const int bushes = graded_count(difficulty, 40, 230);
  for (int i = 0; i < bushes; ++i) {
    const PlantCover& cover = random.chance(0.5F) ? woods.oak : woods.birch;
    add_bush(plot, places.next(0.8F, 0.0F), random.uniform(0.4F, 1.1F), cover);
  }
  const int tufts = graded_count(difficulty, 1200, 3200);
  for (int i = 0; i < tufts; ++i) {
    const float x = random.uniform(-kHalfWoodM, kHalfWoodM);
    const float y = random.uniform(-kHalfWoodM, kHalfWoodM);
    TuftShape tuft{.height_m = random.uniform(0.25F, 0.75F),
                   .width_m = random.uniform(0.04F, 0.12F),
                   .lean = random.uniform(0.4F, 1.2F),
                   .blades = 8};
    tuft.foot_m = {x, y, ground_m(x, y, places.seed())};
    add_tuft(plot, tuft, random.chance(0.5F) ? woods.grass : woods.oak.leaf);
  }
}

void add_rocks_and_logs(Plot& plot, Places& places, const Woods& woods) {
  RandomNumbers& random = plot.random;
  for (int i = 0; i < 70; ++i) {
    const Vector3f place = places.next(1.0F, 0.5F);
    const float size_m = random.uniform(0.2F, 0.75F);
    const float wide_m = size_m * random.uniform(0.8F, 1.6F);
    add_rock(plot.mesh,
             {.middle_m = place + Vector3f(0.0F, 0.0F, 0.15F * size_m),
              .radius_m = {wide_m, size_m, 0.8F * size_m},
              .sides = 10,
              .rings = 6},
             0.16F,
             random.bits(),
             {woods.stone, 1.5F});
  }
  for (int i = 0; i < 36; ++i) {
    const Vector3f place = places.next(1.5F, 0.5F);
    const float radius_m = random.uniform(0.12F, 0.32F);
    const float angle = random.uniform(0.0F, kTurnRad);
    const bool stump = random.chance(0.4F);
    const Vector3f along =
        stump ? Vector3f(0.05F, 0.0F, random.uniform(0.3F, 0.8F))
              : random.uniform(2.0F, 6.0F) * Vector3f(std::cos(angle), std::sin(angle), 0.03F);
    const Vector3f sunk(0.0F, 0.0F, stump ? -0.2F : 0.6F * radius_m);
    add_tube(plot.mesh,
             {place + sunk, place + sunk + along, radius_m, 0.8F * radius_m, 10},
             {woods.oak.bark, 1.2F});
  }
}

}  // namespace

Scene make_forest(double difficulty, std::uint64_t seed) {
  Scene scene;
  scene.name = "forest";
  const Woods woods = add_materials(scene, seed);
  const FlightLane lane = lane_of(seed);
  add_terrain(scene.fixed, woods, seed);
  Plot plot{scene.fixed, lane, RandomNumbers(stirred(seed, 7))};
  Places places(lane, seed);
  add_trees(plot, places, woods, difficulty);
  add_rocks_and_logs(plot, places, woods);
  add_undergrowth(plot, places, woods, difficulty);
  scene.lighting.sun_direction = sun_at(35.0F, graded(difficulty, 62.0F, 24.0F));
  scene.lighting.ambient_bgr = {0.62F, 0.62F, 0.60F};
  scene.lighting.sun_bgr = {1.10F, 1.25F, 1.35F};
  finish_scene(scene, lane, seed);
  return scene;
}

}  // namespace skyhalo

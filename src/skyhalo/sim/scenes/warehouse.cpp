#include "skyhalo/sim/scenes/warehouse.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "skyhalo/sim/random_numbers.hpp"
#include "skyhalo/sim/scenes/scene_parts.hpp"
#include "skyhalo/sim/scenes/site_parts.hpp"
#include "skyhalo/sim/shapes.hpp"

namespace skyhalo {
namespace {

using Eigen::Vector3f;

constexpr float kHalfLengthM = 29.0F;
constexpr float kHalfWidthM = 19.0F;
constexpr float kHeightM = 8.0F;
constexpr float kShelfDepthM = 1.2F;
constexpr float kBayM = 2.7F;
constexpr int kBays = 13;
constexpr int kLevels = 4;
constexpr float kLevelM = 1.55F;
constexpr float kHalfShelfM = 0.5F * kBayM * kBays;

/// From the middle of one aisle to that of the next.
float pitch_m(double difficulty) {
  return graded(difficulty, 5.6F, 3.8F) + kShelfDepthM;
}

/// Round through two aisles whose middles are one pitch on either side of y = 0.
FlightLane lane_of(double difficulty) {
  const double half_y = static_cast<double>(pitch_m(difficulty));
  constexpr double kHalfX = 23.5;
  constexpr double kRadius = 3.0;
  return {closed_curve(48,
                       [&](double angle) -> Eigen::Vector3d {
                         // A rectangle with round corners, by its distance along it.
                         const double straight_x = 2.0 * (kHalfX - kRadius);
                         const double straight_y = 2.0 * (half_y - kRadius);
                         const double bow = 0.5 * std::numbers::pi * kRadius;
                         double s = angle / (2.0 * std::numbers::pi) * 2.0 *
                                    (straight_x + straight_y + 2.0 * bow);
                         const double z = 2.9 + 0.9 * std::sin(3.0 * angle);
                         double turn = 0.0;
                         Eigen::Vector2d at(-0.5 * straight_x, -half_y);
                         for (int side = 0; side < 4; ++side, turn += 0.5 * std::numbers::pi) {
                           const double straight = side % 2 == 0 ? straight_x : straight_y;
                           const Eigen::Vector2d along(std::cos(turn), std::sin(turn));
                           const Eigen::Vector2d left(-along.y(), along.x());
                           if (s <= straight) {
                             at += s * along;
                             break;
                           }
                           s -= straight;
                           at += straight * along;
                           const double a = std::min(s / kRadius, 0.5 * std::numbers::pi);
                           at += kRadius * (std::sin(a) * along + (1.0 - std::cos(a)) * left);
                           if (s <= bow) {
                             break;
                           }
                           s -= bow;
                         }
                         return {at.x(), at.y(), z};
                       }),
          true};
}

/// The materials of the hall.
struct Hall {
  std::array<std::uint16_t, 5> boxes{};
  std::uint16_t floor = 0;
  std::uint16_t wall = 0;
  std::uint16_t roof = 0;
  std::uint16_t upright = 0;
  std::uint16_t beam = 0;
  std::uint16_t board = 0;
  std::uint16_t crate = 0;
  std::uint16_t lamp = 0;
  std::uint16_t line = 0;
};

Hall add_materials(Scene& scene, std::uint64_t seed) {
  Hall hall;
  for (std::uint16_t& box : hall.boxes) {
    box = add_surface(scene, {"cardboard box", Pattern::kCardboard}, seed);
  }
  scene.materials[hall.boxes[1]].colour_bgr = {1.2F, 1.1F, 1.0F};
  scene.materials[hall.boxes[3]].colour_bgr = {1.5F, 1.3F, 1.15F};
  hall.floor = add_surface(scene, {"floor", Pattern::kConcrete}, seed);
  hall.wall =
      add_surface(scene, {"sheet wall", Pattern::kCorrugated, 0.0F, {0.95F, 0.85F, 0.75F}}, seed);
  hall.roof = add_surface(scene, {"roof", Pattern::kPlanks, 0.0F, {0.9F, 0.85F, 0.8F}}, seed);
  hall.upright =
      add_surface(scene, {"upright", Pattern::kMetal, 0.0F, {0.75F, 0.35F, 0.12F}}, seed);
  hall.beam = add_tinted(scene, hall.upright, {0.10F, 0.45F, 1.0F});
  hall.board = add_surface(scene, {"board", Pattern::kPlanks}, seed);
  hall.crate = add_surface(scene, {"crate", Pattern::kCrate}, seed);
  hall.lamp = add_plain(scene, "lamp", {2.0F, 2.0F, 2.0F});
  hall.line = add_plain(scene, "floor line", {0.1F, 0.65F, 0.8F});
  return hall;
}

void add_hall(Scene& scene, const Hall& hall) {
  TriangleMesh& mesh = scene.fixed;
  add_ground(mesh,
             {{-kHalfLengthM, -kHalfWidthM}, {kHalfLengthM, kHalfWidthM}, 12, 8},
             flat_ground,
             {hall.floor, 3.0F});
  const float middle_m = 0.5F * kHeightM;
  for (const float side : {-1.0F, 1.0F}) {
    add_box(mesh,
            {{0.0F, side * (kHalfWidthM + 0.15F), middle_m},
             {2.0F * kHalfLengthM + 0.7F, 0.3F, kHeightM + 0.6F}},
            {hall.wall, 3.0F});
    add_box(mesh,
            {{side * (kHalfLengthM + 0.15F), 0.0F, middle_m},
             {0.3F, 2.0F * kHalfWidthM, kHeightM + 0.6F}},
            {hall.wall, 3.0F});
  }
  add_box(mesh,
          {{0.0F, 0.0F, kHeightM + 0.2F}, {2.0F * kHalfLengthM, 2.0F * kHalfWidthM, 0.3F}},
          {hall.roof, 3.0F});
  for (const float x : spaced(-24.0F, 24.1F, 8.0F)) {
    add_box(mesh,
            {{x, 0.0F, kHeightM - 0.2F}, {0.3F, 2.0F * kHalfWidthM - 0.02F, 0.5F}},
            {hall.upright, 2.0F});
    for (const float y : spaced(-14.0F, 14.1F, 7.0F)) {
      add_box(mesh, {{x + 4.0F, y, kHeightM - 0.35F}, {1.4F, 0.3F, 0.1F}}, {hall.lamp, 0.0F});
      scene.lighting.lamps.push_back({{x + 4.0F, y, kHeightM - 0.5F}, {3.0F, 3.2F, 3.3F}});
    }
  }
}

/// The boxes of one shelf's bay; `foot_m` is the middle of the board they stand on.
void fill_bay(TriangleMesh& mesh,
              const Vector3f& foot_m,
              const Hall& hall,
              float alike,
              RandomNumbers& random) {
  if (random.chance(alike)) {  // all the same
    for (const float x : {-0.84F, 0.0F, 0.84F}) {
      add_box(mesh, {foot_m + Vector3f(x, 0.0F, 0.5F), {0.78F, 1.0F, 1.0F}}, {hall.boxes[0], 0.0F});
    }
    return;
  }
  if (random.chance(0.12F)) {
    return;
  }
  float x = -1.25F;
  while (x < 0.9F) {
    const float width_m = std::min(random.uniform(0.35F, 0.95F), 1.25F - x);
    const float height_m = random.uniform(0.35F, 1.15F);
    const float depth_m = random.uniform(0.6F, 1.05F);
    const std::uint16_t box =
        random.chance(0.1F) ? hall.crate : hall.boxes[static_cast<std::size_t>(random.below(5))];
    add_box(mesh,
            {foot_m + Vector3f(x + 0.5F * width_m, random.uniform(-0.06F, 0.06F), 0.5F * height_m),
             {width_m - 0.06F, depth_m, height_m},
             random.uniform(-0.05F, 0.05F)},
            {box, 0.0F});
    x += width_m + 0.04F;
  }
}

void add_shelf(TriangleMesh& mesh, float y, const Hall& hall, float alike, RandomNumbers& random) {
  const float top_m = kLevels * kLevelM - 0.2F;
  for (int bay = 0; bay <= kBays; ++bay) {
    const float x = -kHalfShelfM + kBayM * static_cast<float>(bay);
    for (const float side : {-0.55F, 0.55F}) {
      add_box(mesh, {{x, y + side, 0.5F * top_m}, {0.09F, 0.1F, top_m}}, {hall.upright, 1.0F});
    }
  }
  for (int level = 0; level < kLevels; ++level) {
    const float z = 0.12F + kLevelM * static_cast<float>(level);
    for (const float side : {-0.57F, 0.57F}) {
      add_box(mesh,
              {{0.0F, y + side, z}, {2.0F * kHalfShelfM - 0.1F, 0.05F, 0.12F}},
              {hall.beam, 1.0F});
    }
    add_box(mesh,
            {{0.0F, y, z + 0.03F}, {2.0F * kHalfShelfM - 0.12F, 1.06F, 0.05F}},
            {hall.board, 1.5F});
    for (int bay = 0; bay < kBays; ++bay) {
      const float x = -kHalfShelfM + kBayM * (static_cast<float>(bay) + 0.5F);
      fill_bay(mesh, {x, y, z + 0.056F}, hall, alike, random);
    }
  }
}

/// Pallets with crates along the walls.
void add_pallets(TriangleMesh& mesh, const Hall& hall, RandomNumbers& random) {
  for (const float y : spaced(-16.0F, 17.0F, 2.3F)) {
    for (const float side : {-1.0F, 1.0F}) {
      const Vector3f place(side * (kHalfLengthM - 0.9F), y, 0.0F);
      add_box(mesh, {place + Vector3f(0.0F, 0.0F, 0.08F), {1.2F, 1.2F, 0.14F}}, {hall.board, 1.0F});
      const float height_m = random.uniform(0.6F, 1.6F);
      add_box(mesh,
              {place + Vector3f(0.0F, 0.0F, 0.152F + 0.5F * height_m),
               {1.05F, 1.05F, height_m},
               random.uniform(-0.1F, 0.1F)},
              {random.chance(0.6F) ? hall.crate : hall.boxes[2], 0.0F});
    }
  }
}

}  // namespace

Scene make_warehouse(double difficulty, std::uint64_t seed) {
  Scene scene;
  scene.name = "warehouse";
  RandomNumbers random(stirred(seed, 13));
  const Hall hall = add_materials(scene, seed);
  add_hall(scene, hall);
  const float pitch = pitch_m(difficulty);
  for (const float y : spaced(0.5F * pitch, kHalfWidthM - 1.0F, pitch)) {
    add_shelf(scene.fixed, y, hall, graded(difficulty, 0.05F, 0.95F), random);
    add_shelf(scene.fixed, -y, hall, graded(difficulty, 0.05F, 0.95F), random);
    add_box(scene.fixed,
            {{0.0F, y + 0.8F, 0.0F}, {2.0F * kHalfShelfM, 0.1F, 0.02F}},
            {hall.line, 0.0F});
    add_box(scene.fixed,
            {{0.0F, -y - 0.8F, 0.0F}, {2.0F * kHalfShelfM, 0.1F, 0.02F}},
            {hall.line, 0.0F});
  }
  add_pallets(scene.fixed, hall, random);
  scene.lighting.sun_bgr = Vector3f::Zero();
  scene.lighting.ambient_bgr = {0.50F, 0.52F, 0.53F};
  finish_scene(scene, lane_of(difficulty), seed);
  return scene;
}

}  // namespace skyhalo

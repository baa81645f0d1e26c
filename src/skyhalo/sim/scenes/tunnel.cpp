#include "skyhalo/sim/scenes/tunnel.hpp"

#include <array>
#include <cmath>
#include <utility>

#include "skyhalo/sim/random_numbers.hpp"
#include "skyhalo/sim/scenes/scene_parts.hpp"
#include "skyhalo/sim/shapes.hpp"

namespace skyhalo {
namespace {

using Eigen::Vector3f;

constexpr float kHalfWidthM = 2.6F;
constexpr float kWallM = 3.6F;    // where the vault begins
constexpr float kVaultM = 1.3F;   // how much higher its middle is
constexpr float kFromM = -56.0F;  // along x
constexpr float kLengthM = 112.0F;
constexpr int kRings = 112;
constexpr int kVaultPieces = 8;

/// The middle of the floor at a share of the length, and the direction there.
Vector3f middle_m(float share) {
  const float x = kFromM + kLengthM * share;
  return {x, 6.0F * std::sin(x / 14.0F), 0.0F};
}

Vector3f along(float share) {
  return (middle_m(share + 0.002F) - middle_m(share - 0.002F)).normalized();
}

/// A point in the cross-section: aside (to the left) and up (m).
Vector3f in_section(float share, float aside_m, float up_m) {
  const Vector3f way = along(share);
  return middle_m(share) + Vector3f(-way.y() * aside_m, way.x() * aside_m, up_m);
}

float yaw_rad(float share) {
  const Vector3f way = along(share);
  return std::atan2(way.y(), way.x());
}

/// The materials of the tunnel.
struct Lining {
  std::uint16_t wall = 0;
  std::uint16_t floor = 0;
  std::uint16_t dado = 0;
  std::uint16_t pipe = 0;
  std::uint16_t door = 0;
  std::uint16_t lamp = 0;
  std::uint16_t crate = 0;
};

Lining add_materials(Scene& scene, double difficulty, std::uint64_t seed) {
  const auto fade = static_cast<float>(difficulty);
  Lining lining;
  lining.wall =
      add_faded(scene, {"wall", Pattern::kConcrete, 0.0F, {1.2F, 1.25F, 1.25F}}, fade, seed);
  lining.floor = add_faded(scene, {"floor", Pattern::kAsphalt}, 0.7F * fade, seed);
  lining.dado =
      add_faded(scene, {"dado", Pattern::kPlaster, 0.0F, {0.75F, 0.65F, 0.45F}}, fade, seed);
  lining.pipe = add_surface(scene, {"pipe", Pattern::kMetal, 0.0F, {0.35F, 0.45F, 0.6F}}, seed);
  lining.door = add_surface(scene, {"door", Pattern::kMetal, 0.0F, {0.25F, 0.5F, 0.35F}}, seed);
  lining.lamp = add_plain(scene, "lamp", {2.0F, 2.1F, 2.1F});
  lining.crate = add_surface(scene, {"crate", Pattern::kCrate}, seed);
  return lining;
}

/// A strip of quads along the tunnel between two lines of its cross-section.
void add_strip(TriangleMesh& mesh,
               std::pair<float, float> from,
               std::pair<float, float> to,
               const Cover& cover) {
  const float step = 1.0F / kRings;
  const float width_m = std::hypot(to.first - from.first, to.second - from.second);
  TriangleMesh strip;
  for (int i = 0; i <= kRings; ++i) {
    const float share = static_cast<float>(i) * step;
    const float u = share * kLengthM / cover.texture_edge_m;
    strip.vertices_m.push_back(in_section(share, from.first, from.second));
    strip.vertices_m.push_back(in_section(share, to.first, to.second));
    strip.uvs.emplace_back(u, width_m / cover.texture_edge_m);
    strip.uvs.emplace_back(u, 0.0F);
  }
  for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(kRings); ++i) {
    strip.triangles.push_back({2 * i, 2 * i + 2, 2 * i + 3});
    strip.triangles.push_back({2 * i, 2 * i + 3, 2 * i + 1});
    strip.materials.insert(strip.materials.end(), 2, cover.material);
  }
  append(mesh, strip, Pose::Identity());
}

void add_lining(TriangleMesh& mesh, const Lining& lining) {
  add_strip(mesh, {kHalfWidthM, 0.0F}, {-kHalfWidthM, 0.0F}, {lining.floor, 5.0F});
  for (const float side : {-1.0F, 1.0F}) {
    const float edge_m = side * kHalfWidthM;
    add_strip(mesh, {edge_m, 0.0F}, {edge_m, 1.1F}, {lining.dado, 3.0F});
    add_strip(mesh, {edge_m, 1.1F}, {edge_m, kWallM}, {lining.wall, 4.0F});
  }
  for (int i = 0; i < kVaultPieces; ++i) {
    const auto rim = [](int k) -> std::pair<float, float> {
      const float angle = 3.14159265F * static_cast<float>(k) / kVaultPieces;
      return {kHalfWidthM * std::cos(angle), kWallM + kVaultM * std::sin(angle)};
    };
    add_strip(mesh, rim(i), rim(i + 1), {lining.wall, 4.0F});
  }
  for (const float share : {0.0F, 1.0F}) {  // the ends
    add_box(
        mesh,
        {in_section(share, 0.0F, 2.5F), {0.3F, 2.0F * kHalfWidthM + 0.6F, 6.0F}, yaw_rad(share)},
        {lining.wall, 4.0F});
    const float door_share = share < 0.5F ? 0.003F : 0.997F;
    add_box(mesh,
            {in_section(door_share, 0.0F, 1.4F), {0.2F, 2.4F, 2.8F}, yaw_rad(share)},
            {lining.door, 0.0F});
  }
}

void add_lamps(Scene& scene, const Lining& lining) {
  for (int i = 0; i < 16; ++i) {
    const float share = (static_cast<float>(i) + 0.5F) / 16.0F;
    const Vector3f place = in_section(share, 0.0F, kWallM + kVaultM - 0.12F);
    add_box(scene.fixed, {place, {1.4F, 0.25F, 0.12F}, yaw_rad(share)}, {lining.lamp, 0.0F});
    scene.lighting.lamps.push_back({place - Vector3f(0.0F, 0.0F, 0.4F), {3.0F, 3.3F, 3.5F}});
  }
}

void add_pipes(TriangleMesh& mesh, const Lining& lining, double difficulty) {
  const int pipes = 3 - graded_count(difficulty, 0, 2);
  for (int pipe = 0; pipe < pipes; ++pipe) {
    const float up_m = kWallM - 0.25F - 0.3F * static_cast<float>(pipe);
    for (int i = 0; i < kRings; i += 2) {
      const float from = static_cast<float>(i) / kRings;
      const float to = static_cast<float>(i + 2) / kRings;
      const float radius_m = i % 16 == 0 ? 0.10F : 0.08F;
      add_tube(mesh,
               {in_section(from, kHalfWidthM - 0.14F, up_m),
                in_section(to, kHalfWidthM - 0.14F, up_m),
                radius_m,
                radius_m,
                8},
               {lining.pipe, 1.0F});
    }
  }
}

/// Doors with a lamp box beside them, and crates on the floor along the walls.
void add_fittings(TriangleMesh& mesh,
                  const Lining& lining,
                  double difficulty,
                  RandomNumbers& random) {
  const int doors = graded_count(difficulty, 12, 4);
  for (int i = 0; i < doors; ++i) {
    const float share =
        (static_cast<float>(i) + random.uniform(0.2F, 0.8F)) / static_cast<float>(doors);
    const float side = random.chance(0.5F) ? 1.0F : -1.0F;
    add_box(mesh,
            {in_section(share, side * kHalfWidthM, 1.1F), {1.1F, 0.24F, 2.2F}, yaw_rad(share)},
            {lining.door, 0.0F});
    add_box(
        mesh,
        {in_section(share + 0.012F, side * kHalfWidthM, 1.6F), {0.4F, 0.3F, 0.6F}, yaw_rad(share)},
        {lining.pipe, 0.0F});
  }
  const int crates = graded_count(difficulty, 26, 12);
  for (int i = 0; i < crates; ++i) {
    const float share =
        0.03F + 0.94F * (static_cast<float>(i) + random.uniform()) / static_cast<float>(crates);
    const float side = random.chance(0.5F) ? 1.0F : -1.0F;
    const float size_m = random.uniform(0.45F, 0.9F);
    add_box(mesh,
            {in_section(share, side * (kHalfWidthM - 0.65F), 0.5F * size_m + 0.003F),
             {size_m, size_m, size_m},
             yaw_rad(share) + random.uniform(-0.3F, 0.3F)},
            {lining.crate, 0.0F});
  }
}

}  // namespace

Scene make_tunnel(double difficulty, std::uint64_t seed) {
  Scene scene;
  scene.name = "tunnel";
  RandomNumbers random(stirred(seed, 17));
  const Lining lining = add_materials(scene, difficulty, seed);
  add_lining(scene.fixed, lining);
  add_lamps(scene, lining);
  add_pipes(scene.fixed, lining, difficulty);
  add_fittings(scene.fixed, lining, difficulty, random);
  scene.lighting.sun_bgr = Vector3f::Zero();
  scene.lighting.ambient_bgr = {0.30F, 0.32F, 0.33F};
  const FlightLane lane(open_curve(49,
                                   [](double share) -> Eigen::Vector3d {
                                     const auto place = static_cast<float>(0.04 + 0.92 * share);
                                     const Eigen::Vector3d middle = middle_m(place).cast<double>();
                                     return middle + Eigen::Vector3d(0.0, 0.0, 2.5);
                                   }),
                        false);
  finish_scene(scene, lane, seed);
  return scene;
}

}  // namespace skyhalo

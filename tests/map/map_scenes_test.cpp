#include "support/map_scenes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace skyhalo {
namespace {

using testing::MapScene;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

Ray ray_to(const Eigen::Vector3d& from_m, const Eigen::Vector3d& to_m) {
  return {from_m, (to_m - from_m).normalized()};
}

Eigen::AlignedBox3d cube_about(const Eigen::Vector3d& middle_m, double edge_m) {
  return {middle_m.array() - 0.5 * edge_m, middle_m.array() + 0.5 * edge_m};
}

/// A room of 8 x 8 x 4 m with a pillar of 1 m radius at (3, 0) and a box.
MapScene furnished_room() {
  MapScene scene;
  scene.room_m =
      Eigen::AlignedBox3d(Eigen::Vector3d(-4.0, -4.0, 0.0), Eigen::Vector3d(4.0, 4.0, 4.0));
  scene.pillars.push_back({{2.5, 0.0}, 1.0, 0.0, 2.0});
  scene.boxes_m.emplace_back(Eigen::Vector3d(-3.0, -3.0, 0.0), Eigen::Vector3d(-2.0, -2.0, 1.0));
  return scene;
}

TEST(MapScenesTest, RaysEndAtTheFirstSurface) {
  const MapScene scene = furnished_room();
  const Eigen::Vector3d from_m(0.0, 0.0, 1.0);
  EXPECT_NEAR(scene.range_m({from_m, {0.0, 1.0, 0.0}}), 4.0, 1e-12);
  EXPECT_NEAR(scene.range_m({from_m, {0.0, 0.0, 1.0}}), 3.0, 1e-12);
  EXPECT_NEAR(scene.range_m({from_m, {1.0, 0.0, 0.0}}), 1.5, 1e-12);             // the pillar
  EXPECT_NEAR(scene.range_m({{0.0, 0.0, 3.0}, {1.0, 0.0, 0.0}}), 4.0, 1e-12);    // above it
  EXPECT_NEAR(scene.range_m({{0.0, 0.6, 1.0}, {1.0, 0.0, 0.0}}), 1.7, 1e-12);    // 0.6 off: 0.8
  EXPECT_NEAR(scene.range_m({{2.5, 0.3, 3.5}, {0.0, 0.0, -1.0}}), 1.5, 1e-12);   // its top
  EXPECT_NEAR(scene.range_m({{-2.5, 0.0, 0.5}, {0.0, -1.0, 0.0}}), 2.0, 1e-12);  // the box
  EXPECT_NEAR(scene.range_m({{-2.5, 0.0, 1.5}, {0.0, -1.0, 0.0}}), 4.0, 1e-12);  // above it
}

TEST(MapScenesTest, OpenGroundHasNoEnd) {
  MapScene scene;
  scene.ground_m = -1.0;
  EXPECT_EQ(scene.range_m({{0.0, 0.0, 1.0}, {1.0, 0.0, 0.0}}), kInfinity);
  EXPECT_EQ(scene.range_m({{0.0, 0.0, 1.0}, {0.0, 0.0, 1.0}}), kInfinity);
  EXPECT_NEAR(scene.range_m({{0.0, 0.0, 1.0}, {0.6, 0.0, -0.8}}), 2.5, 1e-12);
  EXPECT_TRUE(scene.is_solid({5.0, 5.0, -1.1}));
  EXPECT_FALSE(scene.is_solid({5.0, 5.0, -0.9}));
  EXPECT_TRUE(scene.has_surface(cube_about({0.0, 0.0, -1.2}, 0.5)));
  EXPECT_FALSE(scene.has_surface(cube_about({0.0, 0.0, -1.3}, 0.5)));
}

TEST(MapScenesTest, KnowsWhatIsSolid) {
  const MapScene scene = furnished_room();
  EXPECT_FALSE(scene.is_solid({0.0, 0.0, 1.0}));
  EXPECT_TRUE(scene.is_solid({2.5, 0.9, 1.0}));
  EXPECT_FALSE(scene.is_solid({2.5, 0.9, 2.1}));
  EXPECT_TRUE(scene.is_solid({-2.5, -2.5, 0.5}));
  EXPECT_TRUE(scene.is_solid({0.0, 0.0, 4.1}));
}

TEST(MapScenesTest, KnowsWhichCubesHaveASurface) {
  const MapScene scene = furnished_room();
  EXPECT_FALSE(scene.has_surface(cube_about({0.0, 0.0, 1.0}, 0.5)));
  EXPECT_TRUE(scene.has_surface(cube_about({4.1, 3.0, 3.0}, 0.5)));    // a wall
  EXPECT_FALSE(scene.has_surface(cube_about({4.3, 3.0, 3.0}, 0.5)));   // behind it
  EXPECT_TRUE(scene.has_surface(cube_about({1.3, 0.0, 1.0}, 0.5)));    // the pillar's side
  EXPECT_FALSE(scene.has_surface(cube_about({2.5, 0.0, 1.0}, 0.5)));   // within it
  EXPECT_TRUE(scene.has_surface(cube_about({2.5, 0.0, 2.1}, 0.5)));    // its top
  EXPECT_FALSE(scene.has_surface(cube_about({1.5, 0.9, 1.0}, 0.4)));   // past the round side
  EXPECT_TRUE(scene.has_surface(cube_about({-2.0, -2.5, 0.5}, 0.1)));  // the box's side
}

/// Where a ray that comes from free space becomes solid, in steps of 1 mm.
double stepped_range_m(const MapScene& scene, const Ray& ray, double max_m) {
  for (double s_m = 0.0; s_m < max_m; s_m += 1e-3) {
    if (scene.is_solid(ray.origin_m + s_m * ray.direction)) {
      return s_m;
    }
  }
  return kInfinity;
}

TEST(MapScenesProperty, RangesAndSolidsAgree) {
  std::mt19937 rng(3);
  std::uniform_real_distribution<double> share(0.0, 1.0);
  std::normal_distribution<double> normal;
  for (const MapScene& scene : {furnished_room(), testing::room_scene(), testing::open_scene()}) {
    for (int i = 0; i < 60; ++i) {
      const Eigen::Vector3d from_m(
          7.0 * share(rng) - 3.5, 7.0 * share(rng) - 3.5, 0.2 + 3.0 * share(rng));
      if (scene.is_solid(from_m)) {
        continue;
      }
      const Ray ray{from_m, Eigen::Vector3d(normal(rng), normal(rng), normal(rng)).normalized()};
      const double exact_m = scene.range_m(ray);
      const double stepped_m = stepped_range_m(scene, ray, 30.0);
      if (std::isfinite(stepped_m)) {
        EXPECT_NEAR(exact_m, stepped_m, 0.05);  // a glancing ray may be solid for less than a step
        const Eigen::Vector3d end_m = ray.origin_m + exact_m * ray.direction;
        EXPECT_TRUE(scene.has_surface(cube_about(end_m, 1e-6)));
      } else {
        EXPECT_GE(exact_m, 29.9);
      }
    }
  }
}

TEST(MapScenesTest, TheScenesAreAsTheyAreSaidToBe) {
  const MapScene room = testing::room_scene();
  EXPECT_EQ(room.pillars.size(), 8U);
  EXPECT_TRUE(room.room_m->sizes().isApprox(Eigen::Vector3d(20.0, 20.0, 6.0)));
  EXPECT_EQ(testing::open_scene().pillars.size(), 16U);
  EXPECT_NEAR(room.range_m(ray_to({0.0, 0.0, 1.5}, {9.0, 0.0, 1.5})), 9.85, 1e-9);
}

}  // namespace
}  // namespace skyhalo

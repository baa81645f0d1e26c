#include "skyhalo/sim/path_check.hpp"

#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "reference/naive_ray_tracer.hpp"
#include "reference/naive_surface_distance.hpp"
#include "support/triangle_soups.hpp"

namespace skyhalo {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

/// Straight at one speed from a point to another (m).
Trajectory straight(const Vector3d& from_m, const Vector3d& to_m, double duration_s) {
  MotionSample begin;
  begin.T_map_body.translation() = from_m;
  begin.velocity_mps = (to_m - from_m) / duration_s;
  MotionSample end = begin;
  end.T_map_body.translation() = to_m;
  end.t_s = duration_s;
  return Trajectory({begin, end});
}

/// A wall without thickness at x = 0, from y = -3 to 3 and z = -3 to 3.
Scene thin_wall() {
  Scene scene;
  scene.name = "wall";
  scene.materials.resize(1);
  add_quad(scene.fixed,
           {Vector3f(0.0F, 3.0F, -3.0F),
            Vector3f(0.0F, -3.0F, -3.0F),
            Vector3f(0.0F, -3.0F, 3.0F),
            Vector3f(0.0F, 3.0F, 3.0F)},
           {});
  return scene;
}

TEST(PathCheckTest, AWayThroughAWallIsFound) {
  const Scene scene = thin_wall();
  const SceneTracer tracer(scene);
  // At 1 m/s from x = -5: nearer than 0.4 m from 4.6 s on, in the wall at 5 s, away at 5.4 s.
  const auto found =
      first_collision(tracer, straight({-5.0, 0.5, 0.2}, {5.0, 0.5, 0.2}, 10.0), 10.0, 0.4);
  ASSERT_TRUE(found);
  EXPECT_GE(found->t_s, 4.59);
  EXPECT_LE(found->t_s, 5.41);
  EXPECT_LT((found->position_m - Vector3d(found->t_s - 5.0, 0.5, 0.2)).norm(), 0.06);
  EXPECT_LE(found->distance_m, 0.03);
}

TEST(PathCheckTest, NoSpeedSkipsAWall) {
  const Scene scene = thin_wall();
  const SceneTracer tracer(scene);
  for (const double speed_mps : {3.0, 10.0, 30.0}) {
    const double duration_s = 200.0 / speed_mps;
    const auto found = first_collision(
        tracer, straight({-90.01, 1.0, 0.0}, {109.99, 1.0, 0.0}, duration_s), duration_s, 0.05);
    ASSERT_TRUE(found) << speed_mps;
    EXPECT_NEAR(found->position_m.x(), 0.0, 0.11) << speed_mps;
    EXPECT_LE(found->distance_m, 0.05) << speed_mps;
    EXPECT_NEAR(found->t_s * speed_mps, 90.01, 0.11);
  }
}

TEST(PathCheckTest, AWayThatKeepsAwayIsGood) {
  const Scene scene = thin_wall();
  const SceneTracer tracer(scene);
  // Past the wall's side at y = 3.
  EXPECT_FALSE(
      first_collision(tracer, straight({-5.0, 3.5, 0.0}, {5.0, 3.5, 0.0}, 10.0), 10.0, 0.4));
  EXPECT_FALSE(
      first_collision(tracer, straight({-0.5, -9.0, 0.0}, {-0.5, 9.0, 0.0}, 10.0), 10.0, 0.4));
}

TEST(PathCheckTest, ANearPassHasItsDistance) {
  const Scene scene = thin_wall();
  const SceneTracer tracer(scene);
  // 0.3 m beside the wall's side, nearest at 5 s.
  const auto found =
      first_collision(tracer, straight({-5.0, 3.3, 0.0}, {5.0, 3.3, 0.0}, 10.0), 10.0, 0.4);
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->distance_m, 0.3, 0.005);
  EXPECT_GE(found->t_s, 5.0 - 0.265 - 0.05);  // 0.265 = sqrt(0.4^2 - 0.3^2)
  EXPECT_LE(found->t_s, 5.0 + 0.265 + 0.05);
  EXPECT_FALSE(
      first_collision(tracer, straight({-5.0, 3.3, 0.0}, {5.0, 3.3, 0.0}, 10.0), 10.0, 0.29));
}

TEST(PathCheckTest, NoSpeedMissesANearPass) {
  // 0.1 m beside the wall's side: within 0.14 m of it for 0.196 m of the way, more than 5 cm.
  const Scene scene = thin_wall();
  const SceneTracer tracer(scene);
  for (const double speed_mps : {5.0, 10.0, 20.0, 30.0}) {
    for (int shift = 0; shift < 20; ++shift) {
      const Vector3d from_m(-30.0 + 0.017 * shift, 3.1, 0.0);
      const double duration_s = 60.0 / speed_mps;
      const auto found =
          first_collision(tracer,
                          straight(from_m, from_m + Vector3d(60.0, 0.0, 0.0), duration_s),
                          duration_s,
                          0.14);
      ASSERT_TRUE(found) << speed_mps << " m/s, shifted " << shift;
      EXPECT_LE(found->distance_m, 0.14);
    }
  }
}

TEST(PathCheckTest, WhatComesLaterIsNotAskedFor) {
  const Scene scene = thin_wall();
  const SceneTracer tracer(scene);
  const Trajectory flight = straight({-5.0, 0.0, 0.0}, {5.0, 0.0, 0.0}, 10.0);
  EXPECT_FALSE(first_collision(tracer, flight, 4.5, 0.4));
  EXPECT_TRUE(first_collision(tracer, flight, 4.7, 0.4));
}

TEST(PathCheckTest, OfTwoWallsTheFirstIsNamed) {
  Scene scene = thin_wall();
  append(scene.fixed, thin_wall().fixed, make_pose(Eigen::Matrix3d::Identity(), {3.0, 0.0, 0.0}));
  const SceneTracer tracer(scene);
  const auto found =
      first_collision(tracer, straight({-5.0, 0.0, 0.0}, {5.0, 0.0, 0.0}, 10.0), 10.0, 0.4);
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->t_s, 5.0, 0.41);
}

TEST(PathCheckTest, MoversAreNotAsked) {
  Scene scene = thin_wall();
  MovingObject mover;
  add_box(mover.mesh, {}, {});
  mover.route.points_m = {Vector3d(-3.0, 0.0, 0.0), Vector3d(-2.0, 0.0, 0.0)};
  mover.route.speed_mps = 0.0;
  scene.movers = {mover};
  const SceneTracer tracer(scene);
  EXPECT_FALSE(
      first_collision(tracer, straight({-5.0, 0.0, 0.0}, {-1.0, 0.0, 0.0}, 4.0), 4.0, 0.4));
}

TEST(PathCheckReference, RandomWaysComeAsNearAsMillimetreStepsFind) {
  std::mt19937 rng(61);
  int collisions = 0;
  for (std::uint32_t trial = 0; trial < 60; ++trial) {
    const Scene scene = testing::random_scene(trial, 20, 4.0, 1.0);
    const SceneTracer tracer(scene);
    const auto triangles = reference::naive_triangles(scene, {0.0, 0.0}, 0.0);
    const Vector3d from_m = testing::random_point_m(rng, 5.0);
    const Vector3d to_m = testing::random_point_m(rng, 5.0);
    const auto found = first_collision(tracer, straight(from_m, to_m, 10.0), 10.0, 0.3);
    double nearest_m = 1e9;
    double first_s = 1e9;
    for (double t_s = 0.0; t_s <= 10.0; t_s += 0.002) {
      const double distance_m =
          reference::naive_surface_distance_m(from_m + 0.1 * t_s * (to_m - from_m), triangles);
      nearest_m = std::min(nearest_m, distance_m);
      first_s = distance_m < 0.3 ? std::min(first_s, t_s) : first_s;
    }
    if (std::abs(nearest_m - 0.3) < 0.01) {
      continue;  // too close to tell
    }
    ASSERT_EQ(found.has_value(), nearest_m < 0.3) << trial << ": " << nearest_m;
    if (found) {
      ++collisions;
      EXPECT_GE(found->t_s, first_s - 0.1);
      EXPECT_LE(found->distance_m, 0.3);
      EXPECT_GE(found->distance_m, nearest_m - 0.03);
      EXPECT_NEAR(found->distance_m,
                  reference::naive_surface_distance_m(found->position_m, triangles),
                  0.03);
    }
  }
  EXPECT_GT(collisions, 10);
}

}  // namespace
}  // namespace skyhalo

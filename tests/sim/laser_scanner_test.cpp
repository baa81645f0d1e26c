#include "skyhalo/sim/laser_scanner.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "reference/naive_ray_tracer.hpp"
#include "reference/naive_surface_distance.hpp"
#include "skyhalo/geometry/angle.hpp"
#include "support/triangle_soups.hpp"

namespace skyhalo {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;
using reference::naive_surface_distance_m;
using reference::naive_trace;
using reference::naive_triangles;
using reference::NaiveTriangle;

/// A room of 24 m by 18 m by 7 m whose middle is at (1, -2, 0.5).
Scene big_room() {
  return testing::room_scene({1.0F, -2.0F, 0.5F}, {24.0F, 18.0F, 7.0F});
}

Pose slanted_pose() {
  const Eigen::AngleAxisd turn(0.7, Vector3d(0.1, -0.2, 1.0).normalized());
  return make_pose(turn.toRotationMatrix(), {2.0, 1.0, -0.4});
}

PoseAtTime standing(const Pose& T) {
  return [T](double) { return T; };
}

LaserScannerConfig few_azimuths(double sigma_m) {
  LaserScannerConfig config;
  config.azimuths = 180;
  config.range_sigma_m = sigma_m;
  return config;
}

/// One turn at time 0 of a scanner that stands in a scene.
std::vector<LaserReturn> scan_of(const Scene& scene,
                                 const Pose& T_scene_laser,
                                 const LaserScannerConfig& config,
                                 std::uint64_t key = 0) {
  const SceneTracer tracer(scene);
  const SceneMoment moment(tracer, {0.0, 0.0});
  return scan(moment, standing(T_scene_laser), 0.0, key, config);
}

double elevation_rad(const Vector3d& point_m) {
  return std::atan2(point_m.z(), std::hypot(point_m.x(), point_m.y()));
}

TEST(LaserScannerTest, ItsAnglesAreThoseOfTheHdl64e) {
  const std::vector<double> angles_rad = laser_elevations_rad();
  ASSERT_EQ(angles_rad.size(), 64U);
  EXPECT_NEAR(deg_from_rad(angles_rad[0]), 2.0, 0.005);
  EXPECT_NEAR(deg_from_rad(angles_rad[31]), -8.0 - 1.0 / 3.0, 0.005);
  EXPECT_NEAR(deg_from_rad(angles_rad[32]), -8.83, 0.005);
  EXPECT_NEAR(deg_from_rad(angles_rad[63]), -24.33, 0.005);
  for (std::size_t i = 1; i < 64; ++i) {
    if (i != 32) {
      EXPECT_NEAR(deg_from_rad(angles_rad[i - 1] - angles_rad[i]), i < 32 ? 1.0 / 3.0 : 0.5, 1e-6);
    }
  }
}

TEST(LaserScannerReference, EachReturnOfARoomLiesOnItsWalls) {
  const Scene scene = big_room();
  const LaserScannerConfig config = few_azimuths(0.0);
  const std::vector<LaserReturn> returns = scan_of(scene, slanted_pose(), config);
  ASSERT_EQ(returns.size(), 64U * 180U);
  const std::vector<NaiveTriangle> walls = naive_triangles(scene, {0.0, 0.0}, 0.0);
  const std::vector<double> elevations_rad = laser_elevations_rad();
  std::vector<int> counts(64, 0);
  for (const LaserReturn& one : returns) {
    const Vector3d point_m = one.point_m.cast<double>();
    EXPECT_LT(naive_surface_distance_m(slanted_pose() * point_m, walls), 1e-3);
    EXPECT_EQ(one.object, SceneHit::kFixed);
    EXPECT_LT(reference::naive_triangle_distance_m(slanted_pose() * point_m,
                                                   walls[one.triangle].corners_m),
              1e-3);
    for (std::size_t i = 0; i < 64; ++i) {
      counts[i] += std::abs(elevation_rad(point_m) - elevations_rad[i]) < 1e-4 ? 1 : 0;
    }
  }
  EXPECT_EQ(counts, std::vector<int>(64, 180));
}

TEST(LaserScannerTest, AzimuthsGoAllRoundAtEqualSteps) {
  std::vector<double> azimuths_rad;
  const Scene scene = big_room();
  for (const LaserReturn& one : scan_of(scene, Pose::Identity(), few_azimuths(0.0))) {
    if (std::abs(elevation_rad(one.point_m.cast<double>()) - rad_from_deg(2.0)) < 1e-3) {
      azimuths_rad.push_back(std::atan2(one.point_m.y(), one.point_m.x()));
    }
  }
  std::sort(azimuths_rad.begin(), azimuths_rad.end());
  ASSERT_EQ(azimuths_rad.size(), 180U);
  for (std::size_t i = 1; i < azimuths_rad.size(); ++i) {
    EXPECT_NEAR(azimuths_rad[i] - azimuths_rad[i - 1], rad_from_deg(2.0), 1e-4);
  }
}

TEST(LaserScannerProperty, RangesSpreadAsTold) {
  const Scene scene = big_room();
  const std::vector<LaserReturn> returns = scan_of(scene, slanted_pose(), few_azimuths(0.02));
  const std::vector<NaiveTriangle> walls = naive_triangles(scene, {0.0, 0.0}, 0.0);
  double sum_m = 0.0;
  double squares_m2 = 0.0;
  for (const LaserReturn& one : returns) {
    const Vector3d point_m = one.point_m.cast<double>();
    const double wall_m =
        naive_trace(
            walls, slanted_pose().translation(), slanted_pose().linear() * point_m.normalized())
            .range_m;
    sum_m += point_m.norm() - wall_m;
    squares_m2 += (point_m.norm() - wall_m) * (point_m.norm() - wall_m);
  }
  const auto count = static_cast<double>(returns.size());
  EXPECT_NEAR(std::sqrt(squares_m2 / count), 0.02, 0.001);
  EXPECT_NEAR(sum_m / count, 0.0, 0.0008);
}

TEST(LaserScannerTest, ASurfaceWithoutReflectivityReturnsNothing) {
  Scene scene = big_room();
  scene.materials[0].laser_reflectivity = 0.0F;
  EXPECT_TRUE(scan_of(scene, Pose::Identity(), few_azimuths(0.02)).empty());
}

/// A wall of 80 m by 80 m square to x, this far ahead of the origin.
Scene wall_ahead(float x_m, float reflectivity) {
  Scene scene;
  scene.name = "wall";
  scene.materials.resize(1);
  scene.materials[0].laser_reflectivity = reflectivity;
  add_quad(scene.fixed,
           {Vector3f(x_m, 40.0F, -40.0F),
            Vector3f(x_m, -40.0F, -40.0F),
            Vector3f(x_m, -40.0F, 40.0F),
            Vector3f(x_m, 40.0F, 40.0F)},
           {});
  return scene;
}

TEST(LaserScannerTest, NothingReturnsFromBeyondTheRangeOrTooNear) {
  const LaserScannerConfig config = few_azimuths(0.0);
  EXPECT_TRUE(scan_of(wall_ahead(125.0F, 0.8F), Pose::Identity(), config).empty());
  EXPECT_FALSE(scan_of(wall_ahead(100.0F, 0.8F), Pose::Identity(), config).empty());
  EXPECT_FALSE(scan_of(wall_ahead(20.0F, 0.2F), Pose::Identity(), config).empty());
  LaserScannerConfig weak = config;
  weak.max_range_m = 5.0;
  EXPECT_TRUE(scan_of(wall_ahead(6.0F, 0.8F), Pose::Identity(), weak).empty());
  for (const LaserReturn& one : scan_of(wall_ahead(0.5F, 0.8F), Pose::Identity(), config)) {
    EXPECT_GE(one.point_m.norm(), 0.9F - 1e-4F);
  }
  const std::vector<LaserReturn> near = scan_of(wall_ahead(0.95F, 0.8F), Pose::Identity(), config);
  EXPECT_FALSE(near.empty());
}

TEST(LaserScannerTest, DarkSurfacesReturnFromLessFar) {
  const auto count_at = [](float x_m, float reflectivity) {
    return scan_of(wall_ahead(x_m, reflectivity), Pose::Identity(), few_azimuths(0.0)).size();
  };
  EXPECT_EQ(count_at(110.0F, 0.1F), 0U);
  EXPECT_GT(count_at(110.0F, 0.8F), 0U);
  EXPECT_GE(count_at(60.0F, 0.8F), count_at(60.0F, 0.2F));
}

TEST(LaserScannerProperty, TheSameKeyMakesTheSameTurn) {
  const Scene scene = big_room();
  const LaserScannerConfig config = few_azimuths(0.02);
  const auto points_of = [&](std::uint64_t key) {
    std::vector<Vector3f> points_m;
    for (const LaserReturn& one : scan_of(scene, slanted_pose(), config, key)) {
      points_m.push_back(one.point_m);
    }
    return points_m;
  };
  EXPECT_EQ(points_of(5), points_of(5));
  EXPECT_NE(points_of(5), points_of(6));
}

/// The farthest (m) that a point lies from the walls when each is placed by the pose at the time
/// of its azimuth. A turn begins and ends behind; `sense` is 1 for a scanner that turns left.
double worst_m(const std::vector<LaserReturn>& returns,
               const std::vector<NaiveTriangle>& walls,
               const PoseAtTime& T_scene_laser,
               double turn_s,
               double sense) {
  double most_m = 0.0;
  for (const LaserReturn& one : returns) {
    const double azimuth_rad = std::atan2(one.point_m.y(), one.point_m.x());
    const double t_s = 2.0 + sense * turn_s * azimuth_rad / (2.0 * std::numbers::pi);
    most_m = std::max(
        most_m, naive_surface_distance_m(T_scene_laser(t_s) * one.point_m.cast<double>(), walls));
  }
  return most_m;
}

TEST(LaserScannerReference, AMovingScannersPointsLieOnTheWallsAtTheirOwnTimes) {
  const Scene scene = big_room();
  const SceneTracer tracer(scene);
  const SceneMoment moment(tracer, {1.9, 2.1});
  const PoseAtTime T_scene_laser = [](double t_s) {
    const double s = t_s - 2.0;
    const Eigen::AngleAxisd yaw(0.3 + 0.6 * s, Vector3d::UnitZ());
    return make_pose(yaw.toRotationMatrix(), {1.0 + 12.0 * s, 0.5 - 5.0 * s, 0.2 + s});
  };
  LaserScannerConfig config = few_azimuths(0.0);
  config.turn_s = 0.1;
  const std::vector<LaserReturn> returns = scan(moment, T_scene_laser, 2.0, 0, config);
  ASSERT_EQ(returns.size(), 64U * 180U);
  const std::vector<NaiveTriangle> walls = naive_triangles(scene, moment.span(), 0.0);
  // A step of azimuth takes 0.6 ms, in which the scanner goes 7 mm.
  const double left_m = worst_m(returns, walls, T_scene_laser, 0.1, 1.0);
  const double right_m = worst_m(returns, walls, T_scene_laser, 0.1, -1.0);
  EXPECT_LT(std::min(left_m, right_m), 0.008);
  EXPECT_GT(std::max(left_m, right_m), 0.2);
}

TEST(LaserScannerTest, AMoverIsNamed) {
  Scene scene = big_room();
  MovingObject car;
  add_box(car.mesh, {.middle_m = {0.0F, 0.0F, 0.5F}, .size_m = {2.0F, 2.0F, 1.0F}}, {});
  car.route.points_m = {Vector3d(6.0, 0.0, -1.0), Vector3d(7.0, 0.0, -1.0)};
  car.route.speed_mps = 0.0;
  scene.movers = {car};
  int named = 0;
  for (const LaserReturn& one : scan_of(scene, Pose::Identity(), few_azimuths(0.0))) {
    const bool on_car = one.point_m.x() > 0.0F && one.point_m.x() < 7.6F &&
                        std::abs(one.point_m.y()) < 1.01F && one.point_m.z() > -1.01F &&
                        one.point_m.z() < 0.01F;
    EXPECT_EQ(one.object, on_car ? 1U : 0U);
    named += on_car ? 1 : 0;
  }
  EXPECT_GT(named, 50);
}

}  // namespace
}  // namespace skyhalo

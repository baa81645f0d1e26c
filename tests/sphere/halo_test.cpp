#include "skyhalo/sphere/halo.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "reference/naive_halo.hpp"
#include "skyhalo/geometry/angle.hpp"
#include "skyhalo/sphere/accumulate.hpp"
#include "support/expect_error.hpp"

namespace skyhalo {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
const cv::Size kSize(100, 80);

/// 53 x 44 degrees from the body origin, turned to the left.
PairGeometry pair_towards(double yaw_deg) {
  Eigen::Matrix3d R_body_camera;
  R_body_camera << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(rad_from_deg(yaw_deg), Eigen::Vector3d::UnitZ()).toRotationMatrix();
  return {
      .model =
          PinholePair{
              .focal_px = 100.0, .principal_u_px = 49.5, .principal_v_px = 39.5, .baseline_m = 0.5},
      .T_body_camera = make_pose(turn * R_body_camera, Eigen::Vector3d::Zero()),
      .max_range_m = 30.0};
}

GridBounds all_directions() {
  return {.theta_min_rad = 0.0,
          .theta_max_rad = rad_from_deg(180.0),
          .phi_min_rad = rad_from_deg(-180.0),
          .phi_max_rad = rad_from_deg(180.0),
          .step_rad = rad_from_deg(2.0)};
}

/// What a pair sees whose pixels all have this disparity; a plane at 50 m / d, or nothing near for
/// 0.
SphericalGrid grid_of(double yaw_deg, float disparity_px) {
  const PairGeometry pair = pair_towards(yaw_deg);
  SphericalGrid grid(grid_of_view(pair, kSize, all_directions(), 0.5));
  (void)accumulate(cv::Mat1f(kSize.height, kSize.width, disparity_px), pair, grid);
  return grid;
}

Halo two_degrees() {
  return Halo(rad_from_deg(2.0));
}

GridCell towards(double azimuth_deg, double pitch_deg = 0.5) {
  return whole_sphere(rad_from_deg(2.0))
      .cell_of(rad_from_deg(90.0 - pitch_deg), rad_from_deg(azimuth_deg))
      .value();
}

Timestamp at(int seconds) {
  return Timestamp(std::chrono::seconds(seconds));
}

TEST(HaloTest, KnowsNothingAtFirst) {
  const Halo halo = two_degrees();
  EXPECT_EQ(halo.geometry().cell_count(), 16200);
  EXPECT_EQ(halo.sight(towards(0.0)), Sight::kUnseen);
  EXPECT_EQ(halo.depth_m(towards(0.0)), std::nullopt);
  EXPECT_EQ(halo.free_to_m(towards(0.0)), 0.0);
  EXPECT_EQ(halo.source(towards(0.0)), std::nullopt);
  EXPECT_EQ(halo.age_s(towards(0.0), at(5)), std::nullopt);
}

TEST(HaloTest, TellsAThingFromFreeFromUnseen) {
  const SphericalGrid thing = grid_of(0.0, 10.0F);  // 5 m ahead
  const SphericalGrid free = grid_of(90.0, 0.0F);
  const SphericalGrid blank = grid_of(-90.0, kNan);  // a wall without texture
  Halo halo = two_degrees();
  halo.stitch(std::array<PairGrid, 3>{{{&thing, at(1)}, {&free, at(1)}, {&blank, at(1)}}});
  EXPECT_EQ(halo.sight(towards(1.0)), Sight::kObstacle);
  EXPECT_NEAR(halo.depth_m(towards(1.0)).value(), 5.0, 0.01);
  EXPECT_NEAR(halo.free_to_m(towards(1.0)), 5.0, 0.01);
  EXPECT_EQ(halo.source(towards(1.0)), 0U);
  EXPECT_EQ(halo.sight(towards(91.0)), Sight::kFree);
  EXPECT_EQ(halo.depth_m(towards(91.0)), std::nullopt);
  EXPECT_FLOAT_EQ(static_cast<float>(halo.free_to_m(towards(91.0))), 30.0F);
  EXPECT_EQ(halo.source(towards(91.0)), 1U);
  EXPECT_EQ(halo.sight(towards(-91.0)), Sight::kUnseen);
  EXPECT_EQ(halo.sight(towards(180.0)), Sight::kUnseen);  // no pixel at all
  EXPECT_EQ(halo.sight(towards(0.0, 89.0)), Sight::kUnseen);
}

TEST(HaloTest, NanAndInfinityAreNeverADepth) {
  for (const float value : {kNan, std::numeric_limits<float>::infinity(), -3.0F}) {
    const SphericalGrid grid = grid_of(0.0, value);
    Halo halo = two_degrees();
    halo.stitch(std::array<PairGrid, 1>{{{&grid, at(1)}}});
    for (int i = 0; i < halo.geometry().cell_count(); ++i) {
      EXPECT_EQ(halo.sight({i / 180, i % 180}), Sight::kUnseen) << value;
    }
  }
}

TEST(HaloTest, FewValidPixelsAreNoFreedom) {
  // A far match in every tenth column of a wall without texture.
  cv::Mat1f disparity(kSize.height, kSize.width, kNan);
  for (int u = 0; u < kSize.width; u += 10) {
    disparity.col(u).setTo(0.5F);  // 100 m
  }
  const PairGeometry pair = pair_towards(0.0);
  SphericalGrid grid = grid_of(0.0, kNan);
  grid.clear();
  (void)accumulate(disparity, pair, grid);
  Halo halo = two_degrees();
  halo.stitch(std::array<PairGrid, 1>{{{&grid, at(1)}}});
  for (int i = 0; i < halo.geometry().cell_count(); ++i) {
    EXPECT_NE(halo.sight({i / 180, i % 180}), Sight::kFree) << i;
  }
}

TEST(HaloTest, TheNearestWinsAndItsPairIsRemembered) {
  const SphericalGrid far = grid_of(0.0, 5.0F);
  const SphericalGrid near = grid_of(0.0, 10.0F);
  Halo halo = two_degrees();
  halo.stitch(std::array<PairGrid, 3>{{{&far, at(1)}, {&near, at(2)}, {&near, at(3)}}});
  EXPECT_NEAR(halo.depth_m(towards(1.0)).value(), 5.0, 0.01);
  EXPECT_EQ(halo.source(towards(1.0)), 1U);  // the first of equals
  EXPECT_NEAR(halo.age_s(towards(1.0), at(10)).value(), 8.0, 1e-9);
  EXPECT_NEAR(halo.free_to_m(towards(1.0)), 5.0, 0.01);  // not as far as the other pair saw
}

TEST(HaloTest, WrapsBehind) {
  const SphericalGrid behind = grid_of(180.0, 10.0F);
  EXPECT_LT(behind.geometry().cols, 60);
  Halo halo = two_degrees();
  halo.stitch(std::array<PairGrid, 1>{{{&behind, at(1)}}});
  for (const double azimuth_deg : {-179.0, 179.0, -165.0, 165.0}) {
    EXPECT_EQ(halo.sight(towards(azimuth_deg)), Sight::kObstacle) << azimuth_deg;
  }
  EXPECT_EQ(halo.sight(towards(0.0)), Sight::kUnseen);
}

TEST(HaloTest, WhatIsNotDeliveredIsUnseenNotOld) {
  const SphericalGrid front = grid_of(0.0, 10.0F);
  const SphericalGrid left = grid_of(90.0, 10.0F);
  Halo halo = two_degrees();
  halo.stitch(std::array<PairGrid, 2>{{{&front, at(1)}, {&left, at(1)}}});
  halo.stitch(std::array<PairGrid, 2>{{{&front, at(2)}, {nullptr, at(2)}}});
  EXPECT_EQ(halo.sight(towards(91.0)), Sight::kUnseen);
  EXPECT_EQ(halo.source(towards(91.0)), std::nullopt);
  EXPECT_NEAR(halo.age_s(towards(91.0), at(4)).value(), 3.0, 1e-9);
  EXPECT_NEAR(halo.age_s(towards(1.0), at(4)).value(), 2.0, 1e-9);
}

TEST(HaloTest, RefusesGridsOfAnotherStep) {
  const SphericalGrid other(whole_sphere(rad_from_deg(3.0)));
  Halo halo = two_degrees();
  EXPECT_THAT(testing::message_of([&] {
                halo.stitch(std::array<PairGrid, 1>{{{&other, at(1)}}});
              }),
              ::testing::HasSubstr("step"));
}

/// A pair's grid as the naive version takes it.
reference::NaiveHaloPair naive_of(const SphericalGrid& grid) {
  const GridGeometry& geometry = grid.geometry();
  reference::NaiveHaloPair pair;
  pair.spec = {geometry.theta_min_rad,
               geometry.theta_min_rad + geometry.rows * geometry.theta_step_rad,
               geometry.phi_min_rad,
               geometry.phi_min_rad + geometry.cols * geometry.phi_step_rad,
               geometry.theta_step_rad};
  pair.depth_m.assign(grid.depths_m().begin(), grid.depths_m().end());
  pair.free_to_m.assign(grid.free_to_m().begin(), grid.free_to_m().end());
  return pair;
}

TEST(HaloTest, RefusesGridsThatAreNoPartOfIt) {
  GridGeometry askew = whole_sphere(rad_from_deg(2.0));
  askew.rows = 40;
  askew.theta_min_rad = rad_from_deg(1.0);
  GridGeometry narrow = whole_sphere(rad_from_deg(2.0));
  narrow.phi_step_rad = rad_from_deg(1.0);
  GridGeometry tall = whole_sphere(rad_from_deg(2.0));
  tall.rows = 91;
  Halo halo = two_degrees();
  for (const GridGeometry& geometry : {askew, narrow, tall}) {
    const SphericalGrid grid(geometry);
    EXPECT_THAT(testing::message_of([&] {
                  halo.stitch(std::array<PairGrid, 1>{{{&grid, at(1)}}});
                }),
                ::testing::HasSubstr("aligned"));
  }
}

TEST(HaloTest, TakesWhatAnotherSensorKnows) {
  Halo halo = two_degrees();
  halo.set(towards(1.0), 4.0F, 9.0F, 3, at(7));
  EXPECT_EQ(halo.sight(towards(1.0)), Sight::kObstacle);
  EXPECT_EQ(halo.free_to_m(towards(1.0)), 4.0);
  EXPECT_EQ(halo.source(towards(1.0)), 3U);
  EXPECT_NEAR(halo.age_s(towards(1.0), at(9)).value(), 2.0, 1e-9);
  halo.set(towards(1.0), kNan, 0.0F);
  EXPECT_EQ(halo.sight(towards(1.0)), Sight::kUnseen);
  EXPECT_EQ(halo.source(towards(1.0)), std::nullopt);
  EXPECT_NEAR(halo.age_s(towards(1.0), at(9)).value(), 2.0, 1e-9);
}

TEST(HaloReference, StitchingAgreesWithTheNaiveOverlay) {
  std::mt19937 random(93);
  std::uniform_real_distribution<float> unit(0.0F, 1.0F);
  for (int round = 0; round < 12; ++round) {
    std::vector<SphericalGrid> grids;
    for (int k = 0; k < 5; ++k) {
      const PairGeometry pair = pair_towards(360.0 * unit(random));
      cv::Mat1f disparity(kSize);
      for (float& value : disparity) {
        value = unit(random) < 0.3F ? kNan : 20.0F * unit(random) * unit(random);
      }
      grids.emplace_back(grid_of_view(pair, kSize, all_directions(), 0.5));
      (void)accumulate(disparity, pair, grids.back());
    }
    std::vector<PairGrid> delivered;
    std::vector<std::optional<reference::NaiveHaloPair>> naive;
    for (const SphericalGrid& grid : grids) {
      const bool is_there = unit(random) < 0.8F;
      delivered.push_back({is_there ? &grid : nullptr, at(1)});
      naive.push_back(is_there ? std::optional(naive_of(grid)) : std::nullopt);
    }
    Halo halo = two_degrees();
    halo.stitch(delivered);
    const auto expected = reference::naive_halo_stitch(rad_from_deg(2.0), naive);
    int different = 0;
    for (std::size_t i = 0; i < expected.depth_m.size(); ++i) {
      const auto depth_m = static_cast<float>(expected.depth_m[i]);
      const bool same_depth =
          std::isnan(depth_m) ? std::isnan(halo.depths_m()[i]) : halo.depths_m()[i] == depth_m;
      different += same_depth && halo.free_to_m()[i] == static_cast<float>(expected.free_to_m[i]) &&
                           halo.sources()[i] == expected.source[i]
                       ? 0
                       : 1;
    }
    EXPECT_EQ(different, 0) << round;
  }
}

TEST(GridOfViewTest, CoversTheViewAndLittleMore) {
  const GridGeometry front = grid_of(0.0, 10.0F).geometry();
  // 26.6 degrees to either side, 21.8 up and down; in the corners more.
  EXPECT_GE(front.cols * 2, 54);
  EXPECT_LE(front.cols * 2, 80);
  EXPECT_GE(front.rows * 2, 44);
  EXPECT_LE(front.rows * 2, 70);
}

TEST(GridOfViewTest, APoleIsSeenFromAllSides) {
  PairGeometry down = pair_towards(0.0);
  down.T_body_camera.linear() =
      Eigen::AngleAxisd(rad_from_deg(90.0), Eigen::Vector3d::UnitY()).toRotationMatrix() *
      down.T_body_camera.linear();
  const GridGeometry grid = grid_of_view(down, kSize, all_directions(), 0.5);
  EXPECT_TRUE(grid.is_whole_circle());
  EXPECT_TRUE(grid.reaches_down());
  EXPECT_GT(deg_from_rad(grid.theta_min_rad), 130.0);
}

TEST(GridOfViewTest, KeepsWithinBounds) {
  const GridBounds bounds{.theta_min_rad = rad_from_deg(80.0),
                          .theta_max_rad = rad_from_deg(100.0),
                          .phi_min_rad = rad_from_deg(0.0),
                          .phi_max_rad = rad_from_deg(180.0),
                          .step_rad = rad_from_deg(2.0)};
  const GridGeometry grid = grid_of_view(pair_towards(0.0), kSize, bounds, 0.5);
  EXPECT_EQ(grid.rows, 10);
  EXPECT_NEAR(grid.phi_min_rad, 0.0, 1e-9);
  EXPECT_LT(grid.cols, 20);
  EXPECT_THAT(
      testing::message_of([&] { (void)grid_of_view(pair_towards(-90.0), kSize, bounds, 0.5); }),
      ::testing::HasSubstr("sees nothing"));
}

}  // namespace
}  // namespace skyhalo

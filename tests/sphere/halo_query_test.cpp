#include "skyhalo/sphere/halo_query.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "reference/naive_halo.hpp"
#include "skyhalo/geometry/angle.hpp"
#include "skyhalo/geometry/spherical.hpp"
#include "support/sanitised.hpp"

namespace skyhalo {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

/// Free for 20 m in all directions.
Halo free_halo(double step_deg = 2.0) {
  Halo halo(rad_from_deg(step_deg));
  for (int i = 0; i < halo.geometry().cell_count(); ++i) {
    halo.set({i / halo.geometry().cols, i % halo.geometry().cols}, kNan, 20.0F);
  }
  return halo;
}

GridCell towards(const Halo& halo, double azimuth_deg, double pitch_deg) {
  return halo.geometry().cell_of(rad_from_deg(90.0 - pitch_deg), rad_from_deg(azimuth_deg)).value();
}

void put(Halo& halo, double azimuth_deg, double pitch_deg, float range_m) {
  halo.set(towards(halo, azimuth_deg, pitch_deg), range_m, range_m);
}

void hide(Halo& halo, double azimuth_deg, double pitch_deg) {
  halo.set(towards(halo, azimuth_deg, pitch_deg), kNan, 0.0F);
}

Eigen::Vector3d ray(double azimuth_deg, double pitch_deg) {
  return direction(rad_from_deg(90.0 - pitch_deg), rad_from_deg(azimuth_deg));
}

TEST(HaloQueryTest, ADirectionIsOneCell) {
  Halo halo = free_halo();
  put(halo, 31.0, 11.0, 4.0F);
  hide(halo, -31.0, 11.0);
  const RegionView thing = view_along(halo, 7.0 * ray(31.2, 11.4));
  EXPECT_EQ(thing.sight(), Sight::kObstacle);
  EXPECT_NEAR(thing.nearest_m, 4.0, 1e-6);
  EXPECT_EQ(thing.cells, 1);
  EXPECT_EQ(view_along(halo, ray(-31.0, 11.0)).sight(), Sight::kUnseen);
  EXPECT_EQ(view_along(halo, ray(35.0, 11.0)).sight(), Sight::kFree);
  EXPECT_NEAR(view_along(halo, ray(35.0, 11.0)).free_to_m, 20.0, 1e-5);
  EXPECT_EQ(view_along(halo, Eigen::Vector3d::Zero()).sight(), Sight::kUnseen);
  EXPECT_EQ(view_along(halo, {std::nan(""), 1.0, 0.0}).sight(), Sight::kUnseen);
}

TEST(HaloQueryTest, AConeHoldsTheNearestOfItsThings) {
  Halo halo = free_halo();
  put(halo, 9.0, 1.0, 7.0F);
  put(halo, -5.0, 3.0, 9.0F);
  put(halo, 15.0, 1.0, 2.0F);  // outside
  const RegionView view = view_in_cone(halo, Eigen::Vector3d::UnitX(), rad_from_deg(10.0));
  EXPECT_NEAR(view.nearest_m, 7.0, 1e-6);
  EXPECT_EQ(view.nearest_cell, towards(halo, 9.0, 1.0));
  EXPECT_NEAR(view.free_to_m, 7.0, 1e-6);
  // pi 10^2 / 2^2 cells
  EXPECT_NEAR(view.cells, 79, 5);
}

TEST(HaloQueryTest, OneUnseenCellMakesAConeUnseenButNotAThingLess) {
  Halo halo = free_halo();
  hide(halo, 3.0, 3.0);
  RegionView view = view_in_cone(halo, Eigen::Vector3d::UnitX(), rad_from_deg(10.0));
  EXPECT_EQ(view.sight(), Sight::kUnseen);
  EXPECT_EQ(view.unseen_cells, 1);
  EXPECT_EQ(view.free_to_m, 0.0);
  put(halo, 1.0, 1.0, 5.0F);
  view = view_in_cone(halo, Eigen::Vector3d::UnitX(), rad_from_deg(10.0));
  EXPECT_EQ(view.sight(), Sight::kObstacle);
  EXPECT_EQ(view.unseen_cells, 1);
}

TEST(HaloQueryTest, AConeOverAPoleGoesAllRound) {
  Halo halo = free_halo();
  put(halo, 170.0, 85.0, 3.0F);
  put(halo, -60.0, 87.0, 4.0F);
  const RegionView view = view_in_cone(halo, Eigen::Vector3d::UnitZ(), rad_from_deg(6.0));
  EXPECT_EQ(view.cells, 3 * 180);
  EXPECT_NEAR(view.nearest_m, 3.0, 1e-6);
}

TEST(HaloQueryTest, ABoxMayCrossTheHalfPlaneBehind) {
  Halo halo = free_halo();
  put(halo, 175.0, 1.0, 6.0F);
  put(halo, -175.0, 1.0, 5.0F);
  put(halo, 0.0, 1.0, 1.0F);
  const AngleBox behind{
      rad_from_deg(80.0), rad_from_deg(100.0), rad_from_deg(170.0), rad_from_deg(-170.0)};
  EXPECT_NEAR(view_in_box(halo, behind).nearest_m, 5.0, 1e-6);
  EXPECT_EQ(view_in_box(halo, behind).cells, 100);
  const AngleBox all{0.0, std::numbers::pi, -std::numbers::pi, std::numbers::pi};
  EXPECT_EQ(view_in_box(halo, all).cells, 16200);
  const AngleBox none{0.0, std::numbers::pi, 1.0, 1.0};
  EXPECT_EQ(view_in_box(halo, none).cells, 0);
  EXPECT_EQ(view_in_box(halo, none).sight(), Sight::kUnseen);
}

TEST(HaloQueryTest, AWholeTurnHoldsAllCellsWhereverItBegins) {
  const Halo halo = free_halo();
  for (int first_deg = -180; first_deg < 180; ++first_deg) {
    const AngleBox box{
        0.0, std::numbers::pi, rad_from_deg(first_deg), rad_from_deg(first_deg + 360.0)};
    EXPECT_EQ(view_in_box(halo, box).cells, 16200) << first_deg;
  }
}

TEST(HaloQueryTest, ACellCountsForBothSectorsThatItReachesInto) {
  Halo halo = free_halo();
  put(halo, 2.1, 0.5, 4.0F);     // its cell is 2...4 degrees, the sectors part at 2.5
  put(halo, 91.0, -10.5, 3.0F);  // and this one -12...-10, below the band but for its border
  const Ring ring =
      ring_of(halo, {rad_from_deg(-10.0), rad_from_deg(10.0)}, Eigen::Matrix3d::Identity());
  EXPECT_NEAR(ring[0].nearest_m, 4.0, 1e-6);
  EXPECT_NEAR(ring[1].nearest_m, 4.0, 1e-6);
  EXPECT_NEAR(ring[18].nearest_m, 3.0, 1e-6);
}

TEST(HaloQueryTest, TheRingHasASectorForEveryFiveDegrees) {
  Halo halo = free_halo();
  put(halo, 1.0, 1.0, 8.0F);    // sector 0: -2.5 to 2.5
  put(halo, 91.0, -3.0, 6.0F);  // sector 18
  put(halo, -89.0, 5.0, 4.0F);  // sector 54
  put(halo, 91.0, 15.0, 1.0F);  // above the band
  hide(halo, 179.0, 1.0);       // sector 36
  const Ring ring =
      ring_of(halo, {rad_from_deg(-10.0), rad_from_deg(10.0)}, Eigen::Matrix3d::Identity());
  EXPECT_NEAR(ring[0].nearest_m, 8.0, 1e-6);
  EXPECT_NEAR(ring[18].nearest_m, 6.0, 1e-6);
  EXPECT_NEAR(ring[54].nearest_m, 4.0, 1e-6);
  EXPECT_EQ(ring[36].sight(), Sight::kUnseen);
  for (const int k : {1, 17, 19, 35, 37, 53, 55, 71}) {
    EXPECT_EQ(ring[static_cast<std::size_t>(k)].sight(), Sight::kFree) << k;
  }
}

TEST(HaloQueryTest, TheRingIsLevelAndKeepsToTheNose) {
  // The nose 20 deg down, heading 70 deg: what is level ahead stands 20 deg above the nose.
  Halo halo = free_halo();
  put(halo, 1.0, 20.5, 8.0F);
  put(halo, 1.0, 0.5, 3.0F);  // below the horizon
  const Eigen::Matrix3d R_map_body =
      (Eigen::AngleAxisd(rad_from_deg(70.0), Eigen::Vector3d::UnitZ()) *
       Eigen::AngleAxisd(rad_from_deg(20.0), Eigen::Vector3d::UnitY()))
          .toRotationMatrix();
  const Ring ring = ring_of(halo, {rad_from_deg(-5.0), rad_from_deg(5.0)}, R_map_body);
  EXPECT_NEAR(ring[0].nearest_m, 8.0, 1e-6);
  for (std::size_t k = 1; k < ring.size(); ++k) {
    EXPECT_EQ(ring[k].sight(), Sight::kFree) << k;
  }
}

TEST(HaloQueryTest, LargeCellsCountForEverySectorTheyReachInto) {
  Halo halo = free_halo(15.0);
  put(halo, 7.0, 7.0, 5.0F);  // azimuth 0...15 deg
  const Ring ring =
      ring_of(halo, {rad_from_deg(0.0), rad_from_deg(15.0)}, Eigen::Matrix3d::Identity());
  for (const std::size_t k : {1U, 2U}) {
    EXPECT_NEAR(ring[k].nearest_m, 5.0, 1e-6) << k;
  }
  EXPECT_EQ(ring[5].sight(), Sight::kFree);
  for (const RegionView& sector : ring) {
    EXPECT_GT(sector.cells, 0);
  }
}

TEST(HaloQueryTest, ATubeEndsWhereTheBallTouches) {
  Halo halo = free_halo();
  put(halo, 0.5, 0.5, 10.0F);
  const TubeView ahead = view_along_tube(halo, {.radius_m = 0.5, .distance_m = 15.0});
  EXPECT_EQ(ahead.sight, Sight::kObstacle);
  EXPECT_NEAR(ahead.clear_to_m, 9.5, 1e-3);
  EXPECT_EQ(ahead.limiting_cell, towards(halo, 0.5, 0.5));
  // It stops before.
  const TubeView shorter = view_along_tube(halo, {.radius_m = 0.5, .distance_m = 9.0});
  EXPECT_EQ(shorter.sight, Sight::kFree);
  EXPECT_NEAR(shorter.clear_to_m, 9.0, 1e-12);
  EXPECT_EQ(shorter.limiting_cell, std::nullopt);
  // It passes by: the thing is 10 sin(10 deg) = 1.7 m aside.
  const TubeView aside = view_along_tube(
      halo, {.direction_body = ray(10.0, 0.0), .radius_m = 0.5, .distance_m = 15.0});
  EXPECT_EQ(aside.sight, Sight::kFree);
  const TubeView away = view_along_tube(
      halo, {.direction_body = -Eigen::Vector3d::UnitX(), .radius_m = 0.5, .distance_m = 15.0});
  EXPECT_EQ(away.sight, Sight::kFree);
}

TEST(HaloQueryTest, APointTouchesWhatIsInItsWay) {
  Halo halo = free_halo();
  put(halo, 0.5, 0.5, 10.0F);
  const TubeView view = view_along_tube(halo, {.radius_m = 0.0, .distance_m = 15.0});
  EXPECT_EQ(view.sight, Sight::kObstacle);
  EXPECT_NEAR(view.clear_to_m, 10.0, 1e-3);
  EXPECT_EQ(view_along_tube(Halo(rad_from_deg(2.0)), {.distance_m = 15.0}).sight, Sight::kUnseen);
}

TEST(HaloQueryTest, ATubeThatIsNoneIsUnseen) {
  const Halo halo = free_halo();
  const double nan = std::nan("");
  for (const Tube& tube : {Tube{.radius_m = nan, .distance_m = 5.0},
                           Tube{.radius_m = -1.0, .distance_m = 5.0},
                           Tube{.radius_m = 0.5, .distance_m = nan},
                           Tube{.radius_m = 0.5, .distance_m = -5.0},
                           Tube{.radius_m = 0.5, .distance_m = 5.0, .look_angle_rad = nan}}) {
    EXPECT_EQ(view_along_tube(halo, tube).sight, Sight::kUnseen);
    EXPECT_EQ(view_along_tube(halo, tube).clear_to_m, 0.0);
  }
}

TEST(HaloQueryTest, ATubeEndsWhereNothingWasSeen) {
  Halo halo = free_halo();
  hide(halo, 0.5, 0.5);
  const TubeView view = view_along_tube(halo, {.radius_m = 0.5, .distance_m = 15.0});
  EXPECT_EQ(view.sight, Sight::kUnseen);
  EXPECT_NEAR(view.clear_to_m, 0.0, 1e-9);
  // All is seen for 20 m, and no farther.
  const TubeView far = view_along_tube(
      halo, {.direction_body = ray(90.0, 0.0), .radius_m = 0.5, .distance_m = 30.0});
  EXPECT_EQ(far.sight, Sight::kUnseen);
  EXPECT_NEAR(far.clear_to_m, 19.5, 1e-3);
}

TEST(HaloQueryTest, ATubeAsksOnlyWithinItsLookAngle) {
  Halo halo = free_halo();
  hide(halo, 50.0, 0.5);
  Tube tube{.radius_m = 0.5, .distance_m = 5.0};
  EXPECT_EQ(view_along_tube(halo, tube).sight, Sight::kFree);
  tube.look_angle_rad = rad_from_deg(90.0);
  EXPECT_EQ(view_along_tube(halo, tube).sight, Sight::kUnseen);
  tube.direction_body = -tube.direction_body;
  EXPECT_EQ(view_along_tube(halo, tube).sight, Sight::kFree);
  EXPECT_EQ(view_along_tube(halo, {.direction_body = Eigen::Vector3d::Zero()}).sight,
            Sight::kUnseen);
}

/// Any mixture of things, freedom and the unseen.
Halo random_halo(std::mt19937& random, double step_deg) {
  std::uniform_real_distribution<float> unit(0.0F, 1.0F);
  Halo halo(rad_from_deg(step_deg));
  for (int i = 0; i < halo.geometry().cell_count(); ++i) {
    const float kind = unit(random);
    const float range_m = 1.0F + 20.0F * unit(random);
    const float free_m = unit(random) < 0.1F ? 0.0F : 25.0F * unit(random);
    halo.set({i / halo.geometry().cols, i % halo.geometry().cols},
             kind < 0.4F ? range_m : kNan,
             kind < 0.9F ? free_m : 0.0F);
  }
  return halo;
}

reference::NaiveHaloSphere naive_of(const Halo& halo) {
  reference::NaiveHaloSphere sphere;
  sphere.spec = reference::naive_halo_sphere_spec(halo.geometry().theta_step_rad);
  for (int i = 0; i < halo.geometry().cell_count(); ++i) {
    const GridCell cell{i / halo.geometry().cols, i % halo.geometry().cols};
    sphere.depth_m.push_back(halo.depth_m(cell).value_or(std::nan("")));
    sphere.free_to_m.push_back(halo.free_to_m(cell));
    sphere.source.push_back(0);
  }
  return sphere;
}

void expect_same(const RegionView& view,
                 const reference::NaiveHaloAnswer& expected,
                 const GridGeometry& grid) {
  EXPECT_EQ(view.cells, expected.cells);
  EXPECT_EQ(view.unseen_cells, expected.unseen_cells);
  EXPECT_EQ(view.nearest_m, expected.nearest_m);
  ASSERT_EQ(view.nearest_cell.has_value(), expected.nearest_cell.has_value());
  if (view.nearest_cell) {
    EXPECT_EQ(static_cast<std::size_t>(grid.offset_of(*view.nearest_cell)), *expected.nearest_cell);
  }
  if (expected.cells > 0) {
    EXPECT_EQ(view.free_to_m, expected.free_to_m);
  }
}

TEST(HaloQueryReference, ConesAndBoxesAgreeWithNaiveOnes) {
  std::mt19937 random(91);
  std::uniform_real_distribution<double> angle(-std::numbers::pi, std::numbers::pi);
  std::normal_distribution<double> normal(0.0, 1.0);
  for (int round = 0; round < 60; ++round) {
    const Halo halo = random_halo(random, round % 2 == 0 ? 5.0 : 12.0);
    const reference::NaiveHaloSphere naive = naive_of(halo);
    const Eigen::Vector3d axis(normal(random), normal(random), normal(random));
    const double half_angle = 0.5 * std::abs(angle(random));
    expect_same(view_in_cone(halo, axis, half_angle),
                reference::naive_halo_in_cone(naive, {axis.x(), axis.y(), axis.z()}, half_angle),
                halo.geometry());
    const double theta = 0.4 * std::abs(angle(random));
    const AngleBox box{theta, theta + 1.0, angle(random), angle(random)};
    expect_same(
        view_in_box(halo, box),
        reference::naive_halo_in_box(
            naive, {box.theta_min_rad, box.theta_max_rad, box.phi_min_rad, box.phi_max_rad}),
        halo.geometry());
  }
}

/// How far the ball goes before it touches one of many places in things, or in what is unseen
/// within the look angle, by small steps.
double stepped_travel_m(const Halo& halo, const Tube& tube, double step_m) {
  std::vector<Eigen::Vector3d> places_m;
  const GridGeometry& grid = halo.geometry();
  const Eigen::Vector3d way = tube.direction_body.normalized();
  for (int i = 0; i < grid.cell_count(); ++i) {
    const GridCell cell{i / grid.cols, i % grid.cols};
    const Eigen::Vector3d middle = grid.center_direction(cell);
    const double known_m = std::max(halo.free_to_m(cell), tube.radius_m);
    const auto depth_m = halo.depth_m(cell);
    if (depth_m) {
      places_m.push_back(*depth_m * middle);
    }
    const bool asked = std::acos(std::clamp(middle.dot(way), -1.0, 1.0)) <= tube.look_angle_rad;
    for (double range_m = known_m * 1.0001; asked && range_m < (depth_m ? *depth_m : 30.0);
         range_m += 0.1) {
      places_m.push_back(range_m * middle);
    }
  }
  for (double travel_m = 0.0; travel_m < tube.distance_m; travel_m += step_m) {
    for (const Eigen::Vector3d& place_m : places_m) {
      const Eigen::Vector3d from_ball_m = place_m - travel_m * way;
      if (from_ball_m.norm() < tube.radius_m && place_m.dot(way) > 0.0) {
        return travel_m;
      }
    }
  }
  return tube.distance_m;
}

TEST(HaloQueryProperty, ATubeIsNeverLongerThanABallCanGo) {
  std::mt19937 random(92);
  std::normal_distribution<double> normal(0.0, 1.0);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  double travelled_m = 0.0;
  for (int round = 0; round < testing::rounds(25); ++round) {
    Halo halo = free_halo(6.0);
    for (int things = 0; things < 60; ++things) {
      const double azimuth_deg = 360.0 * unit(random) - 180.0;
      const double pitch_deg = 170.0 * unit(random) - 85.0;
      if (unit(random) < 0.8) {
        put(halo, azimuth_deg, pitch_deg, static_cast<float>(1.0 + 12.0 * unit(random)));
      } else {
        halo.set(
            towards(halo, azimuth_deg, pitch_deg), kNan, static_cast<float>(8.0 * unit(random)));
      }
    }
    const Tube tube{.direction_body = {normal(random), normal(random), normal(random)},
                    .radius_m = 0.2 + 0.6 * unit(random),
                    .distance_m = 12.0,
                    .look_angle_rad = rad_from_deg(unit(random) < 0.5 ? 90.0 : 30.0)};
    const TubeView view = view_along_tube(halo, tube);
    const double stepped_m = stepped_travel_m(halo, tube, 0.02);
    EXPECT_LE(view.clear_to_m, stepped_m + 0.02) << round;
    // Cells are 8 degrees across their corners: it gives away no more than that.
    EXPECT_EQ(view.sight == Sight::kFree, view.clear_to_m == tube.distance_m);
    travelled_m += view.clear_to_m;
  }
  EXPECT_GT(travelled_m, 10.0);
}

}  // namespace
}  // namespace skyhalo

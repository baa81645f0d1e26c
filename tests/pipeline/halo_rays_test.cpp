#include "skyhalo/pipeline/halo_rays.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <random>
#include <vector>

#include "reference/naive_occupancy_map.hpp"
#include "skyhalo/geometry/angle.hpp"
#include "skyhalo/geometry/spherical.hpp"

namespace skyhalo {
namespace {

/// Steps of 10 deg: theta 40 is row 4, phi -50 column 13.
Halo coarse_halo() {
  return Halo(rad_from_deg(10.0));
}

/// Puts a thing into the cell that holds a point (m, body).
void put(Halo& halo, const Eigen::Vector3d& p_body_m, std::uint8_t source = 0) {
  const SphericalPoint point = to_spherical(p_body_m);
  const auto cell = halo.geometry().cell_of(point.theta_rad, point.phi_rad);
  const auto range_m = static_cast<float>(point.rho_m);
  halo.set(cell.value(), range_m, range_m, source);
}

std::vector<RangeModel> range_models() {
  RangeModel model;
  model.pair = PinholePair{.focal_px = 400.0, .baseline_m = 0.5};
  return {model};
}

DenseMap box_map() {
  return DenseMap(
      make_voxel_grid({Eigen::Vector3d::Constant(-8.0), Eigen::Vector3d::Constant(8.0)}, 0.5));
}

int count_known(const DenseMap& map) {
  return static_cast<int>(std::count_if(
      map.cells().begin(), map.cells().end(), [](LogOdds cell) { return cell != kUnknown; }));
}

TEST(HaloRaysTest, AnEmptyHaloSendsNoRays) {
  const Halo halo = coarse_halo();
  DenseMap map = box_map();
  EXPECT_EQ(HaloRays(halo.geometry()).integrate(halo, range_models(), Pose::Identity(), map), 0);
  EXPECT_EQ(count_known(map), 0);
}

TEST(HaloRaysTest, ACellSendsItsRayThroughItsCentre) {
  Halo halo = coarse_halo();
  // Off the centre of cell (5, 5), whose middle is theta 95, phi 5 deg.
  put(halo, 6.0 * direction(rad_from_deg(91.0), rad_from_deg(9.0)));
  DenseMap map = box_map();
  EXPECT_EQ(HaloRays(halo.geometry()).integrate(halo, range_models(), Pose::Identity(), map), 1);
  const Eigen::Vector3d centre = direction(rad_from_deg(95.0), rad_from_deg(5.0));
  EXPECT_GT(map.at_point(6.0 * centre), 1000);
  EXPECT_LT(map.at_point(3.0 * centre), 0);
  EXPECT_EQ(map.at_point(8.0 * direction(rad_from_deg(91.0), rad_from_deg(9.0))), kUnknown);
}

TEST(HaloRaysTest, ThePoseTakesTheRayToTheMap) {
  Halo halo = coarse_halo();
  put(halo, 4.0 * direction(rad_from_deg(95.0), rad_from_deg(5.0)));
  // The vehicle stands at (1, -3, 2) and looks along the map's y.
  const Pose T_map_body =
      make_pose(Eigen::AngleAxisd(rad_from_deg(90.0), Eigen::Vector3d::UnitZ()).toRotationMatrix(),
                {1.0, -3.0, 2.0});
  DenseMap map = box_map();
  EXPECT_EQ(HaloRays(halo.geometry()).integrate(halo, range_models(), T_map_body, map), 1);
  const Eigen::Vector3d unit = direction(rad_from_deg(95.0), rad_from_deg(95.0));
  EXPECT_GT(map.at_point(Eigen::Vector3d(1.0, -3.0, 2.0) + 4.0 * unit), 1000);
  EXPECT_LT(map.at_point(Eigen::Vector3d(1.0, -3.0, 2.0) + 2.0 * unit), 0);
}

TEST(HaloRaysTest, EachDepthIsJudgedByThePairItComesFrom) {
  const Eigen::Vector3d centre = direction(rad_from_deg(95.0), rad_from_deg(5.0));
  std::vector<RangeModel> models = range_models();
  models.push_back(models.front());
  models.back().limit_units = 300;
  for (const std::uint8_t source : {std::uint8_t{0}, std::uint8_t{1}}) {
    Halo halo = coarse_halo();
    put(halo, 4.0 * centre, source);
    DenseMap map = box_map();
    EXPECT_EQ(HaloRays(halo.geometry()).integrate(halo, models, Pose::Identity(), map), 1);
    EXPECT_EQ(map.at_point(4.0 * centre) > 1000, source == 0);
    EXPECT_EQ(map.at_point(4.0 * centre) == 300, source == 1);
  }
}

TEST(HaloRaysTest, DepthsOfNoPairAreLeftOut) {
  Halo halo = coarse_halo();
  put(halo, {4.0, 0.0, 0.0}, 1);
  put(halo, {0.0, 4.0, 0.0}, Halo::kNoSource);
  DenseMap map = box_map();
  EXPECT_EQ(HaloRays(halo.geometry()).integrate(halo, range_models(), Pose::Identity(), map), 0);
  EXPECT_EQ(count_known(map), 0);
}

TEST(HaloRaysTest, EveryCellWithADepthSendsOneRay) {
  Halo halo = coarse_halo();
  for (int row = 4; row < 14; ++row) {
    for (int col = 13; col < 23; col += 2) {
      put(halo, 3.0 * halo.geometry().center_direction({row, col}));
    }
  }
  halo.set({0, 0}, std::numeric_limits<float>::quiet_NaN(), 20.0F);  // free, but no depth
  DenseMap map = box_map();
  EXPECT_EQ(HaloRays(halo.geometry()).integrate(halo, range_models(), Pose::Identity(), map), 50);
}

Pose random_pose(std::mt19937& random) {
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  const Eigen::Quaterniond q(1.1 + unit(random), unit(random), unit(random), unit(random));
  return make_pose(q.normalized().toRotationMatrix(),
                   2.0 * Eigen::Vector3d(unit(random), unit(random), unit(random)));
}

/// The ray of one cell as METHOD 5 says it, for the naive map.
reference::NaiveRay naive_ray(const GridGeometry& grid,
                              GridCell cell,
                              double z_m,
                              const Pose& T_map_body) {
  const double theta = grid.theta_min_rad + (cell.row + 0.5) * grid.theta_step_rad;
  const double phi = grid.phi_min_rad + (cell.col + 0.5) * grid.phi_step_rad;
  const Eigen::Vector3d unit =
      T_map_body.rotation() * Eigen::Vector3d(std::sin(theta) * std::cos(phi),
                                              std::sin(theta) * std::sin(phi),
                                              std::cos(theta));
  const Eigen::Vector3d origin_m = T_map_body.translation();
  return {{origin_m.x(), origin_m.y(), origin_m.z()},
          {unit.x(), unit.y(), unit.z()},
          z_m,
          reference::naive_pinhole_delta_z_m(z_m, 0.5, 400.0, 0.5)};
}

/// Cells that differ in being known, or by more than ties of rounding in their log odds.
int count_different(const DenseMap& map, const reference::NaiveMap& expected) {
  int different = 0;
  for (std::size_t i = 0; i < map.cells().size(); ++i) {
    const bool is_known = map.cells()[i] != kUnknown;
    const int units = is_known ? map.cells()[i] : 0;
    const bool is_same =
        is_known == expected.observed[i] &&
        std::abs(units - expected.log_odds_units[i]) <= 2;  // few rays share a cell
    different += is_same ? 0 : 1;
  }
  return different;
}

TEST(HaloRaysReference, AgreesWithNaiveRaysFromEveryCell) {
  std::mt19937 random(71);
  std::uniform_real_distribution<double> range_m(0.6, 12.0);
  for (int round = 0; round < 8; ++round) {
    Halo halo = coarse_halo();
    const Pose T_map_body = random_pose(random);
    DenseMap map = box_map();
    reference::NaiveMap expected =
        reference::naive_empty_map({{-8.0, -8.0, -8.0}, 0.5, {32, 32, 32}});
    for (int i = 0; i < 100; i += 3) {
      const GridCell cell{4 + i / 10, 13 + i % 10};
      const auto z_m = static_cast<float>(range_m(random));
      halo.set(cell, z_m, z_m);
      reference::naive_integrate(
          expected, naive_ray(halo.geometry(), cell, z_m, T_map_body), {}, 5.0);
    }
    const HaloRays rays(halo.geometry());
    EXPECT_EQ(rays.integrate(halo, range_models(), T_map_body, map), 34);
    EXPECT_EQ(count_different(map, expected), 0) << "round " << round;
  }
}

}  // namespace
}  // namespace skyhalo

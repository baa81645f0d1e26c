// Measurements of cones entered into maps against the naive integration, and worked by hand.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <numbers>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "map/random_scans.hpp"
#include "reference/naive_range_cone.hpp"
#include "skyhalo/base/error.hpp"
#include "skyhalo/map/cell_map.hpp"
#include "skyhalo/map/cone_integrator.hpp"

namespace skyhalo {
namespace {

using reference::NaiveBox;
using reference::NaiveIncrements;
using testing::between;
using testing::Random;

constexpr int kAllowedUnits = NaiveIncrements::kMostDoubt;
/// A limit that a single measurement never comes to.
constexpr int kNoLimitUnits = 32000;
constexpr double kHalfPi = 0.5 * std::numbers::pi;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// One measurement and the cells about it.
struct Case {
  RangeMeasurement measurement;
  Pose T_map_body = Pose::Identity();
  double voxel_m = 0.25;
  SensorModelConfig sensor{};
};

double log_uniform(Random& random, double low, double high) {
  return std::exp(between(random, std::log(low), std::log(high)));
}

/// Narrow and wide beams, sharp and vague ones, half of them without an echo; every fifth with
/// another p_unknown than 1/2.
std::vector<Case> cases() {
  std::vector<Case> all;
  Random random(41);
  for (int i = 0; i < 200; ++i) {
    Case one;
    one.voxel_m = between(random, 0.1, 0.5);
    one.T_map_body =
        testing::pose_in(random, {Eigen::Vector3d(-3, -3, -3), Eigen::Vector3d(3, 3, 3)});
    one.measurement.T_body_sensor =
        testing::pose_in(random, {Eigen::Vector3d::Constant(-0.3), Eigen::Vector3d::Constant(0.3)});
    one.measurement.half_angle_rad = i % 7 == 0 ? kHalfPi : log_uniform(random, 0.003, 1.5);
    one.measurement.max_range_m = between(random, 1.0, 14.0) * one.voxel_m;
    one.measurement.delta_z_m = log_uniform(random, 0.001, 0.5);
    if (i % 2 == 0) {
      one.measurement.range_m = one.measurement.max_range_m;
      one.measurement.max_range_m = 20.0;
    }
    if (i % 5 == 4) {
      one.sensor = {.k = 0.5, .p_unknown = 0.6, .p_free = 0.4};
    }
    all.push_back(one);
  }
  return all;
}

reference::NaiveCone naive_cone(const Case& one) {
  const Pose T_map_sensor = one.T_map_body * one.measurement.T_body_sensor;
  return {.tip_m = T_map_sensor.translation(),
          .axis = T_map_sensor.linear().col(0),
          .half_angle_rad = one.measurement.half_angle_rad,
          .range_m = one.measurement.range_m,
          .max_range_m = one.measurement.max_range_m,
          .delta_z_m = one.measurement.delta_z_m};
}

NaiveIncrements naive_increments(const Case& one, const NaiveBox& box) {
  return reference::naive_cone_integration(
      naive_cone(one),
      {.k = one.sensor.k, .p_unknown = one.sensor.p_unknown, .p_free = one.sensor.p_free},
      box);
}

template <class Map>
void enter(const Case& one, Map& map) {
  IntegrationConfig config;
  config.sensor = one.sensor;
  config.limit_units = kNoLimitUnits;
  ASSERT_TRUE(ConeIntegrator(config).integrate(one.measurement, one.T_map_body, map));
}

/// Counts of all comparisons of a kind of map.
struct Total {
  int said = 0;
  int marked = 0;
  int left_out = 0;
};

template <class Map>
void compare(const Map& map, const NaiveIncrements& naive, Total& total) {
  int wrong = 0;
  std::ostringstream first_wrong;
  for (std::size_t i = 0; i < naive.box().cell_count(); ++i) {
    const Eigen::Vector3i cell = naive.box().cell(i);
    const int expected = naive.increment(i);
    const LogOdds found = map.at(cell);
    if (naive.near_border(i)) {
      total.left_out += expected != 0 ? 1 : 0;
      continue;
    }
    total.said += expected != 0 ? 1 : 0;
    total.marked += expected > 0 ? 1 : 0;
    const int units = found == kUnknown ? 0 : found;
    const bool vague = naive.says(i) && std::abs(expected) <= kAllowedUnits;
    const bool wrongly_known = !vague && (found == kUnknown) != (expected == 0);
    if ((std::abs(units - expected) > kAllowedUnits || wrongly_known) && ++wrong <= 3) {
      first_wrong << "cell " << cell.transpose() << ": expected " << expected << ", found " << found
                  << '\n';
    }
  }
  EXPECT_EQ(wrong, 0) << first_wrong.str();
}

void expect_enough(const Total& total) {
  EXPECT_GT(total.said, 20000);
  EXPECT_GT(total.marked, 2000);
  EXPECT_LT(total.left_out, 0.1 * total.said);
}

std::string text_of(const Case& one) {
  std::ostringstream text;
  const reference::NaiveCone cone = naive_cone(one);
  text << "voxel " << one.voxel_m << ", tip " << cone.tip_m.transpose() << ", axis "
       << cone.axis.transpose() << ", half angle " << cone.half_angle_rad << ", range "
       << cone.range_m.value_or(-1.0) << " or at most " << cone.max_range_m << ", uncertain by "
       << cone.delta_z_m;
  return text.str();
}

TEST(ConeIntegratorReference, AMeasurementInADenseMap) {
  Total total;
  for (const Case& one : cases()) {
    SCOPED_TRACE(text_of(one));
    // Beside the lattice's planes; some tips and many echoes lie outside.
    const VoxelGrid grid{{-3.03, -2.04, -1.52}, one.voxel_m, {24, 20, 17}};
    DenseMap map(grid);
    enter(one, map);
    compare(map,
            naive_increments(one, {grid.min_m, one.voxel_m, Eigen::Vector3i::Zero(), grid.size}),
            total);
  }
  expect_enough(total);
}

TEST(ConeIntegratorReference, AMeasurementInALocalMap) {
  Total total;
  for (const Case& one : cases()) {
    SCOPED_TRACE(text_of(one));
    LocalMap map({26, 25, 24}, one.voxel_m);
    map.follow(one.T_map_body.translation());
    enter(one, map);
    compare(map,
            naive_increments(
                one, {Eigen::Vector3d::Zero(), one.voxel_m, map.bounds().min, map.bounds().size()}),
            total);
  }
  expect_enough(total);
}

TEST(ConeIntegratorReference, AMeasurementInASparseMap) {
  Total total;
  for (const Case& one : cases()) {
    SCOPED_TRACE(text_of(one));
    SparseMap map({{0.3, -0.1, 5.0}, one.voxel_m});
    enter(one, map);
    const Eigen::Vector3i tip = map.lattice().cell_of(naive_cone(one).tip_m);
    const NaiveBox box{map.lattice().origin_m,
                       one.voxel_m,
                       tip - Eigen::Vector3i::Constant(22),
                       Eigen::Vector3i::Constant(45)};
    compare(map, naive_increments(one, box), total);
    for_each_known_cell(map, map.known_bounds(), [&](const Eigen::Vector3i& cell, LogOdds) {
      EXPECT_TRUE(box.holds(cell)) << cell.transpose();
    });
  }
  expect_enough(total);
}

/// A sonar 0.1 m above the origin that looks along x.
RangeMeasurement sonar(std::optional<double> range_m) {
  RangeMeasurement measurement;
  measurement.T_body_sensor.translation() = Eigen::Vector3d(0.02, 0.03, 0.1);
  measurement.half_angle_rad = 0.3;
  measurement.range_m = range_m;
  measurement.max_range_m = 6.0;
  measurement.delta_z_m = 0.05;
  return measurement;
}

/// 8 x 8 x 4 m in cells of 0.2 m, from 1 m behind the body on.
DenseMap dense_map() {
  return DenseMap(VoxelGrid{{-1.0, -4.0, -2.0}, 0.2, {40, 40, 20}});
}

int count_known(const DenseMap& map) {
  return static_cast<int>(std::count_if(
      map.cells().begin(), map.cells().end(), [](LogOdds cell) { return cell != kUnknown; }));
}

TEST(ConeIntegratorTest, ASonarSeesAWall) {
  DenseMap map = dense_map();
  ConeIntegrator integrator(IntegrationConfig{});
  EXPECT_TRUE(integrator.integrate(sonar(3.0), Pose::Identity(), map));
  EXPECT_GT(map.at_point({3.02, 0.03, 0.1}), 1500);
  EXPECT_LT(map.at_point({1.5, 0.03, 0.1}), -500);
  EXPECT_EQ(map.at_point({4.5, 0.03, 0.1}), kUnknown) << "behind it";
  // Half way to the rim it counts by three quarters.
  const double angle_rad = 0.15;
  const Eigen::Vector3d aside(std::cos(angle_rad), std::sin(angle_rad), 0.0);
  EXPECT_GT(map.at_point(Eigen::Vector3d(0.02, 0.03, 0.1) + 3.0 * aside), 900);
  EXPECT_LT(map.at_point({3.02, 0.03, 0.1}) * 0.6,
            map.at_point(Eigen::Vector3d(0.02, 0.03, 0.1) + 3.0 * aside));
  EXPECT_EQ(map.at_point({2.0, 1.5, 0.1}), kUnknown) << "beside the cone";
  EXPECT_EQ(map.at_point({-0.5, 0.03, 0.1}), kUnknown) << "behind the sensor";
}

TEST(ConeIntegratorTest, NoEchoClears) {
  DenseMap map = dense_map();
  ConeIntegrator integrator(IntegrationConfig{});
  (void)integrator.integrate(sonar(3.0), Pose::Identity(), map);
  for (int i = 0; i < 10; ++i) {
    EXPECT_TRUE(integrator.integrate(sonar(std::nullopt), Pose::Identity(), map));
  }
  for_each_known_cell(map, map.bounds(), [](const Eigen::Vector3i& cell, LogOdds value) {
    EXPECT_LE(value, 0) << cell.transpose();
  });
  EXPECT_EQ(map.at_point({3.02, 0.03, 0.1}), -5000);
  EXPECT_LT(map.at_point({5.5, 0.03, 0.1}), -4000);
  EXPECT_EQ(map.at_point({6.3, 0.03, 0.1}), kUnknown) << "beyond what it hears";
}

TEST(ConeIntegratorTest, ANarrowBeamMarksTheCellAtItsEndAlone) {
  DenseMap map = dense_map();
  RangeMeasurement beam = sonar(3.08);  // ends in the middle of [3, 3.2)
  beam.T_body_sensor.translation() = Eigen::Vector3d(0.02, 0.13, 0.09);
  beam.half_angle_rad = 1e-4;
  beam.delta_z_m = 0.005;
  EXPECT_TRUE(ConeIntegrator(IntegrationConfig{}).integrate(beam, Pose::Identity(), map));
  int crossed = 0;
  for_each_known_cell(map, map.bounds(), [&](const Eigen::Vector3i& cell, LogOdds value) {
    EXPECT_EQ(cell.y(), 20);
    EXPECT_EQ(cell.z(), 10);
    EXPECT_EQ(value > 0, cell.x() == 20) << cell.transpose();
    crossed += value < 0 ? 1 : 0;
  });
  EXPECT_GT(map.at({20, 20, 10}), 1900);
  EXPECT_EQ(crossed, 15);  // from the tip's cell, x = 5, on
}

TEST(ConeIntegratorTest, APoseTakesTheConeToTheMap) {
  DenseMap map = dense_map();
  const Pose T_map_body = make_pose(
      Eigen::AngleAxisd(kHalfPi, Eigen::Vector3d::UnitZ()).toRotationMatrix(), {2.0, -3.0, 0.5});
  (void)ConeIntegrator(IntegrationConfig{}).integrate(sonar(3.0), T_map_body, map);
  // The sensor is at (1.97, -2.98, 0.6) and looks along the map's y.
  EXPECT_GT(map.at_point({1.97, 0.02, 0.6}), 1500);
  EXPECT_LT(map.at_point({1.97, -1.5, 0.6}), -500);
}

TEST(ConeIntegratorTest, ACellThatTheRangeTouchesIsHitWhereverItsMiddleIs) {
  // The middle of cell (4, 2, 2) is on the axis, 0.75 m behind the range; its corner is before it.
  SparseMap map({Eigen::Vector3d::Zero(), 1.0});
  const Eigen::Vector3d to_middle_m(4.0, 2.0, 2.0);
  RangeMeasurement measurement;
  measurement.T_body_sensor = make_pose(
      Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitX(), to_middle_m).toRotationMatrix(),
      Eigen::Vector3d::Constant(0.5));
  measurement.half_angle_rad = 0.02;
  measurement.range_m = to_middle_m.norm() - 0.75;
  measurement.delta_z_m = 0.001;
  EXPECT_TRUE(ConeIntegrator(IntegrationConfig{}).integrate(measurement, Pose::Identity(), map));
  EXPECT_GT(map.at({3, 2, 2}), 1900) << "it holds the end of the axis";
  EXPECT_GT(map.at({4, 2, 2}), 1900);
}

TEST(ConeIntegratorTest, ABrickMayHoldASingleMarkAndTheLimitHolds) {
  SparseMap map({Eigen::Vector3d::Zero(), 0.2});
  IntegrationConfig config;
  config.limit_units = 1000;
  ConeIntegrator integrator(config);
  for (int i = 0; i < 20; ++i) {
    (void)integrator.integrate(sonar(3.0), Pose::Identity(), map);
  }
  int at_limit = 0;
  for_each_known_cell(map, map.known_bounds(), [&](const Eigen::Vector3i&, LogOdds value) {
    EXPECT_LE(std::abs(int{value}), 1000);
    at_limit += std::abs(int{value}) == 1000 ? 1 : 0;
  });
  EXPECT_GT(at_limit, 50);
}

TEST(ConeIntegratorTest, InvalidInputChangesNothing) {
  DenseMap map = dense_map();
  ConeIntegrator integrator(IntegrationConfig{});
  for (const double bad : {0.0, -1.0, kNan, std::numeric_limits<double>::infinity()}) {
    RangeMeasurement measurement = sonar(bad);
    EXPECT_FALSE(integrator.integrate(measurement, Pose::Identity(), map));
    measurement = sonar(3.0);
    measurement.half_angle_rad = bad;
    EXPECT_FALSE(integrator.integrate(measurement, Pose::Identity(), map));
    measurement = sonar(3.0);
    measurement.delta_z_m = bad;
    EXPECT_FALSE(integrator.integrate(measurement, Pose::Identity(), map));
  }
  Pose nowhere = Pose::Identity();
  nowhere.translation().z() = kNan;
  (void)integrator.integrate(sonar(3.0), nowhere, map);
  EXPECT_EQ(count_known(map), 0);
  IntegrationConfig config;
  config.limit_units = 0;
  EXPECT_THROW(ConeIntegrator{config}, Error);
}

}  // namespace
}  // namespace skyhalo

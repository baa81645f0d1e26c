#include "skyhalo/map/integrate.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <random>

#include "reference/naive_occupancy_map.hpp"

namespace skyhalo {
namespace {

constexpr int kLimit = 5000;

/// 10 cells of 1 m along x, one along y and z.
DenseMap corridor() {
  return DenseMap(make_voxel_grid({Eigen::Vector3d::Zero(), Eigen::Vector3d(10.0, 1.0, 1.0)}, 1.0));
}

Ray along_corridor() {
  return {{0.0, 0.5, 0.5}, Eigen::Vector3d::UnitX()};
}

int count_known(const DenseMap& map) {
  return static_cast<int>(std::count_if(
      map.cells().begin(), map.cells().end(), [](LogOdds cell) { return cell != kUnknown; }));
}

TEST(IntegrateTest, ClearsTheWayMarksTheEndAndLeavesTheRest) {
  DenseMap map = corridor();
  integrate(along_corridor(), InverseSensorModel({}, 5.5, 0.01), kLimit, map);
  for (int x = 0; x < 5; ++x) {
    EXPECT_EQ(map.cells()[static_cast<std::size_t>(x)], -847);  // ln(0.3 / 0.7) = -0.8473
  }
  // a = 0.375 exp(-0.01) = 0.371269; ln(0.871269 / 0.128731) = 1.91220.
  EXPECT_EQ(map.cells()[5], 1912);
  for (std::size_t x = 6; x < 10; ++x) {
    EXPECT_EQ(map.cells()[x], kUnknown);
  }
}

TEST(IntegrateTest, ACellCountsByThePointOfItsChordNearestToTheMeasurement) {
  // z = 5.1 with delta_z = ln 1.5: a = 0.25. The cell [4, 5] counts at m = 5, [6, 7] at m = 6.
  const double delta_m = std::log(1.5);
  DenseMap map = corridor();
  integrate(along_corridor(), InverseSensorModel({}, 5.1, delta_m), kLimit, map);
  const double before = 0.3 + 0.45 * std::exp(-0.5 * std::pow(0.1 / delta_m, 2.0));
  EXPECT_NEAR(map.cells()[4], 1000.0 * std::log(before / (1.0 - before)), 0.51);
  EXPECT_NEAR(map.cells()[5], 1000.0 * std::log(3.0), 0.51);  // p = 0.75
  // c^2 = delta^2 ln(18/13) / ln 2 (eq. 6.6).
  const double c2 = delta_m * delta_m * std::log(18.0 / 13.0) / std::log(2.0);
  const double behind = 0.5 + 0.25 * std::exp(-0.5 * 0.9 * 0.9 / c2);
  EXPECT_NEAR(map.cells()[6], 1000.0 * std::log(behind / (1.0 - behind)), 0.51);
}

TEST(IntegrateTest, FreeSpaceCountsWithTheShareOfTheCellThatWasCrossed) {
  // Starting at x = 0.75 the ray crosses a quarter of the first cell: -847.3 / 4 = -211.8.
  DenseMap map = corridor();
  integrate({{0.75, 0.5, 0.5}, Eigen::Vector3d::UnitX()},
            InverseSensorModel({}, 4.75, 0.01),
            kLimit,
            map);
  EXPECT_EQ(map.cells()[0], -212);
  EXPECT_EQ(map.cells()[1], -847);
}

TEST(IntegrateTest, ALongerWayThroughACellCountsNoMoreThanItsEdge) {
  // Slanted, the ray runs 1.25 m through a cell of 1 m.
  DenseMap map(make_voxel_grid({Eigen::Vector3d::Zero(), Eigen::Vector3d(1.0, 10.0, 1.0)}, 1.0));
  integrate({{0.0, 0.1, 0.5}, {0.8, 0.6, 0.0}}, InverseSensorModel({}, 8.0, 0.01), kLimit, map);
  EXPECT_EQ(map.cells()[0], -847);
}

TEST(IntegrateTest, TheEndCountsInFullHoweverLittleOfTheCellIsCrossed) {
  // x = 0.5 at s = 0.0833, y = 0.5 at s = 0.1, where the map ends: a chord of 0.0167 m holds the
  // end.
  DenseMap map(make_voxel_grid({Eigen::Vector3d::Zero(), Eigen::Vector3d(1.0, 0.5, 0.5)}, 0.5));
  integrate(
      {{0.45, 0.42, 0.25}, {0.6, 0.8, 0.0}}, InverseSensorModel({}, 0.09, 0.001), kLimit, map);
  const double p = 0.5 + 0.375 * std::exp(-0.001);
  EXPECT_NEAR(map.at_point({0.51, 0.49, 0.25}), 1000.0 * std::log(p / (1.0 - p)), 0.51);
}

TEST(IntegrateTest, AnEndBeyondTheMapOnlyClears) {
  DenseMap map = corridor();
  integrate(along_corridor(), InverseSensorModel({}, 50.0, 0.1), kLimit, map);
  for (const LogOdds cell : map.cells()) {
    EXPECT_EQ(cell, -847);
  }
}

TEST(IntegrateTest, AnEndBeforeTheMapLeavesItAsItIs) {
  DenseMap map = corridor();
  integrate(
      {{-8.0, 0.5, 0.5}, Eigen::Vector3d::UnitX()}, InverseSensorModel({}, 5.0, 0.1), kLimit, map);
  EXPECT_EQ(count_known(map), 0);
}

TEST(IntegrateTest, ARayThatMissesLeavesTheMapAsItIs) {
  DenseMap map = corridor();
  integrate(
      {{0.0, 5.0, 0.5}, Eigen::Vector3d::UnitX()}, InverseSensorModel({}, 5.0, 0.1), kLimit, map);
  EXPECT_EQ(count_known(map), 0);
}

TEST(IntegrateTest, LogOddsStayWithinTheLimit) {
  DenseMap map = corridor();
  for (int i = 0; i < 20; ++i) {
    integrate(along_corridor(), InverseSensorModel({}, 5.5, 0.01), kLimit, map);
  }
  EXPECT_EQ(map.cells()[0], -5000);
  EXPECT_EQ(map.cells()[5], 5000);
  DenseMap narrow = corridor();
  integrate(along_corridor(), InverseSensorModel({}, 5.5, 0.01), 100, narrow);
  EXPECT_EQ(narrow.cells()[0], -100);
  EXPECT_EQ(narrow.cells()[5], 100);
}

TEST(IntegrateTest, AFarMeasurementMarksNothing) {
  // delta_z = 30 m: a is 0.375 e^-30; the cell of the end gets p = 0.5.
  DenseMap map = corridor();
  integrate(along_corridor(), InverseSensorModel({}, 5.5, 30.0), kLimit, map);
  EXPECT_EQ(map.cells()[5], 0);
  for (std::size_t x = 6; x < 10; ++x) {
    EXPECT_EQ(map.cells()[x], kUnknown);
  }
}

TEST(IntegrateTest, NothingIsSaidFarBehindTheEndWhateverUnknownIs) {
  // METHOD 5: beyond z the update ends where p is indistinguishable from p_unknown.
  for (const double p_unknown : {0.4, 0.5, 0.6}) {
    DenseMap map = corridor();
    const SensorModelConfig config{.p_unknown = p_unknown};
    integrate(along_corridor(), InverseSensorModel(config, 2.5, 0.05), kLimit, map);
    EXPECT_GT(map.cells()[2], 0) << p_unknown;
    for (std::size_t x = 4; x < 10; ++x) {
      EXPECT_EQ(map.cells()[x], kUnknown) << p_unknown << " at " << x;
    }
  }
}

TEST(IntegrateTest, ARayThatIsNotFiniteChangesNothing) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  const InverseSensorModel model({}, 5.5, 0.1);
  for (int axis = 0; axis < 3; ++axis) {
    DenseMap map = corridor();
    Ray ray = along_corridor();
    ray.origin_m[axis] = kNan;
    integrate(ray, model, kLimit, map);
    ray = along_corridor();
    ray.direction[axis] = kNan;
    integrate(ray, model, kLimit, map);
    EXPECT_EQ(count_known(map), 0) << "axis " << axis;
  }
}

/// One measurement for both maps.
struct Measurement {
  Ray ray;
  double z_m = 0.0;
  double delta_z_m = 0.0;
};

class RandomMeasurements {
 public:
  explicit RandomMeasurements(unsigned seed) : random_(seed) {}

  /// From inside and outside the box of 5 x 5 x 5 m, in any direction or along an axis or plane,
  /// ending before, in and beyond it, with uncertainties from 10 um to 100 m.
  Measurement next() {
    ++count_;
    Measurement result;
    const double reach_m = count_ % 3 == 0 ? 6.0 : 2.4;
    result.ray.origin_m = reach_m * Eigen::Vector3d(unit(), unit(), unit());
    // Towards the middle part of the box, so that most rays meet it.
    Eigen::Vector3d direction = 2.0 * Eigen::Vector3d(unit(), unit(), unit()) - result.ray.origin_m;
    if (count_ % 4 == 0) {
      direction[count_ % 3] = 0.0;
    }
    if (count_ % 5 == 0) {
      direction = (unit() < 0.0 ? -1.0 : 1.0) * Eigen::Vector3d::Unit(count_ / 5 % 3);
    }
    result.ray.direction = direction.normalized();
    result.z_m = std::pow(10.0, -1.0 + 1.3 * (1.0 + unit()));  // 0.1 m to 40 m
    result.delta_z_m = std::pow(10.0, -1.5 + 3.5 * unit());    // 10 um to 100 m
    return result;
  }

 private:
  double unit() { return std::uniform_real_distribution<double>(-1.0, 1.0)(random_); }

  std::mt19937 random_;
  int count_ = 0;
};

reference::NaiveMap naive_copy(const DenseMap& map) {
  const VoxelGrid& grid = map.grid();
  reference::NaiveMap naive =
      reference::naive_empty_map({{grid.min_m.x(), grid.min_m.y(), grid.min_m.z()},
                                  grid.voxel_m,
                                  {grid.size.x(), grid.size.y(), grid.size.z()}});
  for (std::size_t i = 0; i < naive.log_odds_units.size(); ++i) {
    naive.observed[i] = map.cells()[i] != kUnknown;
    naive.log_odds_units[i] = naive.observed[i] ? map.cells()[i] : 0;
  }
  return naive;
}

/// Cells that differ by more than a rounding tie, in being known or in their log odds.
int count_different(const DenseMap& map, const reference::NaiveMap& expected) {
  int different = 0;
  for (std::size_t i = 0; i < expected.log_odds_units.size(); ++i) {
    const bool is_known = map.cells()[i] != kUnknown;
    const int units = is_known ? map.cells()[i] : 0;
    const bool is_same =
        is_known == expected.observed[i] && std::abs(units - expected.log_odds_units[i]) <= 1;
    different += is_same ? 0 : 1;
  }
  return different;
}

/// Enters measurement after measurement into one map and compares the change of each.
void compare_on_random_rays(const SensorModelConfig& config, unsigned seed) {
  DenseMap map(
      make_voxel_grid({Eigen::Vector3d::Constant(-2.5), Eigen::Vector3d::Constant(2.5)}, 0.25));
  const reference::NaiveSensorModel naive_model{config.k, config.p_unknown, config.p_free};
  RandomMeasurements measurements(seed);
  int changed = 0;
  for (int i = 0; i < 700; ++i) {
    const Measurement m = measurements.next();
    reference::NaiveMap expected = naive_copy(map);
    const reference::NaiveRay naive_ray{
        {m.ray.origin_m.x(), m.ray.origin_m.y(), m.ray.origin_m.z()},
        {m.ray.direction.x(), m.ray.direction.y(), m.ray.direction.z()},
        m.z_m,
        m.delta_z_m};
    const int known_before = count_known(map);
    reference::naive_integrate(expected, naive_ray, naive_model, 5.0);
    integrate(m.ray, InverseSensorModel(config, m.z_m, m.delta_z_m), kLimit, map);
    EXPECT_EQ(count_different(map, expected), 0)
        << "ray " << i << " from " << m.ray.origin_m.transpose() << " along "
        << m.ray.direction.transpose() << " z " << m.z_m << " delta_z " << m.delta_z_m;
    changed += count_known(map) != known_before ? 1 : 0;
  }
  EXPECT_GT(changed, 100);
}

TEST(IntegrateReference, AgreesOnRandomRays) {
  compare_on_random_rays({}, 66);
  compare_on_random_rays({}, 67);
}

TEST(IntegrateReference, AgreesWithOtherSettings) {
  compare_on_random_rays({.k = 0.95, .p_unknown = 0.5, .p_free = 0.4}, 68);
  compare_on_random_rays({.k = 0.3, .p_unknown = 0.5, .p_free = 0.05}, 69);
}

}  // namespace
}  // namespace skyhalo

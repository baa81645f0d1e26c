#include "skyhalo/sphere/spherical_grid.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include "reference/naive_spherical_grid.hpp"
#include "skyhalo/geometry/angle.hpp"
#include "skyhalo/geometry/spherical.hpp"
#include "support/expect_error.hpp"

namespace skyhalo {
namespace {

constexpr GridCell kAhead{25, 25};  // of the thesis grid: theta 90...92, phi 0...2 deg

SphericalGrid thesis_grid(const DepthRule& rule = {.kind = DepthRuleKind::kThesis}) {
  return SphericalGrid(make_grid_geometry({.theta_min_rad = rad_from_deg(40.0),
                                           .theta_max_rad = rad_from_deg(140.0),
                                           .phi_min_rad = rad_from_deg(-50.0),
                                           .phi_max_rad = rad_from_deg(50.0),
                                           .step_rad = rad_from_deg(2.0)}),
                       rule);
}

/// A point in the cell ahead at this distance.
Eigen::Vector3d ahead(double range_m) {
  return range_m * direction(rad_from_deg(91.0), rad_from_deg(1.0));
}

TEST(SphericalGridTest, ACellGathersItsRanges) {
  SphericalGrid grid = thesis_grid();
  grid.add(ahead(2.0));
  grid.add(ahead(4.0));
  grid.add(ahead(4.0));
  grid.add(ahead(6.0));
  const std::optional<CellStatistics> cell = grid.statistics(kAhead);
  ASSERT_TRUE(cell.has_value());
  EXPECT_EQ(cell->count, 4);
  EXPECT_NEAR(cell->mean_m, 4.0, 1e-12);
  EXPECT_NEAR(cell->sigma_m, std::numbers::sqrt2, 1e-12);  // sqrt((4 + 0 + 0 + 4) / 4)
  EXPECT_NEAR(cell->min_m, 2.0, 1e-12);
  EXPECT_EQ(grid.occupied_cell_count(), 1);
}

TEST(SphericalGridTest, CellsKeepTheirPointsApart) {
  SphericalGrid grid = thesis_grid();
  grid.add(ahead(3.0));
  grid.add(7.0 * direction(rad_from_deg(41.0), rad_from_deg(-49.0)));
  EXPECT_NEAR(grid.statistics(kAhead)->mean_m, 3.0, 1e-12);
  EXPECT_NEAR(grid.statistics({0, 0})->mean_m, 7.0, 1e-12);
  EXPECT_FALSE(grid.statistics({25, 24}).has_value());
  EXPECT_EQ(grid.occupied_cell_count(), 2);
}

TEST(SphericalGridTest, ACellWithoutPointsHasNoDepth) {
  const SphericalGrid grid = thesis_grid();
  EXPECT_FALSE(grid.statistics(kAhead).has_value());
  EXPECT_FALSE(grid.depth_m(kAhead).has_value());
  EXPECT_EQ(grid.occupied_cell_count(), 0);
}

/// The depth of the cell ahead with points at these ranges; NaN for none.
double depth_of(const DepthRule& rule, const std::vector<double>& ranges_m) {
  SphericalGrid grid = thesis_grid(rule);
  for (const double range_m : ranges_m) {
    grid.add(ahead(range_m));
  }
  return grid.depth_m(kAhead).value_or(std::numeric_limits<double>::quiet_NaN());
}

/// The thesis's rule, with the parts that a test asks for.
DepthRule thesis_rule(double threshold_m, double factor, double floor_m = 0.0) {
  return {.kind = DepthRuleKind::kThesis,
          .sigma_threshold_m = threshold_m,
          .sigma_factor = factor,
          .min_range_m = floor_m};
}

TEST(DepthRuleTest, ASurfaceLiesThreeDeviationsBeforeItsMean) {
  // mu 10, sigma 0.1 < 0.5: 10 - 3 * 0.1, although nothing is nearer than 9.9.
  EXPECT_NEAR(depth_of({.kind = DepthRuleKind::kThesis}, {9.9, 10.1}), 9.7, 1e-9);
  EXPECT_NEAR(depth_of(thesis_rule(0.5, 1.0), {9.9, 10.1}), 9.9, 1e-9);
  EXPECT_NEAR(depth_of(thesis_rule(0.5, 0.0), {9.9, 10.1}), 10.0, 1e-9);
}

TEST(DepthRuleTest, SeveralSurfacesGiveTheNearest) {
  // mu 9, sigma sqrt((16 + 1 + 9) / 3) = 2.94 > 0.5.
  EXPECT_NEAR(depth_of({.kind = DepthRuleKind::kThesis}, {5.0, 10.0, 12.0}), 5.0, 1e-12);
}

TEST(DepthRuleTest, TheThresholdDecides) {
  // mu 10, sigma 1
  EXPECT_NEAR(depth_of(thesis_rule(1.01, 3.0), {9.0, 11.0}), 7.0, 1e-9);
  EXPECT_NEAR(depth_of(thesis_rule(0.99, 3.0), {9.0, 11.0}), 9.0, 1e-12);
  // Nothing is below a threshold of zero.
  EXPECT_NEAR(depth_of(thesis_rule(0.0, 3.0), {4.0}), 4.0, 1e-12);
}

TEST(DepthRuleTest, NoDepthIsBelowTheSmallestRange) {
  EXPECT_NEAR(depth_of(thesis_rule(0.5, 3.0, 9.8), {9.9, 10.1}), 9.8, 1e-12);
  EXPECT_NEAR(depth_of(thesis_rule(0.5, 3.0, 9.6), {9.9, 10.1}), 9.7, 1e-9);
  // The other branch: the minimum is 9.9.
  EXPECT_NEAR(depth_of(thesis_rule(0.01, 3.0, 9.95), {9.9, 10.1}), 9.95, 1e-12);
  EXPECT_NEAR(
      depth_of({.kind = DepthRuleKind::kMean, .min_range_m = 11.0}, {9.0, 10.0}), 11.0, 0.0);
}

TEST(DepthRuleTest, TheMeanIsTheMean) {
  EXPECT_NEAR(depth_of({.kind = DepthRuleKind::kMean}, {2.0, 4.0, 12.0}), 6.0, 1e-12);
}

TEST(DepthRuleTest, TheNearestIsBorneOutByItsPoints) {
  const auto nearest = [](int count, const std::vector<double>& ranges_m) {
    return depth_of({.kind = DepthRuleKind::kNearest, .nearest_count = count}, ranges_m);
  };
  const std::vector<double> ranges_m{7.0, 3.0, 9.0, 3.5, 8.0, 1.0, 5.0, 6.0, 2.0};
  EXPECT_NEAR(nearest(1, ranges_m), 1.0, 1e-12);
  EXPECT_NEAR(nearest(3, ranges_m), 3.0, 1e-12);
  EXPECT_NEAR(nearest(8, ranges_m), 8.0, 1e-12);
  EXPECT_NEAR(nearest(2, {4.0, 4.0}), 4.0, 1e-12);
  EXPECT_TRUE(std::isnan(nearest(3, {4.0, 4.0})));  // too few points: no depth
}

TEST(DepthRuleTest, TheQuantileLiesInItsClass) {
  const auto quantile = [](double share, const std::vector<double>& ranges_m) {
    return depth_of({.kind = DepthRuleKind::kQuantile, .quantile = share}, ranges_m);
  };
  // Between 8 and 16 m a class is half a metre: ten points in [8, 8.5), ten in [12, 12.5).
  std::vector<double> ranges_m(10, 8.1);
  ranges_m.insert(ranges_m.end(), 10, 12.2);
  EXPECT_NEAR(quantile(0.25, ranges_m), 8.25, 1e-12);  // half of the first class
  EXPECT_NEAR(quantile(0.5, ranges_m), 8.5, 1e-12);
  EXPECT_NEAR(quantile(0.75, ranges_m), 12.25, 1e-12);
  EXPECT_NEAR(quantile(0.0, ranges_m), 8.1, 1e-12);          // never below the nearest point
  EXPECT_NEAR(quantile(1.0, {0.01, 1000.0}), 256.0, 1e-12);  // beyond the classes
}

TEST(DepthRuleTest, RefusesWhatIsOutsideItsDomain) {
  const auto refusal = [](const DepthRule& rule) {
    return testing::message_of([&] { check(rule, "sphere"); });
  };
  EXPECT_THAT(refusal({.nearest_count = 0}), ::testing::HasSubstr("sphere.nearest_count"));
  EXPECT_THAT(refusal({.nearest_count = 9}), ::testing::HasSubstr("sphere.nearest_count"));
  EXPECT_THAT(refusal({.quantile = 1.01}), ::testing::HasSubstr("sphere.quantile"));
  EXPECT_THAT(refusal({.quantile = -0.01}), ::testing::HasSubstr("sphere.quantile"));
  EXPECT_THAT(refusal({.sigma_factor = -1.0}), ::testing::HasSubstr("sphere.sigma_factor"));
  EXPECT_THAT(refusal({.min_range_m = -1.0}), ::testing::HasSubstr("sphere.min_range_m"));
  EXPECT_NO_THROW(check(DepthRule{}, "sphere"));
}

TEST(SphericalGridTest, EqualRangesHaveNoDeviation) {
  SphericalGrid grid = thesis_grid();
  for (int i = 0; i < 1000; ++i) {
    grid.add(ahead(0.1));
  }
  const std::optional<CellStatistics> cell = grid.statistics(kAhead);
  EXPECT_EQ(cell->count, 1000);
  EXPECT_GE(cell->sigma_m, 0.0);
  EXPECT_LT(cell->sigma_m, 1e-6);
}

TEST(SphericalGridTest, IgnoresWhatHasNoPlaceInIt) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  constexpr double kInf = std::numeric_limits<double>::infinity();
  SphericalGrid grid(make_grid_geometry({.theta_min_rad = 0.0,
                                         .theta_max_rad = std::numbers::pi,
                                         .phi_min_rad = -std::numbers::pi,
                                         .phi_max_rad = std::numbers::pi,
                                         .step_rad = std::numbers::pi / 18.0}));
  grid.add(Eigen::Vector3d::Zero());
  grid.add({kNan, 1.0, 1.0});
  grid.add({1.0, 1.0, kNan});
  grid.add({kInf, 0.0, 0.0});
  grid.add({0.0, -kInf, kInf});
  EXPECT_EQ(grid.occupied_cell_count(), 0);
  SphericalGrid front = thesis_grid();
  front.add({-5.0, 0.0, 0.0});
  front.add({0.0, 0.0, 5.0});
  EXPECT_EQ(front.occupied_cell_count(), 0);
}

TEST(SphericalGridTest, ClearForgetsAllPoints) {
  SphericalGrid grid = thesis_grid();
  grid.add(ahead(1.0));
  grid.clear();
  EXPECT_EQ(grid.occupied_cell_count(), 0);
  EXPECT_FALSE(grid.statistics(kAhead).has_value());
  grid.add(ahead(5.0));
  EXPECT_EQ(grid.statistics(kAhead)->count, 1);
  EXPECT_NEAR(grid.statistics(kAhead)->min_m, 5.0, 1e-12);
}

/// True when the direction is so near to a bound of a cell that rounding may decide.
bool is_near_bound(const SphericalPoint& point, const reference::NaiveGridSpec& spec) {
  const double row = (point.theta_rad - spec.theta_min_rad) / spec.step_rad;
  const double col = (point.phi_rad - spec.phi_min_rad) / spec.step_rad;
  return std::abs(row - std::round(row)) < 1e-7 || std::abs(col - std::round(col)) < 1e-7;
}

/// Statistics within rounding; the deviation comes from sums of squares and has half the digits.
bool is_same(const CellStatistics& cell, const reference::NaiveCell& expected) {
  return cell.count == expected.n && std::abs(cell.mean_m - expected.mean_m) < 1e-10 &&
         std::abs(cell.min_m - expected.min_m) < 1e-12 &&
         std::abs(cell.sigma_m - expected.sigma_m) < 1e-5;
}

/// Depths within rounding; on the threshold rounding decides which of the two it is.
bool is_same_depth(double depth_m, const DepthRule& rule, const reference::NaiveCell& expected) {
  return std::abs(expected.sigma_m - rule.sigma_threshold_m) < 1e-5 ||
         std::abs(depth_m - expected.depth_m) < 3e-5;
}

void expect_same_cell(const SphericalGrid& grid,
                      GridCell at,
                      const DepthRule& rule,
                      const reference::NaiveCell& expected) {
  const std::optional<CellStatistics> cell = grid.statistics(at);
  const std::optional<double> depth_m = grid.depth_m(at);
  ASSERT_EQ(cell.has_value(), expected.n > 0);
  ASSERT_EQ(depth_m.has_value(), expected.n > 0);
  EXPECT_TRUE(!cell || is_same(*cell, expected));
  EXPECT_TRUE(!depth_m || is_same_depth(*depth_m, rule, expected));
}

/// Points in clusters over the whole sphere whose ranges spread by 0.1, 1 or 10 m, so that both
/// branches of the depth rule are met.
std::vector<Eigen::Vector3d> random_points(const reference::NaiveGridSpec& spec, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> spread_rad(-0.05, 0.05);
  std::normal_distribution<double> coordinate(0.0, 1.0);
  std::uniform_real_distribution<double> range_m(0.3, 30.0);
  std::vector<Eigen::Vector3d> points;
  for (int cluster = 0; cluster < 600; ++cluster) {
    const SphericalPoint center =
        to_spherical({coordinate(random), coordinate(random), coordinate(random)});
    const double center_m = range_m(random);
    const double spread_m = std::pow(10.0, cluster % 3 - 1);
    for (int i = 0; i < 12; ++i) {
      const Eigen::Vector3d p_m =
          (center_m + spread_m * (1.0 + 20.0 * spread_rad(random))) *
          direction(center.theta_rad + spread_rad(random), center.phi_rad + spread_rad(random));
      if (!is_near_bound(to_spherical(p_m), spec)) {
        points.push_back(p_m);
      }
    }
  }
  return points;
}

void compare_on_random_points(const reference::NaiveGridSpec& spec, unsigned seed) {
  const DepthRule rule{.kind = DepthRuleKind::kThesis,
                       .sigma_threshold_m = 0.5,
                       .sigma_factor = 3.0,
                       .min_range_m = 1.5};
  SphericalGrid grid(make_grid_geometry({spec.theta_min_rad,
                                         spec.theta_max_rad,
                                         spec.phi_min_rad,
                                         spec.phi_max_rad,
                                         spec.step_rad}),
                     rule);
  std::vector<std::array<double, 3>> points;
  for (const Eigen::Vector3d& p_m : random_points(spec, seed)) {
    grid.add(p_m);
    points.push_back({p_m.x(), p_m.y(), p_m.z()});
  }
  const std::vector<reference::NaiveCell> expected =
      reference::naive_spherical_grid(spec, points, rule.sigma_threshold_m, rule.min_range_m);
  const GridGeometry& geometry = grid.geometry();
  ASSERT_EQ(expected.size(), static_cast<std::size_t>(geometry.cell_count()));
  for (int i = 0; i < geometry.cell_count(); ++i) {
    const GridCell cell{i / geometry.cols, i % geometry.cols};
    expect_same_cell(grid, cell, rule, expected[static_cast<std::size_t>(i)]);
  }
  EXPECT_GT(grid.occupied_cell_count(), 100);
}

TEST(SphericalGridReference, AgreesOnTheThesisGrid) {
  compare_on_random_points({.theta_min_rad = rad_from_deg(40.0),
                            .theta_max_rad = rad_from_deg(140.0),
                            .phi_min_rad = rad_from_deg(-50.0),
                            .phi_max_rad = rad_from_deg(50.0),
                            .step_rad = rad_from_deg(2.0)},
                           41);
}

TEST(SphericalGridReference, AgreesOnTheWholeSphere) {
  compare_on_random_points({.theta_min_rad = 0.0,
                            .theta_max_rad = std::numbers::pi,
                            .phi_min_rad = -std::numbers::pi,
                            .phi_max_rad = std::numbers::pi,
                            .step_rad = rad_from_deg(6.0)},
                           42);
}

}  // namespace
}  // namespace skyhalo

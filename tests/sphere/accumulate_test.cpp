#include "skyhalo/sphere/accumulate.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <opencv2/core.hpp>
#include <random>
#include <vector>

#include "reference/naive_pinhole.hpp"
#include "reference/naive_spherical_grid.hpp"
#include "skyhalo/geometry/angle.hpp"
#include "support/cell_border.hpp"
#include "support/expect_error.hpp"
#include "support/instruction_set.hpp"

namespace skyhalo {
namespace {

using testing::is_near_border;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

/// A camera in the body origin that looks forward: its x is the body's right, its y down.
Pose forward_camera() {
  Eigen::Matrix3d R_body_camera;
  R_body_camera << 0, 0, 1,  //
      -1, 0, 0,              //
      0, -1, 0;
  return make_pose(R_body_camera, Eigen::Vector3d::Zero());
}

/// 100 x 80 pixels, f 100 px, baseline 0.5 m: disparity 10 is 5 m away.
PairGeometry example_pair() {
  return {.model = PinholePair{.focal_px = 100.0,
                               .principal_u_px = 49.5,
                               .principal_v_px = 39.5,
                               .baseline_m = 0.5,
                               .disparity_offset_px = 0.0},
          .T_body_camera = forward_camera(),
          .max_range_m = 30.0};
}

cv::Mat1f plain_disparity(float value) {
  // Not a braced list: that would be three values.
  return cv::Mat1f(80, 100, value);
}

SphericalGrid thesis_grid() {
  return SphericalGrid(make_grid_geometry({.theta_min_rad = rad_from_deg(40.0),
                                           .theta_max_rad = rad_from_deg(140.0),
                                           .phi_min_rad = rad_from_deg(-50.0),
                                           .phi_max_rad = rad_from_deg(50.0),
                                           .step_rad = rad_from_deg(2.0)}));
}

/// True when the ranges of a cell are those at which it can see the plane x = 5 m, which are
/// 5 / (sin(theta) cos(phi)).
bool is_on_plane(const CellStatistics& cell, const GridGeometry& grid, GridCell at) {
  const double theta = grid.theta_min_rad + at.row * grid.theta_step_rad;
  const double phi = grid.phi_min_rad + at.col * grid.phi_step_rad;
  double nearest_m = std::numeric_limits<double>::infinity();
  double farthest_m = 0.0;
  for (const double t : {theta, theta + grid.theta_step_rad}) {
    for (const double p : {phi, phi + grid.phi_step_rad}) {
      const double range_m = 5.0 / (std::sin(t) * std::cos(p));
      nearest_m = std::min(nearest_m, range_m);
      farthest_m = std::max(farthest_m, range_m);
    }
  }
  return cell.min_m >= nearest_m - 1e-5 && cell.mean_m <= farthest_m + 1e-5;
}

TEST(AccumulateTest, APlaneLiesInEveryCellThatSeesIt) {
  SphericalGrid grid = thesis_grid();
  (void)accumulate(plain_disparity(10.0F), example_pair(), grid);
  int points = 0;
  for (int i = 0; i < 2500; ++i) {
    const GridCell at{i / 50, i % 50};
    const std::optional<CellStatistics> cell = grid.statistics(at);
    EXPECT_TRUE(!cell || is_on_plane(*cell, grid.geometry(), at)) << at.row << ", " << at.col;
    points += cell ? cell->count : 0;
  }
  // The view is 26 deg to either side, 21 up and down: nothing is lost.
  EXPECT_EQ(points, 8000);
}

TEST(AccumulateTest, CountsThePixels) {
  SphericalGrid grid = thesis_grid();
  const PixelCounts counts = accumulate(plain_disparity(10.0F), example_pair(), grid);
  EXPECT_EQ(counts.measured, 8000);
  EXPECT_EQ(counts.used, 8000);
}

TEST(AccumulateTest, LooksWhereTheCameraLooks) {
  // Pixel (79, 9) sees x = 29.5 * 0.05 = 1.475 m right, y = -30.5 * 0.05: 1.525 m up, 5 m ahead.
  cv::Mat1f disparity = plain_disparity(kNan);
  disparity(9, 79) = 10.0F;
  SphericalGrid grid = thesis_grid();
  const PixelCounts counts = accumulate(disparity, example_pair(), grid);
  EXPECT_EQ(counts.measured, 1);
  EXPECT_EQ(counts.used, 1);
  // phi = -atan(1.475 / 5) = -16.4 deg, column (50 - 16.4) / 2; theta = 90 - atan(1.525 / 5.213)
  // = 73.7 deg, row (73.7 - 40) / 2.
  const std::optional<CellStatistics> cell = grid.statistics({16, 16});
  ASSERT_TRUE(cell.has_value());
  EXPECT_NEAR(cell->mean_m, std::sqrt(25.0 + 1.475 * 1.475 + 1.525 * 1.525), 1e-5);
}

TEST(AccumulateTest, CountsFromTheBodyOrigin) {
  // The camera sits 1 m ahead of the body's origin: the plane is 6 m away.
  PairGeometry pair = example_pair();
  pair.T_body_camera.translation() = Eigen::Vector3d(1.0, 0.0, 0.0);
  std::get<PinholePair>(pair.model).principal_u_px = 50.0;
  std::get<PinholePair>(pair.model).principal_v_px = 40.0;
  cv::Mat1f disparity = plain_disparity(kNan);
  disparity(41, 49) = 10.0F;  // slightly left and below
  SphericalGrid grid = thesis_grid();
  (void)accumulate(disparity, pair, grid);
  const std::optional<CellStatistics> cell = grid.statistics({25, 25});
  ASSERT_TRUE(cell.has_value());
  EXPECT_NEAR(cell->mean_m, std::sqrt(36.0 + 2.0 * 0.05 * 0.05), 1e-5);
}

TEST(AccumulateTest, IgnoresPixelsWithoutADisparity) {
  constexpr float kInf = std::numeric_limits<float>::infinity();
  for (const float value : {kNan, -1e-6F, -1.0F, -1000.0F, -kInf, kInf}) {
    SphericalGrid grid = thesis_grid();
    const PixelCounts counts = accumulate(plain_disparity(value), example_pair(), grid);
    EXPECT_EQ(counts.measured, 0) << value;
    EXPECT_EQ(counts.used, 0) << value;
    EXPECT_EQ(grid.occupied_cell_count(), 0) << value;
    EXPECT_EQ(grid.looks({25, 25}).valid, 0) << value;
    EXPECT_GT(grid.looks({25, 25}).invalid, 0) << value;
    EXPECT_TRUE(std::isnan(grid.depths_m()[1275])) << value;
    EXPECT_EQ(grid.free_to_m()[1275], 0.0F) << value;
  }
}

TEST(AccumulateTest, NoDisparityAtAllIsFarAway) {
  SphericalGrid grid = thesis_grid();
  const PixelCounts counts = accumulate(plain_disparity(0.0F), example_pair(), grid);
  EXPECT_EQ(counts.measured, 8000);
  EXPECT_EQ(counts.used, 0);
  EXPECT_EQ(grid.occupied_cell_count(), 0);
  EXPECT_FLOAT_EQ(grid.free_to_m()[1275], 30.0F);  // as far as the limit
}

TEST(AccumulateTest, TheOffsetDecidesWhatIsADisparity) {
  PairGeometry pair = example_pair();
  std::get<PinholePair>(pair.model).disparity_offset_px = 4.0;
  SphericalGrid grid = thesis_grid();
  EXPECT_EQ(accumulate(plain_disparity(-4.5F), pair, grid).measured, 0);
  EXPECT_EQ(accumulate(plain_disparity(6.0F), pair, grid).used, 8000);
  // The middle of the image: 100 * 0.5 / (6 + 4) = 5 m.
  EXPECT_NEAR(grid.statistics({25, 25})->min_m, 5.0, 0.01);
}

TEST(AccumulateTest, LeavesOutWhatIsTooFar) {
  // 100 * 0.5 / d: 1.25 px is 40 m, 2 px is 25 m.
  cv::Mat1f disparity = plain_disparity(kNan);
  disparity(40, 50) = 1.25F;
  disparity(40, 51) = 2.0F;
  disparity(40, 52) = 1e-30F;
  SphericalGrid grid = thesis_grid();
  const PixelCounts counts = accumulate(disparity, example_pair(), grid);
  EXPECT_EQ(counts.measured, 3);
  EXPECT_EQ(counts.used, 1);
  EXPECT_EQ(grid.occupied_cell_count(), 1);
}

TEST(AccumulateTest, TheRangeIsMeasuredFromTheCamera) {
  // The plane 5 m ahead of a camera that sits 28 m before the body's origin.
  PairGeometry pair = example_pair();
  pair.T_body_camera.translation() = Eigen::Vector3d(28.0, 0.0, 0.0);
  SphericalGrid grid = thesis_grid();
  EXPECT_EQ(accumulate(plain_disparity(10.0F), pair, grid).used, 8000);
  EXPECT_GT(grid.occupied_cell_count(), 0);
}

TEST(AccumulateTest, TheLimitIsOnTheRangeNotTheDepth) {
  // 5 |(x, y, 100)| / 100 <= 5.1: x^2 + y^2 <= 100^2 (1.02^2 - 1) = 404, x and y from the middle.
  int expected = 0;
  for (int v = 0; v < 80; ++v) {
    for (int u = 0; u < 100; ++u) {
      expected += (u - 49.5) * (u - 49.5) + (v - 39.5) * (v - 39.5) <= 404.0 ? 1 : 0;
    }
  }
  PairGeometry pair = example_pair();
  pair.max_range_m = 5.1;
  SphericalGrid grid = thesis_grid();
  const PixelCounts counts = accumulate(plain_disparity(10.0F), pair, grid);
  EXPECT_EQ(counts.measured, 8000);
  EXPECT_EQ(counts.used, expected);
}

TEST(AccumulateTest, PointsOutsideTheGridCountAsUsed) {
  // A camera that looks backwards: the front grid gets nothing.
  PairGeometry pair = example_pair();
  pair.T_body_camera =
      Pose(Eigen::AngleAxisd(rad_from_deg(180.0), Eigen::Vector3d::UnitZ())) * forward_camera();
  SphericalGrid grid = thesis_grid();
  EXPECT_EQ(accumulate(plain_disparity(10.0F), pair, grid).used, 8000);
  EXPECT_EQ(grid.occupied_cell_count(), 0);
}

TEST(AccumulateTest, AddsToWhatTheGridHolds) {
  SphericalGrid grid = thesis_grid();
  cv::Mat1f disparity = plain_disparity(kNan);
  disparity(41, 48) = 10.0F;
  (void)accumulate(disparity, example_pair(), grid);
  (void)accumulate(disparity, example_pair(), grid);
  EXPECT_EQ(grid.statistics({25, 25})->count, 2);
}

/// Straight down, where azimuths are of (0, 0) with either sign.
TEST(AccumulateTest, APointOnTheVerticalIsInALastRow) {
  for (const double zero : {0.0, -0.0}) {
    Eigen::Matrix3d R_body_camera;
    R_body_camera << 1, 0, 0, 0, -1, 0, 0, 0, -1;
    PairGeometry pair{
        .model =
            PinholePair{
                .focal_px = 10.0, .principal_u_px = 2.0, .principal_v_px = 2.0, .baseline_m = 0.2},
        .T_body_camera = make_pose(R_body_camera, {zero, zero, zero}),
        .max_range_m = 30.0};
    for (const std::int64_t target : testing::InstructionSet::all()) {
      const testing::InstructionSet in_use(target);
      SphericalGrid grid(whole_sphere(rad_from_deg(2.0)));
      EXPECT_EQ(accumulate(cv::Mat1f(5, 5, 1.0F), pair, grid).used, 25);
      int points = 0;
      for (int i = 0; i < grid.geometry().cell_count(); ++i) {
        const auto cell = grid.statistics({i / 180, i % 180});
        points += cell ? cell->count : 0;
      }
      EXPECT_EQ(points, 25) << target;
    }
  }
}

TEST(AccumulateTest, RefusesAGridThatIsNotItsOwn) {
  const GridGeometry geometry = whole_sphere(rad_from_deg(6.0));
  Accumulator accumulator(
      example_pair(), cv::Size(100, 80), geometry, {.kind = DepthRuleKind::kMean});
  SphericalGrid other_step(whole_sphere(rad_from_deg(3.0)), {.kind = DepthRuleKind::kMean});
  SphericalGrid other_rule(geometry);
  SphericalGrid own(geometry, {.kind = DepthRuleKind::kMean});
  const cv::Mat1f disparity = plain_disparity(10.0F);
  for (SphericalGrid* const grid : {&other_step, &other_rule}) {
    EXPECT_THAT(testing::message_of([&] { (void)accumulator.accumulate(disparity, *grid); }),
                ::testing::HasSubstr("geometry and depth rule"));
  }
  EXPECT_THAT(testing::message_of([&] { (void)accumulator.accumulate(cv::Mat1f(3, 3), own); }),
              ::testing::HasSubstr("expected 100x80 px"));
  EXPECT_THAT(testing::message_of([&] {
                Accumulator(example_pair(), cv::Size(9, 9), geometry, {.nearest_count = 0});
              }),
              ::testing::HasSubstr("nearest_count"));
  EXPECT_THAT(testing::message_of([&] {
                Accumulator(example_pair(), cv::Size(9, 9), geometry, {}, {.near_m = 0.0});
              }),
              ::testing::HasSubstr("near_m"));
  EXPECT_EQ(accumulator.accumulate(disparity, own).used, 8000);
}

/// All that a grid says, bit for bit.
std::vector<std::uint32_t> bits_of(const SphericalGrid& grid) {
  std::vector<std::uint32_t> bits;
  for (const auto& numbers : {grid.depths_m(), grid.free_to_m()}) {
    for (const float number : numbers) {
      bits.push_back(std::bit_cast<std::uint32_t>(number));
    }
  }
  return bits;
}

TEST(AccumulateProperty, OneTwoAndFourThreadsGiveTheSameBits) {
  std::mt19937 random(44);
  std::uniform_real_distribution<float> unit(0.0F, 1.0F);
  cv::Mat1f disparity(80, 100);
  for (float& value : disparity) {
    value = unit(random) < 0.2F ? kNan : 2.0F + 20.0F * unit(random);
  }
  for (const auto kind : {DepthRuleKind::kThesis,
                          DepthRuleKind::kMean,
                          DepthRuleKind::kNearest,
                          DepthRuleKind::kQuantile}) {
    std::vector<std::vector<std::uint32_t>> bits;
    for (const std::size_t threads : {1U, 2U, 4U}) {
      const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
      SphericalGrid grid(whole_sphere(rad_from_deg(3.0)), {.kind = kind});
      (void)accumulate(disparity, example_pair(), grid);
      bits.push_back(bits_of(grid));
      EXPECT_GT(grid.occupied_cell_count(), 100);
    }
    EXPECT_EQ(bits[0], bits[1]);
    EXPECT_EQ(bits[0], bits[2]);
  }
}

TEST(AccumulateTest, AnEmptyImageHasNoPixels) {
  SphericalGrid grid = thesis_grid();
  EXPECT_EQ(accumulate(cv::Mat1f(), example_pair(), grid).measured, 0);
}

struct Scene {
  cv::Mat1f disparity;
  PairGeometry pair;
};

PinholePair& pinhole(PairGeometry& pair) {
  return std::get<PinholePair>(pair.model);
}

Scene random_scene(std::mt19937& random) {
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  Scene scene{cv::Mat1f(40, 60), example_pair()};
  pinhole(scene.pair).focal_px = 20.0 + 60.0 * unit(random);
  pinhole(scene.pair).principal_u_px = 60.0 * unit(random);
  pinhole(scene.pair).principal_v_px = 40.0 * unit(random);
  const Eigen::Vector3d axis = Eigen::Vector3d(unit(random), unit(random), 0.1).normalized();
  scene.pair.T_body_camera =
      make_pose((Eigen::AngleAxisd(0.5 * unit(random), axis) * forward_camera().linear()).eval(),
                {unit(random), unit(random), unit(random)});
  const double base_px = 1.0 + 10.0 * unit(random);
  for (float& value : scene.disparity) {
    value = unit(random) < 0.2 ? kNan : static_cast<float>(base_px + 0.3 * unit(random));
  }
  return scene;
}

/// The points of a scene within the range limit, body frame, one by one. Takes pixels out of the
/// scene whose points lie on the border of two cells, where rounding may decide.
std::vector<std::array<double, 3>> naive_points(Scene& scene) {
  const auto& model = std::get<PinholePair>(scene.pair.model);
  const reference::NaivePinholePair naive{
      model.baseline_m, model.focal_px, model.principal_u_px, model.principal_v_px};
  std::vector<std::array<double, 3>> points;
  for (int v = 0; v < scene.disparity.rows; ++v) {
    for (int u = 0; u < scene.disparity.cols; ++u) {
      const auto c = reference::naive_pinhole_point_cam_m(
          naive, {static_cast<double>(u), static_cast<double>(v), scene.disparity(v, u)});
      if (!(std::sqrt(c[0] * c[0] + c[1] * c[1] + c[2] * c[2]) <= scene.pair.max_range_m)) {
        continue;
      }
      std::array<double, 3> p{};
      for (int axis = 0; axis < 3; ++axis) {
        const auto at = static_cast<std::size_t>(axis);
        p[at] = scene.pair.T_body_camera.translation()[axis];
        for (int k = 0; k < 3; ++k) {
          p[at] += scene.pair.T_body_camera.linear()(axis, k) * c[static_cast<std::size_t>(k)];
        }
      }
      if (is_near_border(Eigen::Vector3d(p[0], p[1], p[2]), rad_from_deg(2.0))) {
        scene.disparity(v, u) = kNan;
      } else {
        points.push_back(p);
      }
    }
  }
  return points;
}

bool is_same(const std::optional<CellStatistics>& cell, const reference::NaiveCell& expected) {
  if (!cell) {
    return expected.n == 0;
  }
  return cell->count == expected.n &&
         std::abs(cell->mean_m - expected.mean_m) < 1e-5 * expected.mean_m &&
         std::abs(cell->min_m - expected.min_m) < 1e-5 * expected.min_m &&
         std::abs(cell->sigma_m - expected.sigma_m) < 1e-5 * expected.mean_m;
}

int count_different(const SphericalGrid& grid, const std::vector<reference::NaiveCell>& expected) {
  int different = 0;
  for (int i = 0; i < grid.geometry().cell_count(); ++i) {
    const std::optional<CellStatistics> cell = grid.statistics({i / 50, i % 50});
    different += is_same(cell, expected[static_cast<std::size_t>(i)]) ? 0 : 1;
  }
  return different;
}

TEST(AccumulateReference, AgreesOnRandomDisparities) {
  std::mt19937 random(43);
  const reference::NaiveGridSpec spec{rad_from_deg(40.0),
                                      rad_from_deg(140.0),
                                      rad_from_deg(-50.0),
                                      rad_from_deg(50.0),
                                      rad_from_deg(2.0)};
  int filled = 0;
  for (int round = 0; round < 30; ++round) {
    Scene scene = random_scene(random);
    const std::vector<std::array<double, 3>> points = naive_points(scene);
    SphericalGrid grid = thesis_grid();
    const PixelCounts counts = accumulate(scene.disparity, scene.pair, grid);
    EXPECT_EQ(counts.used, static_cast<int>(points.size()));
    EXPECT_EQ(count_different(grid, reference::naive_spherical_grid(spec, points, 0.5, 0.0)), 0);
    filled += grid.occupied_cell_count();
  }
  EXPECT_GT(filled, 1000);
}

}  // namespace
}  // namespace skyhalo

// Accumulation with the spherical pair model, and the range limits with both.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <opencv2/core.hpp>
#include <random>
#include <vector>

#include "reference/naive_spherical_grid.hpp"
#include "reference/naive_spherical_pair.hpp"
#include "skyhalo/geometry/angle.hpp"
#include "skyhalo/sphere/accumulate.hpp"
#include "support/cell_border.hpp"

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

/// 160 x 100 pixels of a degree, baseline 0.5 m.
PairGeometry example_pair() {
  return {.model = SphericalPair{.delta_theta_u_rad = rad_from_deg(1.0),
                                 .delta_theta_v_rad = rad_from_deg(1.0),
                                 .principal_u_px = 79.5,
                                 .principal_v_px = 49.5,
                                 .baseline_m = 0.5},
          .T_body_camera = forward_camera(),
          .max_range_m = 30.0};
}

const cv::Size kSize(160, 100);

reference::NaiveSphericalPair naive_of(const PairGeometry& pair) {
  const auto& model = std::get<SphericalPair>(pair.model);
  return {model.baseline_m,
          model.delta_theta_u_rad,
          model.delta_theta_v_rad,
          model.principal_u_px,
          model.principal_v_px};
}

constexpr double kGridStepDeg = 5.0;

SphericalGrid whole_grid() {
  return SphericalGrid(make_grid_geometry({.theta_min_rad = 0.0,
                                           .theta_max_rad = rad_from_deg(180.0),
                                           .phi_min_rad = rad_from_deg(-180.0),
                                           .phi_max_rad = rad_from_deg(180.0),
                                           .step_rad = rad_from_deg(kGridStepDeg)}));
}

reference::NaiveGridSpec whole_spec() {
  return {0.0,
          rad_from_deg(180.0),
          rad_from_deg(-180.0),
          rad_from_deg(180.0),
          rad_from_deg(kGridStepDeg)};
}

/// What the pair sees of a sphere of this radius round its right camera.
cv::Mat1f disparity_of_sphere(const PairGeometry& pair, double radius_m) {
  const reference::NaiveSphericalPair naive = naive_of(pair);
  cv::Mat1f disparity(kSize);
  for (int v = 0; v < kSize.height; ++v) {
    for (int u = 0; u < kSize.width; ++u) {
      const long double alpha = (u - naive.u0_px) * naive.pixel_u_rad;
      const long double beta = (v - naive.v0_px) * naive.pixel_v_rad;
      reference::NaivePoint point = reference::naive_spherical_ray(alpha, beta);
      for (long double& coordinate : point) {
        coordinate *= radius_m;
      }
      disparity(v, u) = static_cast<float>(reference::naive_spherical_match(naive, point)[2]);
    }
  }
  return disparity;
}

/// True when all points of the cell lie on the sphere: its disparities have 24 bits.
bool is_on_sphere(const CellStatistics& cell, double radius_m) {
  return std::abs(cell.mean_m - radius_m) < 1e-4 * radius_m &&
         std::abs(cell.min_m - radius_m) < 1e-4 * radius_m && cell.sigma_m < 1e-4 * radius_m;
}

TEST(AccumulateSphericalTest, ASphereRoundTheCameraFillsItsCellsWithItsRadius) {
  for (const double radius_m : {1.0, 5.0, 20.0}) {
    SphericalGrid grid = whole_grid();
    const PairGeometry pair = example_pair();
    const PixelCounts counts = accumulate(disparity_of_sphere(pair, radius_m), pair, grid);
    EXPECT_EQ(counts.measured, kSize.area());
    EXPECT_EQ(counts.used, kSize.area());
    int points = 0;
    for (int i = 0; i < grid.geometry().cell_count(); ++i) {
      const GridCell at{i / grid.geometry().cols, i % grid.geometry().cols};
      const std::optional<CellStatistics> cell = grid.statistics(at);
      EXPECT_TRUE(!cell || is_on_sphere(*cell, radius_m)) << at.row << ", " << at.col;
      points += cell ? cell->count : 0;
    }
    EXPECT_EQ(points, kSize.area());
    EXPECT_TRUE(grid.statistics({18, 36}).has_value());  // ahead
    EXPECT_FALSE(grid.statistics({18, 0}).has_value());  // behind
  }
}

TEST(AccumulateSphericalTest, AnglesThatCannotBeCountAsNotMeasured) {
  // Column 149 looks 69.5 deg to the right: with 20 px and less the left ray leans less than a
  // quarter turn, with 21 px and more it points away.
  cv::Mat1f disparity(kSize, kNan);
  disparity(50, 149) = 20.0F;
  disparity(51, 149) = 21.0F;
  disparity(52, 149) = 300.0F;
  disparity(54, 149) = -1.0F;
  disparity(55, 149) = std::numeric_limits<float>::infinity();
  SphericalGrid grid = whole_grid();
  const PixelCounts counts = accumulate(disparity, example_pair(), grid);
  EXPECT_EQ(counts.measured, 1);
  EXPECT_EQ(counts.used, 1);
  EXPECT_EQ(grid.occupied_cell_count(), 1);
}

TEST(AccumulateSphericalTest, LooksWhereTheCameraLooks) {
  // Pixel (109, 29) looks 29.5 deg to the right, in the plane that is 20.5 deg up.
  cv::Mat1f disparity(kSize, kNan);
  disparity(29, 109) = 5.0F;
  SphericalGrid grid = whole_grid();
  ASSERT_EQ(accumulate(disparity, example_pair(), grid).used, 1);
  const double right = std::sin(rad_from_deg(29.5));
  const double up = std::cos(rad_from_deg(29.5)) * std::sin(rad_from_deg(20.5));
  const double ahead = std::cos(rad_from_deg(29.5)) * std::cos(rad_from_deg(20.5));
  const int row = static_cast<int>(deg_from_rad(std::acos(up)) / kGridStepDeg);
  const int col =
      static_cast<int>((180.0 + deg_from_rad(std::atan2(-right, ahead))) / kGridStepDeg);
  const std::optional<CellStatistics> cell = grid.statistics({row, col});
  ASSERT_TRUE(cell.has_value());
  // The law of sines: B / sin(5 deg) = k / sin(90 - 34.5 deg).
  EXPECT_NEAR(cell->mean_m, 0.5 * std::cos(rad_from_deg(34.5)) / std::sin(rad_from_deg(5.0)), 1e-4);
}

/// 128 px of focal length, baseline 0.5 m, so that a disparity of 16 px is 4 m, exactly.
PairGeometry exact_pair() {
  return {.model = PinholePair{.focal_px = 128.0,
                               .principal_u_px = 10.0,
                               .principal_v_px = 10.0,
                               .baseline_m = 0.5,
                               .disparity_offset_px = 0.0},
          .T_body_camera = forward_camera(),
          .max_range_m = 30.0};
}

/// How many of the disparities 32, 16 and 8 px in the middle, which are 2, 4 and 8 m away, are used
/// within the limits.
int used_between(double min_m, double max_m) {
  int used = 0;
  for (const float value : {32.0F, 16.0F, 8.0F}) {
    cv::Mat1f disparity(21, 21, kNan);
    disparity(10, 10) = value;
    PairGeometry pair = exact_pair();
    pair.min_range_m = min_m;
    pair.max_range_m = max_m;
    SphericalGrid grid = whole_grid();
    const PixelCounts counts = accumulate(disparity, pair, grid);
    EXPECT_EQ(counts.measured, 1);
    EXPECT_EQ(grid.occupied_cell_count(), counts.used);
    used += counts.used;
  }
  return used;
}

TEST(AccumulateRangeTest, BothLimitsBelongToTheRange) {
  EXPECT_EQ(used_between(0.0, 100.0), 3);
  EXPECT_EQ(used_between(2.0, 8.0), 3);
  EXPECT_EQ(used_between(4.0, 4.0), 1);
  EXPECT_EQ(used_between(4.00001, 8.0), 1);  // single precision
  EXPECT_EQ(used_between(2.0, 7.99999), 2);
  EXPECT_EQ(used_between(5.0, 7.0), 0);
  EXPECT_EQ(used_between(8.0, 2.0), 0);
}

TEST(AccumulateRangeTest, TheLimitsHoldForSphericalPairsToo) {
  const cv::Mat1f disparity = disparity_of_sphere(example_pair(), 5.0);
  const auto used = [&](double min_m, double max_m) {
    PairGeometry pair = example_pair();
    pair.min_range_m = min_m;
    pair.max_range_m = max_m;
    SphericalGrid grid = whole_grid();
    return accumulate(disparity, pair, grid).used;
  };
  EXPECT_EQ(used(4.999, 5.001), kSize.area());
  EXPECT_EQ(used(5.001, 30.0), 0);
  EXPECT_EQ(used(0.0, 4.999), 0);
}

struct Scene {
  cv::Mat1f disparity;
  PairGeometry pair;
};

Scene random_scene(std::mt19937& random) {
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  Scene scene{cv::Mat1f(40, 60), example_pair()};
  auto& model = std::get<SphericalPair>(scene.pair.model);
  model.delta_theta_u_rad = rad_from_deg(0.5 + 2.5 * unit(random));
  model.delta_theta_v_rad = rad_from_deg(0.5 + 5.0 * unit(random));
  model.principal_u_px = 60.0 * unit(random);
  model.principal_v_px = 40.0 * unit(random);
  model.baseline_m = 0.1 + unit(random);
  const Eigen::Vector3d axis = Eigen::Vector3d(unit(random), unit(random), 0.1).normalized();
  scene.pair.T_body_camera =
      make_pose((Eigen::AngleAxisd(3.0 * unit(random), axis) * forward_camera().linear()).eval(),
                {unit(random), unit(random), unit(random)});
  scene.pair.min_range_m = unit(random);
  scene.pair.max_range_m = 3.0 + 20.0 * unit(random);
  for (float& value : scene.disparity) {
    value = unit(random) < 0.2 ? kNan : static_cast<float>(-1.0 + 30.0 * unit(random));
  }
  return scene;
}

/// The points of a scene (m, body frame) by triangulation, and the counts.
struct NaivePoints {
  PixelCounts counts;
  std::vector<std::array<double, 3>> points;
};

NaivePoints naive_points(Scene& scene) {
  NaivePoints result;
  const auto& model = std::get<SphericalPair>(scene.pair.model);
  for (int v = 0; v < scene.disparity.rows; ++v) {
    for (int u = 0; u < scene.disparity.cols; ++u) {
      const float d = scene.disparity(v, u);
      const double alpha = (u - model.principal_u_px) * model.delta_theta_u_rad;
      const double left_alpha = alpha + d * model.delta_theta_u_rad;
      if (!(d > 0.0F && alpha > -std::numbers::pi / 2.0 && left_alpha < std::numbers::pi / 2.0)) {
        continue;
      }
      const auto c = reference::naive_spherical_point(
          naive_of(scene.pair),
          {static_cast<long double>(u), static_cast<long double>(v), static_cast<long double>(d)});
      const Eigen::Vector3d p_cam =
          c ? Eigen::Matrix<long double, 3, 1>((*c)[0], (*c)[1], (*c)[2]).cast<double>().eval()
            : Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity()).eval();
      const Eigen::Vector3d p_body =
          scene.pair.T_body_camera.linear() * p_cam + scene.pair.T_body_camera.translation();
      if (is_near_border(p_body, rad_from_deg(kGridStepDeg))) {
        scene.disparity(v, u) = kNan;
        continue;
      }
      ++result.counts.measured;
      if (p_cam.norm() < scene.pair.min_range_m || p_cam.norm() > scene.pair.max_range_m) {
        continue;
      }
      ++result.counts.used;
      result.points.push_back({p_body.x(), p_body.y(), p_body.z()});
    }
  }
  return result;
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

TEST(AccumulateSphericalReference, AgreesWithTriangulationOfRandomDisparities) {
  std::mt19937 random(47);
  int filled = 0;
  for (int round = 0; round < 30; ++round) {
    Scene scene = random_scene(random);
    const NaivePoints expected = naive_points(scene);
    SphericalGrid grid = whole_grid();
    const PixelCounts counts = accumulate(scene.disparity, scene.pair, grid);
    EXPECT_EQ(counts.measured, expected.counts.measured);
    EXPECT_EQ(counts.used, expected.counts.used);
    const auto cells = reference::naive_spherical_grid(whole_spec(), expected.points, 0.5, 0.0);
    int different = 0;
    for (int i = 0; i < grid.geometry().cell_count(); ++i) {
      const GridCell at{i / grid.geometry().cols, i % grid.geometry().cols};
      different += is_same(grid.statistics(at), cells[static_cast<std::size_t>(i)]) ? 0 : 1;
    }
    EXPECT_EQ(different, 0) << round;
    filled += grid.occupied_cell_count();
  }
  EXPECT_GT(filled, 1000);
}

}  // namespace
}  // namespace skyhalo

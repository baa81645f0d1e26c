#include "skyhalo/camera/pinhole_pair.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "reference/naive_pinhole.hpp"

namespace skyhalo {
namespace {

/// f 400 px, principal point (320, 240), baseline 0.5 m.
PinholePair example_pair() {
  return {.focal_px = 400.0,
          .principal_u_px = 320.0,
          .principal_v_px = 240.0,
          .baseline_m = 0.5,
          .disparity_offset_px = 0.0};
}

class RandomPairs {
 public:
  explicit RandomPairs(unsigned seed) : random_(seed) {}

  double in(double from, double to) {
    return std::uniform_real_distribution<double>(from, to)(random_);
  }

  PinholePair pair() {
    return {.focal_px = in(100.0, 2000.0),
            .principal_u_px = in(0.0, 1000.0),
            .principal_v_px = in(0.0, 700.0),
            .baseline_m = in(0.05, 1.0),
            .disparity_offset_px = in(-5.0, 5.0)};
  }

 private:
  std::mt19937 random_;
};

TEST(PinholePairTest, ReprojectsByTheEquation) {
  // B/d = 0.5/20 = 0.025 m per px; (100, -40, 400) px times that.
  EXPECT_TRUE(reproject(example_pair(), 420.0, 200.0, 20.0)
                  .isApprox(Eigen::Vector3d(2.5, -1.0, 10.0), 1e-15));
}

TEST(PinholePairTest, ThePrincipalPointLooksStraightAhead) {
  // f B/d = 400 * 0.5 / 8 = 25 m.
  EXPECT_TRUE(reproject(example_pair(), 320.0, 240.0, 8.0)
                  .isApprox(Eigen::Vector3d(0.0, 0.0, 25.0), 1e-15));
}

TEST(PinholePairTest, NoDisparityGivesNoFinitePoint) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(reproject(example_pair(), 420.0, 200.0, 0.0).allFinite());
  EXPECT_FALSE(reproject(example_pair(), 420.0, 200.0, kNan).allFinite());
}

TEST(PinholePairTest, ADisparityBelowZeroGivesNoFinitePoint) {
  EXPECT_FALSE(reproject(example_pair(), 420.0, 200.0, -20.0).allFinite());
}

TEST(PinholePairTest, ProjectsByTheEquation) {
  // (2.5, -1, 10): f/z = 40 px per m; u = 320 + 100, v = 240 - 40, d = 0.5 * 40.
  EXPECT_TRUE(project(example_pair(), {2.5, -1.0, 10.0})
                  .isApprox(Eigen::Vector3d(420.0, 200.0, 20.0), 1e-15));
}

TEST(PinholePairTest, TheLeftCameraSitsAtMinusTheBaseline) {
  // Seen from (-0.5, 0, 0) the point (2.5, -1, 10) is (3, -1, 10): u = 320 + 120 = right u + d.
  const Eigen::Vector3d right = project(example_pair(), {2.5, -1.0, 10.0});
  const Eigen::Vector3d left = project(example_pair(), {3.0, -1.0, 10.0});
  EXPECT_NEAR(right.x() + right.z(), left.x(), 1e-12);
  EXPECT_NEAR(right.y(), left.y(), 1e-12);
}

TEST(PinholePairTest, TheOffsetIsAddedToTheDisparity) {
  PinholePair pair = example_pair();
  pair.disparity_offset_px = 4.0;
  EXPECT_TRUE(
      reproject(pair, 420.0, 200.0, 16.0).isApprox(Eigen::Vector3d(2.5, -1.0, 10.0), 1e-15));
  EXPECT_NEAR(project(pair, {2.5, -1.0, 10.0}).z(), 16.0, 1e-12);
  // 0.5 / (16 + 4)^2 * 0.5 = 0.000625 m per px.
  EXPECT_TRUE(uncertainty_m(pair, {420.0, 200.0, 16.0}, 0.5)
                  .isApprox(Eigen::Vector3d(0.0625, 0.025, 0.25), 1e-12));
  // 400 * 0.5 / (60 + 4) = 3.125 m.
  EXPECT_NEAR(range_at_disparity_m(pair, 60.0), 3.125, 1e-12);
}

TEST(PinholePairTest, UncertaintyByTheEquation) {
  // B/d^2 delta_d = 0.5 / 400 * 0.5 = 0.000625 m per px; times (|100|, |-40|, 400) px.
  EXPECT_TRUE(uncertainty_m(example_pair(), {420.0, 200.0, 20.0}, 0.5)
                  .isApprox(Eigen::Vector3d(0.0625, 0.025, 0.25), 1e-12));
}

TEST(PinholePairTest, TheSearchRangeLimitsTheNearestDepth) {
  EXPECT_NEAR(range_at_disparity_m(example_pair(), 64.0), 3.125, 1e-12);  // 400 * 0.5 / 64
  EXPECT_NEAR(min_range_m(example_pair(), 640, 64.0), 3.125, 1e-12);
  EXPECT_NEAR(min_range_m(example_pair(), 64, 64.0), 3.125, 1e-12);
}

TEST(PinholePairTest, NoDisparityIsInfinitelyFar) {
  PinholePair pair = example_pair();
  pair.disparity_offset_px = -4.0;
  EXPECT_EQ(range_at_disparity_m(pair, 4.0), std::numeric_limits<double>::infinity());
  EXPECT_EQ(range_at_disparity_m(pair, 0.0), std::numeric_limits<double>::infinity());
  EXPECT_NEAR(range_at_disparity_m(pair, 5.0), 200.0, 1e-12);
}

TEST(PinholePairTest, RangeUncertaintyGrowsWithTheSquare) {
  // 10^2 * 0.5 / (0.5 * 400) = 0.25 m; at 20 m four times that.
  EXPECT_NEAR(delta_z_m(example_pair(), 10.0, 0.5), 0.25, 1e-12);
  EXPECT_NEAR(delta_z_m(example_pair(), 20.0, 0.5), 1.0, 1e-12);
  EXPECT_NEAR(range_at_uncertainty_m(example_pair(), 1.0, 0.5), 20.0, 1e-12);
  EXPECT_NEAR(range_at_uncertainty_m(example_pair(), 0.25, 0.5), 10.0, 1e-12);
}

TEST(PinholePairTest, DownscaledMovesThePrincipalPoint) {
  PinholePair pair = example_pair();
  pair.disparity_offset_px = 3.0;
  const PinholePair half = downscaled(pair, 2);
  EXPECT_DOUBLE_EQ(half.focal_px, 200.0);
  EXPECT_DOUBLE_EQ(half.principal_u_px, 159.75);  // 320.5 / 2 - 0.5
  EXPECT_DOUBLE_EQ(half.principal_v_px, 119.75);  // 240.5 / 2 - 0.5
  EXPECT_DOUBLE_EQ(half.baseline_m, 0.5);
  EXPECT_DOUBLE_EQ(half.disparity_offset_px, 1.5);
}

TEST(PinholePairTest, DownscaledByOneIsTheSame) {
  const PinholePair same = downscaled(example_pair(), 1);
  EXPECT_DOUBLE_EQ(same.focal_px, 400.0);
  EXPECT_DOUBLE_EQ(same.principal_u_px, 320.0);
  EXPECT_DOUBLE_EQ(same.principal_v_px, 240.0);
}

TEST(PinholePairProperty, APixelComesBackFromItsPoint) {
  RandomPairs random(21);
  for (int i = 0; i < 3000; ++i) {
    const PinholePair pair = random.pair();
    const Eigen::Vector3d pixel(
        random.in(0.0, 1000.0), random.in(0.0, 700.0), random.in(5.5, 200.0));
    const Eigen::Vector3d point_m = reproject(pair, pixel.x(), pixel.y(), pixel.z());
    EXPECT_GT(point_m.z(), 0.0);
    EXPECT_LT((project(pair, point_m) - pixel).norm(), 1e-9 * pixel.norm());
  }
}

TEST(PinholePairProperty, TheUncertaintyIsTheSlopeOfThePoint) {
  RandomPairs random(22);
  for (int i = 0; i < 1000; ++i) {
    const PinholePair pair = random.pair();
    const Eigen::Vector3d pixel(
        random.in(0.0, 1000.0), random.in(0.0, 700.0), random.in(10.0, 200.0));
    constexpr double kStep = 1e-4;
    const Eigen::Vector3d slope = (reproject(pair, pixel.x(), pixel.y(), pixel.z() + kStep) -
                                   reproject(pair, pixel.x(), pixel.y(), pixel.z() - kStep)) /
                                  (2.0 * kStep);
    const Eigen::Vector3d expected_m = 0.25 * slope.cwiseAbs();
    EXPECT_LT((uncertainty_m(pair, pixel, 0.25) - expected_m).norm(), 1e-6 * expected_m.norm());
  }
}

TEST(PinholePairProperty, RangeUncertaintyIsThatOfThePointStraightAhead) {
  RandomPairs random(26);
  for (int i = 0; i < 1000; ++i) {
    const PinholePair pair = random.pair();
    const double z_m = random.in(0.3, 100.0);
    const Eigen::Vector3d pixel = project(pair, {0.0, 0.0, z_m});
    const double expected_m = uncertainty_m(pair, pixel, 0.25).z();
    EXPECT_NEAR(delta_z_m(pair, z_m, 0.25), expected_m, 1e-9 * expected_m);
    EXPECT_NEAR(range_at_uncertainty_m(pair, expected_m, 0.25), z_m, 1e-9 * z_m);
    EXPECT_NEAR(range_at_disparity_m(pair, pixel.z()), z_m, 1e-9 * z_m);
  }
}

TEST(PinholePairProperty, NothingInTheImageIsMeasuredNearer) {
  RandomPairs random(27);
  for (int i = 0; i < 100; ++i) {
    PinholePair pair = random.pair();
    pair.principal_u_px = 320.0;
    double smallest_m = std::numeric_limits<double>::infinity();
    for (int u = 0; u < 640; ++u) {
      smallest_m = std::min(smallest_m, reproject(pair, u, pair.principal_v_px, 100.0).norm());
    }
    EXPECT_NEAR(min_range_m(pair, 640, 100.0), smallest_m, 1e-12 * smallest_m);
  }
}

TEST(PinholePairProperty, APointProjectsConsistentlyAtEveryScale) {
  RandomPairs random(23);
  for (int i = 0; i < 2000; ++i) {
    const PinholePair pair = random.pair();
    const int factor = 1 + i % 4;
    const Eigen::Vector3d point_m(
        random.in(-10.0, 10.0), random.in(-10.0, 10.0), random.in(1.0, 50.0));
    const Eigen::Vector3d full = project(pair, point_m);
    const Eigen::Vector3d small = project(downscaled(pair, factor), point_m);
    EXPECT_NEAR(small.x(), (full.x() + 0.5) / factor - 0.5, 1e-9 * (1.0 + std::abs(full.x())));
    EXPECT_NEAR(small.y(), (full.y() + 0.5) / factor - 0.5, 1e-9 * (1.0 + std::abs(full.y())));
    EXPECT_NEAR(small.z(), full.z() / factor, 1e-9 * (1.0 + std::abs(full.z())));
  }
}

TEST(PinholePairReference, AgreesOnPointsAndUncertainties) {
  RandomPairs random(24);
  for (int i = 0; i < 3000; ++i) {
    PinholePair pair = random.pair();
    pair.disparity_offset_px = 0.0;
    const reference::NaivePinholePair naive{
        pair.baseline_m, pair.focal_px, pair.principal_u_px, pair.principal_v_px};
    const reference::NaivePixel pixel{
        random.in(0.0, 1000.0), random.in(0.0, 700.0), random.in(0.1, 200.0)};
    const auto point = reference::naive_pinhole_point_cam_m(naive, pixel);
    const auto delta = reference::naive_pinhole_delta_cam_m(naive, pixel, 0.5);
    const Eigen::Vector3d expected_m(point[0], point[1], point[2]);
    const Eigen::Vector3d expected_delta_m =
        Eigen::Vector3d(delta[0], delta[1], delta[2]).cwiseAbs();
    EXPECT_TRUE(
        reproject(pair, pixel.u_px, pixel.v_px, pixel.disparity_px).isApprox(expected_m, 1e-12));
    EXPECT_TRUE(uncertainty_m(pair, {pixel.u_px, pixel.v_px, pixel.disparity_px}, 0.5)
                    .isApprox(expected_delta_m, 1e-12));
  }
}

TEST(PinholePairReference, AgreesOnDownscaling) {
  RandomPairs random(25);
  for (int i = 0; i < 500; ++i) {
    const PinholePair pair = random.pair();
    const int factor = 1 + i % 8;
    const reference::NaivePinholePair expected = reference::naive_downsampled(
        {pair.baseline_m, pair.focal_px, pair.principal_u_px, pair.principal_v_px}, factor);
    const PinholePair small = downscaled(pair, factor);
    const Eigen::Vector3d expected_px(expected.focal_px, expected.u0_px, expected.v0_px);
    EXPECT_TRUE(Eigen::Vector3d(small.focal_px, small.principal_u_px, small.principal_v_px)
                    .isApprox(expected_px, 1e-14));
    EXPECT_EQ(small.baseline_m, expected.baseline_m);
  }
}

}  // namespace
}  // namespace skyhalo

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <random>

#include "reference/naive_spherical_pair.hpp"
#include "skyhalo/camera/spherical_pair.hpp"

namespace skyhalo {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kDegree = kPi / 180.0;

class RandomPairs {
 public:
  explicit RandomPairs(unsigned seed) : random_(seed) {}

  double in(double from, double to) {
    return std::uniform_real_distribution<double>(from, to)(random_);
  }

  SphericalPair pair() {
    return {.delta_theta_u_rad = in(0.0005, 0.01),
            .delta_theta_v_rad = in(0.0005, 0.01),
            .principal_u_px = in(-100.0, 2000.0),
            .principal_v_px = in(-100.0, 1500.0),
            .baseline_m = in(0.05, 1.0)};
  }

  /// A point within 87 degrees across and 80 upright, at 0.3 to 100 m.
  Eigen::Vector3d point_m() {
    const double alpha = in(-87.0, 87.0) * kDegree;
    const double beta = in(-80.0, 80.0) * kDegree;
    const double range_m = 0.3 * std::pow(100.0 / 0.3, in(0.0, 1.0));
    return range_m * Eigen::Vector3d(std::sin(alpha),
                                     std::cos(alpha) * std::sin(beta),
                                     std::cos(alpha) * std::cos(beta));
  }

 private:
  std::mt19937 random_;
};

reference::NaiveSphericalPair to_naive(const SphericalPair& pair) {
  return {pair.baseline_m,
          pair.delta_theta_u_rad,
          pair.delta_theta_v_rad,
          pair.principal_u_px,
          pair.principal_v_px};
}

Eigen::Vector3d to_eigen(const std::array<long double, 3>& v) {
  return {static_cast<double>(v[0]), static_cast<double>(v[1]), static_cast<double>(v[2])};
}

TEST(SphericalPairProperty, APointComesBackFromItsPixel) {
  RandomPairs random(61);
  for (int i = 0; i < 20000; ++i) {
    const SphericalPair pair = random.pair();
    const Eigen::Vector3d point_m = random.point_m();
    const Eigen::Vector3d pixel = project(pair, point_m);
    EXPECT_GT(pixel.z(), 0.0);
    // How far the point moves when the last bit of the disparity changes.
    const double rounding_m =
        1e-15 * pixel.cwiseAbs().maxCoeff() * uncertainty_m(pair, pixel, 1.0).norm();
    ASSERT_LT((reproject(pair, pixel.x(), pixel.y(), pixel.z()) - point_m).norm(),
              1e-9 * point_m.norm() + rounding_m)
        << point_m.transpose();
  }
}

TEST(SphericalPairProperty, APixelComesBackFromItsPoint) {
  RandomPairs random(62);
  for (int i = 0; i < 20000; ++i) {
    const SphericalPair pair = random.pair();
    const double alpha = random.in(-87.0, 80.0) * kDegree;
    const double delta = random.in(0.05 * kDegree, 0.999 * (87.0 * kDegree - alpha));
    const Eigen::Vector3d pixel(
        pair.principal_u_px + alpha / pair.delta_theta_u_rad,
        pair.principal_v_px + random.in(-80.0, 80.0) * kDegree / pair.delta_theta_v_rad,
        delta / pair.delta_theta_u_rad);
    const Eigen::Vector3d point_m = reproject(pair, pixel.x(), pixel.y(), pixel.z());
    ASSERT_LT((project(pair, point_m) - pixel).norm(), 1e-9 * pixel.norm()) << pixel.transpose();
    ASSERT_NEAR(project(pair, point_m).z(), pixel.z(), 1e-9 * pixel.z()) << pixel.transpose();
  }
}

TEST(SphericalPairProperty, APointLiesOnTheRayOfItsPixel) {
  RandomPairs random(63);
  for (int i = 0; i < 3000; ++i) {
    const SphericalPair pair = random.pair();
    const Eigen::Vector3d point_m = random.point_m();
    const Eigen::Vector3d pixel = project(pair, point_m);
    const Eigen::Vector3d ray = ray_of(pair, pixel.x(), pixel.y());
    EXPECT_NEAR(ray.norm(), 1.0, 1e-14);
    EXPECT_LT((ray * point_m.norm() - point_m).norm(), 1e-11 * point_m.norm());
    // The left camera sees it on the same row, further right by the disparity.
    const Eigen::Vector3d left_m = point_m + Eigen::Vector3d(pair.baseline_m, 0.0, 0.0);
    EXPECT_LT((ray_of(pair, pixel.x() + pixel.z(), pixel.y()) * left_m.norm() - left_m).norm(),
              1e-11 * left_m.norm());
  }
}

TEST(SphericalPairProperty, RangeUncertaintyIsThatOfThePointStraightAhead) {
  RandomPairs random(64);
  for (int i = 0; i < 3000; ++i) {
    const SphericalPair pair = random.pair();
    const double z_m = random.in(0.1, 100.0);
    const Eigen::Vector3d pixel = project(pair, {0.0, 0.0, z_m});
    const double expected_m = uncertainty_m(pair, pixel, 0.25).z();
    EXPECT_NEAR(delta_z_m(pair, z_m, 0.25), expected_m, 1e-9 * expected_m);
    EXPECT_NEAR(range_at_uncertainty_m(pair, expected_m, 0.25), z_m, 1e-8 * z_m);
    EXPECT_NEAR(range_at_disparity_m(pair, pixel.z()), z_m, 1e-9 * z_m);
  }
}

TEST(SphericalPairProperty, APointProjectsConsistentlyAtEveryScale) {
  RandomPairs random(65);
  for (int i = 0; i < 2000; ++i) {
    const SphericalPair pair = random.pair();
    const int factor = 1 + i % 4;
    const Eigen::Vector3d point_m = random.point_m();
    const Eigen::Vector3d full = project(pair, point_m);
    const Eigen::Vector3d small = project(downscaled(pair, factor), point_m);
    EXPECT_NEAR(small.x(), (full.x() + 0.5) / factor - 0.5, 1e-9 * (1.0 + std::abs(full.x())));
    EXPECT_NEAR(small.y(), (full.y() + 0.5) / factor - 0.5, 1e-9 * (1.0 + std::abs(full.y())));
    EXPECT_NEAR(small.z(), full.z() / factor, 1e-9 * (1.0 + std::abs(full.z())));
  }
}

TEST(SphericalPairReference, TriangulationGivesTheSamePoint) {
  RandomPairs random(66);
  for (int i = 0; i < 20000; ++i) {
    const SphericalPair pair = random.pair();
    const Eigen::Vector3d truth_m = random.point_m();
    const auto match =
        reference::naive_spherical_match(to_naive(pair), {truth_m.x(), truth_m.y(), truth_m.z()});
    const Eigen::Vector3d pixel = to_eigen(match);
    ASSERT_LT((project(pair, truth_m) - pixel).norm(), 1e-11 * (1.0 + pixel.norm()));
    const auto point =
        reference::naive_spherical_point(to_naive(pair), {pixel.x(), pixel.y(), pixel.z()});
    ASSERT_TRUE(point.has_value());
    const Eigen::Vector3d expected_m = to_eigen(*point);
    ASSERT_LT((expected_m - truth_m).norm(), 1e-7 * truth_m.norm());
    // Near a side cos(alpha + delta) is small and takes the rounding of the angle; so does k.
    const double rounding_m =
        1e-15 * pair.baseline_m / std::sin(pixel.z() * pair.delta_theta_u_rad);
    ASSERT_LT((reproject(pair, pixel.x(), pixel.y(), pixel.z()) - expected_m).norm(),
              1e-11 * expected_m.norm() + 10.0 * rounding_m)
        << truth_m.transpose();
  }
}

TEST(SphericalPairReference, UncertaintyIsTheSlopeOfTheTriangulation) {
  RandomPairs random(67);
  for (int i = 0; i < 5000; ++i) {
    const SphericalPair pair = random.pair();
    const Eigen::Vector3d pixel = project(pair, random.point_m());
    const Eigen::Vector3d expected_m =
        0.25 * to_eigen(reference::naive_spherical_slope(to_naive(pair),
                                                         {pixel.x(), pixel.y(), pixel.z()}));
    if (!expected_m.allFinite()) {
      continue;  // a step of the difference quotient left the domain
    }
    const Eigen::Vector3d given_m = uncertainty_m(pair, pixel, 0.25);
    for (int axis = 0; axis < 3; ++axis) {
      ASSERT_NEAR(given_m[axis], expected_m[axis], 1e-8 * expected_m.norm()) << pixel.transpose();
    }
  }
}

TEST(SphericalPairReference, NoMatchInTheImageIsNearer) {
  RandomPairs random(68);
  for (int i = 0; i < 60; ++i) {
    SphericalPair pair = random.pair();
    const int width_px = static_cast<int>(random.in(100.0, 300.0));
    const int max_disparity_px = static_cast<int>(random.in(8.0, 99.0));
    const double fov_rad = random.in(60.0, 175.0) * kDegree;
    pair.delta_theta_u_rad = fov_rad / width_px;
    // The principal point as far off the middle as keeps both sides within 88 degrees.
    const double slack_px = 88.0 * kDegree / pair.delta_theta_u_rad - 0.5 * width_px;
    pair.principal_u_px = 0.5 * (width_px - 1) + random.in(-1.0, 1.0) * slack_px;
    const double expected_m = static_cast<double>(
        reference::naive_spherical_min_range_m(to_naive(pair), width_px, max_disparity_px));
    // Between a left ray at the side and the right one the nearest is at a right angle, which may
    // lie between two whole disparities.
    const bool reaches_right_angle = max_disparity_px * pair.delta_theta_u_rad > 0.5 * kPi;
    const double between = reaches_right_angle ? 0.2 * std::pow(pair.delta_theta_u_rad, 2) : 0.0;
    const double given_m = min_range_m(pair, width_px, max_disparity_px);
    EXPECT_LE(given_m, expected_m * (1.0 + 1e-9))
        << "width " << width_px << " search " << max_disparity_px << " field " << fov_rad / kDegree;
    EXPECT_GE(given_m, expected_m * (1.0 - 1e-9 - between))
        << "width " << width_px << " search " << max_disparity_px;
  }
}

}  // namespace
}  // namespace skyhalo

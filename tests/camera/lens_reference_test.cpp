#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <opencv2/calib3d.hpp>
#include <vector>

#include "reference/naive_lens.hpp"
#include "skyhalo/camera/lens.hpp"
#include "support/example_lenses.hpp"

namespace skyhalo {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kDegree = kPi / 180.0;

reference::NaiveVector to_naive(const Eigen::Vector3d& v) {
  return {v.x(), v.y(), v.z()};
}

Eigen::Vector2d to_eigen(const reference::NaiveImagePoint& pixel) {
  return {pixel[0], pixel[1]};
}

/// The naive inverse of a lens within its own domain.
auto naive_inverse(const Lens& lens) {
  return reference::NaiveInverse(
      [&lens](const reference::NaiveVector& ray) { return testing::naive_project(lens, ray); },
      max_angle_rad(lens));
}

/// Distance from the principal point in focal lengths of the image of a ray.
double image_radius(const Lens& lens, double theta_rad, double phi_rad) {
  const Intrinsics& in = intrinsics(lens);
  const auto pixel = testing::naive_project(lens, to_naive(testing::ray_at(theta_rad, phi_rad)));
  return std::hypot((pixel[0] - in.cx_px) / in.fx_px, (pixel[1] - in.cy_px) / in.fy_px);
}

cv::Matx33d camera_matrix(const Intrinsics& in) {
  return {in.fx_px, 0.0, in.cx_px, 0.0, in.fy_px, in.cy_px, 0.0, 0.0, 1.0};
}

std::vector<cv::Point3d> random_points(const Lens& lens, double limit_rad, unsigned seed) {
  testing::RandomRays random(seed);
  std::vector<cv::Point3d> points;
  for (int i = 0; i < 2000; ++i) {
    const Eigen::Vector3d point =
        random.in(0.2, 50.0) * random.ray(std::min(limit_rad, 0.999 * max_angle_rad(lens)));
    points.emplace_back(point.x(), point.y(), point.z());
  }
  return points;
}

void expect_same(const Lens& lens,
                 const std::vector<cv::Point3d>& points,
                 const std::vector<cv::Point2d>& expected_px) {
  ASSERT_EQ(points.size(), expected_px.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto pixel = project(lens, {points[i].x, points[i].y, points[i].z});
    ASSERT_TRUE(pixel.has_value()) << points[i];
    ASSERT_NEAR(pixel->x(), expected_px[i].x, 1e-6) << points[i];
    ASSERT_NEAR(pixel->y(), expected_px[i].y, 1e-6) << points[i];
  }
}

TEST(LensReference, OpenCvProjectsTheSame) {
  for (const auto& example : testing::radial_tangential_examples()) {
    SCOPED_TRACE(example.name);
    const auto& lens = std::get<RadialTangentialLens>(example.lens);
    const auto points = random_points(example.lens, 70.0 * kDegree, 51);
    const auto& k = lens.distortion();
    // As short a list as holds all that is not zero, and the full one.
    for (const std::size_t count : {4U, 5U, 8U}) {
      if (std::any_of(k.begin() + static_cast<std::ptrdiff_t>(count), k.end(), [](double c) {
            return c != 0.0;
          })) {
        continue;
      }
      std::vector<cv::Point2d> expected_px;
      cv::projectPoints(
          points,
          cv::Vec3d(),
          cv::Vec3d(),
          camera_matrix(lens.intrinsics()),
          std::vector<double>(k.begin(), k.begin() + static_cast<std::ptrdiff_t>(count)),
          expected_px);
      expect_same(example.lens, points, expected_px);
    }
  }
}

TEST(LensReference, OpenCvFisheyeProjectsTheSame) {
  for (const auto& example : testing::kannala_brandt_examples()) {
    SCOPED_TRACE(example.name);
    const auto& lens = std::get<KannalaBrandtLens>(example.lens);
    const auto points = random_points(example.lens, 89.9 * kDegree, 52);
    std::vector<cv::Point2d> expected_px;
    cv::fisheye::projectPoints(points,
                               expected_px,
                               cv::Vec3d(),
                               cv::Vec3d(),
                               camera_matrix(lens.intrinsics()),
                               cv::Mat(lens.distortion()));
    expect_same(example.lens, points, expected_px);
  }
}

TEST(LensReference, TheNaiveProjectionAgrees) {
  testing::RandomRays random(53);
  for (const auto& example : testing::example_lenses()) {
    SCOPED_TRACE(example.name);
    for (int i = 0; i < 5000; ++i) {
      const Eigen::Vector3d point =
          random.in(0.1, 100.0) * random.ray(0.9999 * max_angle_rad(example.lens));
      const auto pixel = project(example.lens, point);
      ASSERT_TRUE(pixel.has_value()) << point.transpose();
      const Eigen::Vector2d expected =
          to_eigen(testing::naive_project(example.lens, to_naive(point)));
      ASSERT_LT((*pixel - expected).norm(),
                1e-9 * (testing::focal_px(example.lens) + expected.norm()))
          << point.transpose();
    }
  }
}

TEST(LensReference, TheNaiveSearchFindsTheSameRay) {
  testing::RandomRays random(54);
  for (const auto& example : testing::example_lenses()) {
    SCOPED_TRACE(example.name);
    const auto inverse = naive_inverse(example.lens);
    for (int i = 0; i < 200; ++i) {
      const Eigen::Vector2d pixel(random.in(-0.2, 1.2) * example.size_px.width,
                                  random.in(-0.2, 1.2) * example.size_px.height);
      const auto ray = unproject(example.lens, pixel);
      for (const auto& found : inverse.all({pixel.x(), pixel.y()})) {
        const Eigen::Vector3d expected(found[0], found[1], found[2]);
        const double angle_rad = testing::angle_between_rad(expected, Eigen::Vector3d::UnitZ());
        if (angle_rad < 0.999 * max_angle_rad(example.lens)) {
          ASSERT_TRUE(ray.has_value())
              << pixel.transpose() << " is seen by " << expected.transpose();
          ASSERT_LT(testing::angle_between_rad(*ray, expected), 1e-9) << pixel.transpose();
        }
      }
    }
  }
}

TEST(LensReference, NoTwoRaysOfTheDomainShareAPixel) {
  testing::RandomRays random(55);
  for (const auto& example : testing::example_lenses()) {
    SCOPED_TRACE(example.name);
    const auto inverse = naive_inverse(example.lens);
    for (int i = 0; i < 200; ++i) {
      const Eigen::Vector3d ray = random.ray(0.999 * max_angle_rad(example.lens));
      const auto pixel = testing::naive_project(example.lens, to_naive(ray));
      for (const auto& found : inverse.all(pixel)) {
        ASSERT_LT(testing::angle_between_rad({found[0], found[1], found[2]}, ray), 1e-5)
            << "also seen at pixel " << pixel[0] << ' ' << pixel[1] << ": " << ray.transpose();
      }
    }
  }
}

TEST(LensReference, TheImageGrowsOutwardsAllOverTheDomain) {
  for (const auto& example : testing::example_lenses()) {
    SCOPED_TRACE(example.name);
    const double end_rad = 0.9999 * max_angle_rad(example.lens);
    for (int spoke = 0; spoke < 8; ++spoke) {
      const double phi = 2.0 * kPi * spoke / 8.0;
      const auto radius = [&](double theta) { return image_radius(example.lens, theta, phi); };
      ASSERT_EQ(reference::naive_first_fold_rad(radius, end_rad), end_rad) << phi;
    }
  }
}

TEST(LensReference, ARadialDomainEndsWhereTheImageFolds) {
  for (const auto& examples :
       {testing::radial_tangential_examples(), testing::kannala_brandt_examples()}) {
    for (const auto& example : examples) {
      SCOPED_TRACE(example.name);
      const bool plane = std::holds_alternative<RadialTangentialLens>(example.lens);
      double folds_rad = (plane ? 89.0 : 179.0) * kDegree;
      double slow_rad = folds_rad;  // where it grows 500 times more slowly than in the middle
      for (int spoke = 0; spoke < 16; ++spoke) {
        const double phi = 2.0 * kPi * spoke / 16.0;
        folds_rad = std::min(
            folds_rad,
            reference::naive_first_fold_rad(
                [&](double theta) { return image_radius(example.lens, theta, phi); }, folds_rad));
        slow_rad = std::min(slow_rad,
                            reference::naive_first_fold_rad(
                                [&](double theta) {
                                  return image_radius(example.lens, theta, phi) -
                                         0.002 * (plane ? std::tan(theta) : theta);
                                },
                                slow_rad));
      }
      EXPECT_LE(max_angle_rad(example.lens), folds_rad + 1e-6);
      // With strong decentring, growing outwards is not all there is to not folding.
      if (example.name != "decentred") {
        EXPECT_GE(max_angle_rad(example.lens), slow_rad - 1e-3);
      }
    }
  }
}

TEST(LensReference, ADomainOfSpheresEndsWhereTheImageDoes) {
  constexpr double kMargin = 2e-3;
  constexpr double kWidest = 179.0 * kDegree;
  for (const auto& example : testing::double_sphere_examples()) {
    SCOPED_TRACE(example.name);
    const auto& shape = std::get<DoubleSphereLens>(example.lens).shape();
    const double exact = reference::naive_double_sphere_limit_rad(shape.xi, shape.alpha);
    // The domain as printed in Usenko et al. 2018, section 4, is mostly a little smaller.
    const double w1 =
        shape.alpha > 0.5 ? (1.0 - shape.alpha) / shape.alpha : shape.alpha / (1.0 - shape.alpha);
    const double w2 = (w1 + shape.xi) / std::sqrt(2.0 * w1 * shape.xi + shape.xi * shape.xi + 1.0);
    const double printed = std::acos(-w2);
    EXPECT_LE(max_angle_rad(example.lens), exact);
    EXPECT_GE(max_angle_rad(example.lens), std::min({exact, printed, kWidest}) - kMargin);
  }
  for (const auto& example : testing::extended_unified_examples()) {
    SCOPED_TRACE(example.name);
    const auto& shape = std::get<ExtendedUnifiedLens>(example.lens).shape();
    const double exact = reference::naive_extended_unified_limit_rad(shape.alpha, shape.beta);
    EXPECT_LE(max_angle_rad(example.lens), exact);
    EXPECT_GE(max_angle_rad(example.lens), std::min(exact, kWidest) - kMargin);
  }
}

}  // namespace
}  // namespace skyhalo

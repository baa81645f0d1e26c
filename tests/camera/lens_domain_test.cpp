#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include "skyhalo/base/error.hpp"
#include "skyhalo/camera/lens.hpp"
#include "support/example_lenses.hpp"

namespace skyhalo {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kDegree = kPi / 180.0;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kDenormal = std::numeric_limits<double>::denorm_min();

void expect_refused(const Lens& lens, const Eigen::Vector3d& point) {
  EXPECT_FALSE(project(lens, point).has_value()) << point.transpose();
  EXPECT_FALSE(jacobian(lens, point).has_value()) << point.transpose();
}

TEST(LensDomainTest, WhatIsNoDirectionIsRefused) {
  for (const auto& example : testing::example_lenses()) {
    SCOPED_TRACE(example.name);
    expect_refused(example.lens, {0.0, 0.0, 0.0});
    expect_refused(example.lens, {-0.0, 0.0, -0.0});
    for (const double bad : {kNan, kInfinity, -kInfinity}) {
      expect_refused(example.lens, {bad, 0.0, 1.0});
      expect_refused(example.lens, {0.0, bad, 1.0});
      expect_refused(example.lens, {0.0, 0.0, bad});
      expect_refused(example.lens, {bad, bad, bad});
      EXPECT_FALSE(unproject(example.lens, {bad, 240.0}).has_value());
      EXPECT_FALSE(unproject(example.lens, {320.0, bad}).has_value());
      EXPECT_FALSE(unproject(example.lens, {bad, bad}).has_value());
    }
  }
}

TEST(LensDomainTest, StraightBehindIsRefused) {
  for (const auto& example : testing::example_lenses()) {
    SCOPED_TRACE(example.name);
    expect_refused(example.lens, {0.0, 0.0, -1.0});
    expect_refused(example.lens, {1e-9, 0.0, -1.0});
    expect_refused(example.lens, {0.0, -kDenormal, -1e300});
  }
}

TEST(LensDomainTest, APlaneImageEndsAtAQuarterTurn) {
  for (const auto& example : testing::radial_tangential_examples()) {
    SCOPED_TRACE(example.name);
    EXPECT_LE(max_angle_rad(example.lens), 89.0001 * kDegree);
    expect_refused(example.lens, {1.0, 0.0, 0.0});
    expect_refused(example.lens, {0.0, 1.0, -0.0});
    expect_refused(example.lens, {0.1, 0.1, -1.0});
  }
}

TEST(LensDomainTest, TheDomainIsAsWideAsTheLensShows) {
  EXPECT_NEAR(
      max_angle_rad(RadialTangentialLens({400.0, 400.0, 320.0, 240.0}, {})), 89.0 * kDegree, 1e-6);
  // (1 - 0.4 r^2) r stands still at r^2 = 1/1.2.
  EXPECT_NEAR(max_angle_rad(RadialTangentialLens({400.0, 400.0, 320.0, 240.0}, {-0.4})),
              std::atan(std::sqrt(1.0 / 1.2)),
              2e-3);
  // theta - theta^3/12 stands still at theta = 2.
  EXPECT_NEAR(
      max_angle_rad(KannalaBrandtLens({400.0, 400.0, 320.0, 240.0}, {-1.0 / 12.0, 0.0, 0.0, 0.0})),
      2.0,
      2e-3);
  EXPECT_NEAR(
      max_angle_rad(KannalaBrandtLens({400.0, 400.0, 320.0, 240.0}, {})), 179.0 * kDegree, 1e-6);
  EXPECT_GE(max_angle_rad(testing::ideal_fisheye(175.0).lens), 87.5 * kDegree);
  EXPECT_GE(max_angle_rad(testing::ideal_fisheye(200.0).lens), 100.0 * kDegree);
}

TEST(LensDomainTest, AFisheyeShowsWhatIsBehindTheCamera) {
  const auto example = testing::ideal_fisheye(200.0);
  // 99 of 100 degrees to the right: 639.5 + 640 * 0.99, and the middle row.
  const auto pixel = project(example.lens, 5.0 * testing::ray_at(99.0 * kDegree, 0.0));
  ASSERT_TRUE(pixel.has_value());
  EXPECT_NEAR(pixel->x(), 639.5 + 633.6, 1e-9);
  EXPECT_NEAR(pixel->y(), 511.5, 1e-9);
  const auto ray = unproject(example.lens, *pixel);
  ASSERT_TRUE(ray.has_value());
  EXPECT_LT(ray->z(), 0.0);
}

TEST(LensDomainTest, TheCornersOfARealImageAreSeen) {
  for (const auto& example : testing::example_lenses()) {
    if (example.name != "EuRoC" && example.name != "8 coefficients" &&
        example.name != "Mynteye fisheye" && example.name.find("-0.240960") == std::string::npos &&
        example.name.find("0.591660") == std::string::npos) {
      continue;
    }
    SCOPED_TRACE(example.name);
    for (const double u_px : {-0.5, example.size_px.width - 0.5}) {
      for (const double v_px : {-0.5, example.size_px.height - 0.5}) {
        EXPECT_TRUE(unproject(example.lens, {u_px, v_px}).has_value()) << u_px << ' ' << v_px;
      }
    }
  }
}

TEST(LensDomainTest, PixelsBeyondTheFoldAreRefused) {
  // (1 - 0.4 r^2) r has its largest value 0.6086 at r = 0.9129: 243.4 px.
  const RadialTangentialLens folding({400.0, 400.0, 320.0, 240.0}, {-0.4});
  EXPECT_TRUE(unproject(folding, {320.0 + 243.0, 240.0}).has_value());
  EXPECT_FALSE(unproject(folding, {320.0 + 244.0, 240.0}).has_value());
  EXPECT_FALSE(unproject(folding, {320.0, 240.0 - 244.0}).has_value());
  // theta - theta^3/12 has its largest value 4/3 at theta = 2: 533.3 px.
  const KannalaBrandtLens fisheye({400.0, 400.0, 320.0, 240.0}, {-1.0 / 12.0, 0.0, 0.0, 0.0});
  EXPECT_TRUE(unproject(fisheye, {320.0, 240.0 + 533.0}).has_value());
  EXPECT_FALSE(unproject(fisheye, {320.0, 240.0 + 534.0}).has_value());
}

TEST(LensDomainTest, AbsurdDistortionIsRefusedOrHarmless) {
  const Intrinsics in{400.0, 400.0, 320.0, 240.0};
  for (const double size : {1e6, 1e30, 1e150, 1e300, -1e6, -1e30, -1e150, -1e300}) {
    for (std::size_t i = 0; i < 8; ++i) {
      SCOPED_TRACE(std::to_string(size) + " as coefficient " + std::to_string(i));
      RadialTangentialLens::Distortion distortion{};
      distortion[i] = size;
      try {
        const RadialTangentialLens lens(in, distortion);
        EXPECT_GT(lens.max_angle_rad(), 0.0);
        EXPECT_LE(lens.max_angle_rad(), 89.0001 * kDegree);
        const auto pixel = lens.project(testing::ray_at(0.5 * lens.max_angle_rad(), 1.0));
        ASSERT_TRUE(pixel.has_value());
        EXPECT_TRUE(pixel->allFinite());
      } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::kInput);
        EXPECT_THAT(error.what(), ::testing::HasSubstr("distortion"));
      }
    }
  }
}

TEST(LensDomainProperty, PointsOutsideAreRefused) {
  testing::RandomRays random(41);
  for (const auto& example : testing::example_lenses()) {
    SCOPED_TRACE(example.name);
    const double limit_rad = max_angle_rad(example.lens);
    EXPECT_GT(limit_rad, 0.0);
    EXPECT_LT(limit_rad, kPi);
    for (int i = 0; i < 2000; ++i) {
      const double theta = i == 0 ? 1.001 * limit_rad : random.in(1.001 * limit_rad, kPi);
      const Eigen::Vector3d ray = testing::ray_at(theta, random.in(0.0, 2.0 * kPi));
      if (testing::angle_between_rad(ray, Eigen::Vector3d::UnitZ()) > limit_rad + 1e-9) {
        expect_refused(example.lens, random.in(0.01, 100.0) * ray);
      }
    }
  }
}

TEST(LensDomainProperty, TheJacobianExistsWhereTheImageDoes) {
  testing::RandomRays random(42);
  for (const auto& example : testing::example_lenses()) {
    SCOPED_TRACE(example.name);
    for (int i = 0; i < 3000; ++i) {
      const Eigen::Vector3d ray = random.ray(kPi);
      EXPECT_EQ(project(example.lens, ray).has_value(), jacobian(example.lens, ray).has_value());
    }
  }
}

TEST(LensDomainProperty, ARayOfAPixelLiesInTheDomainAndIsSeenThere) {
  testing::RandomRays random(43);
  for (const auto& example : testing::example_lenses()) {
    SCOPED_TRACE(example.name);
    const double limit_rad = max_angle_rad(example.lens);
    for (int i = 0; i < 6000; ++i) {
      const double reach = std::pow(10.0, random.in(0.0, 5.0));
      const Eigen::Vector2d pixel(random.in(-reach, reach), random.in(-reach, reach));
      const auto ray = unproject(example.lens, pixel);
      if (!ray) {
        continue;
      }
      ASSERT_NEAR(ray->norm(), 1.0, 1e-14);
      const double angle_rad = testing::angle_between_rad(*ray, Eigen::Vector3d::UnitZ());
      ASSERT_LE(angle_rad, limit_rad + 1e-9) << pixel.transpose();
      if (angle_rad < limit_rad - 1e-9) {
        const auto back = project(example.lens, *ray);
        ASSERT_TRUE(back.has_value()) << pixel.transpose();
        ASSERT_LT((*back - pixel).norm(), 1e-9 * (testing::focal_px(example.lens) + pixel.norm()))
            << pixel.transpose();
      }
    }
  }
}

TEST(LensDomainProperty, WildPointsGivePixelsOrNothing) {
  testing::RandomRays random(44);
  const auto lenses = testing::example_lenses();
  for (int i = 0; i < 100000; ++i) {
    const auto& example = lenses[static_cast<std::size_t>(i) % lenses.size()];
    Eigen::Vector3d point(
        random.wild(-300.0, 300.0), random.wild(-300.0, 300.0), random.wild(-300.0, 300.0));
    if (i % 3 == 0) {
      point = std::pow(10.0, random.in(-300.0, 300.0)) * random.ray(kPi);
    } else if (i % 7 == 0) {
      point = random.in(1.0, 2000.0) * kDenormal * random.ray(kPi);
    } else if (i % 11 == 0) {
      point[i % 3] = 0.0;
    }
    const auto pixel = project(example.lens, point);
    const auto slope = jacobian(example.lens, point);
    ASSERT_EQ(pixel.has_value(), slope.has_value()) << example.name << ": " << point.transpose();
    if (pixel) {
      ASSERT_TRUE(pixel->allFinite()) << example.name << ": " << point.transpose();
      // The slope goes with 1/|point| and may be too large for a number, but is one.
      ASSERT_FALSE(slope->hasNaN()) << example.name << ": " << point.transpose();
      ASSERT_TRUE(slope->allFinite() || point.norm() < 1e-290)
          << example.name << ": " << point.transpose();
    }
  }
}

TEST(LensDomainProperty, WildPixelsGiveUnitVectorsOrNothing) {
  testing::RandomRays random(45);
  const auto lenses = testing::example_lenses();
  for (int i = 0; i < 100000; ++i) {
    const auto& example = lenses[static_cast<std::size_t>(i) % lenses.size()];
    const Intrinsics& in = intrinsics(example.lens);
    Eigen::Vector2d pixel(random.wild(-300.0, 300.0), random.wild(-300.0, 300.0));
    if (i % 3 == 0) {
      pixel = Eigen::Vector2d(in.cx_px, in.cy_px) +
              Eigen::Vector2d(random.wild(-20.0, 6.0), random.wild(-20.0, 6.0));
    } else if (i % 7 == 0) {
      pixel = random.in(1.0, 2000.0) * kDenormal * Eigen::Vector2d(1.0, -1.0);
    } else if (i % 11 == 0) {
      pixel = {in.cx_px, random.wild(-300.0, 300.0)};
    }
    const auto ray = unproject(example.lens, pixel);
    if (ray) {
      ASSERT_TRUE(ray->allFinite()) << example.name << ": " << pixel.transpose();
      ASSERT_NEAR(ray->norm(), 1.0, 1e-14) << example.name << ": " << pixel.transpose();
    }
  }
}

}  // namespace
}  // namespace skyhalo

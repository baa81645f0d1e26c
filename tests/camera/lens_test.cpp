#include "skyhalo/camera/lens.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "support/example_lenses.hpp"
#include "support/expect_error.hpp"

namespace skyhalo {
namespace {

using ::testing::HasSubstr;
using testing::message_of;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// The point is imaged at the pixel, and the pixel sees the point.
void expect_pair(const Lens& lens,
                 const Eigen::Vector3d& point,
                 double expected_u_px,
                 double expected_v_px) {
  const auto pixel = project(lens, point);
  ASSERT_TRUE(pixel.has_value());
  EXPECT_NEAR(pixel->x(), expected_u_px, 1e-9);
  EXPECT_NEAR(pixel->y(), expected_v_px, 1e-9);
  const auto ray = unproject(lens, {expected_u_px, expected_v_px});
  ASSERT_TRUE(ray.has_value());
  EXPECT_LT(testing::angle_between_rad(*ray, point), 1e-9);
}

TEST(LensTest, APinholeDividesByTheDepth) {
  // (0.5, -0.25)/2 = (0.25, -0.125); 400 * 0.25 + 320, 410 * -0.125 + 240.
  expect_pair(
      RadialTangentialLens({400.0, 410.0, 320.0, 240.0}, {}), {0.5, -0.25, 2.0}, 420.0, 188.75);
}

TEST(LensTest, RadialAndTangentialByTheFormula) {
  // x 0.5, y 0: r^2 = 1/4, g = 1 - 0.025 + 0.000625 + 0.0005 = 0.976125; with p1 = 0.001 and
  // p2 = -0.002: x' = 0.4880625 - 0.002 * 0.75 = 0.4865625, y' = 0.001 * 0.25.
  expect_pair(
      RadialTangentialLens({400.0, 400.0, 320.0, 240.0}, {-0.1, 0.01, 0.001, -0.002, 0.032}),
      {1.0, 0.0, 2.0},
      514.625,
      240.1);
  // y 0.5, x 0: x' = p2 r^2 = -0.0005, y' = 0.4880625 + 0.001 * 0.75 = 0.4888125.
  expect_pair(
      RadialTangentialLens({400.0, 400.0, 320.0, 240.0}, {-0.1, 0.01, 0.001, -0.002, 0.032}),
      {0.0, 1.0, 2.0},
      319.8,
      435.525);
}

TEST(LensTest, RationalDistortionByTheFormula) {
  // r^2 = 1/4: above 1 + 0.1 + 0.01 + 0.01 = 1.12, below 1 + 0.2 + 0.02 - 0.02 = 1.2.
  expect_pair(
      RadialTangentialLens({300.0, 300.0, 0.0, 0.0}, {0.4, 0.16, 0.0, 0.0, 0.64, 0.8, 0.32, -1.28}),
      {0.5, 0.0, 1.0},
      140.0,
      0.0);
}

TEST(LensTest, KannalaBrandtByTheFormula) {
  const KannalaBrandtLens lens({400.0, 500.0, 320.0, 240.0}, {0.1, -0.02, 0.003, -0.0004});
  // theta 1: r = 1 + 0.1 - 0.02 + 0.003 - 0.0004 = 1.0826.
  expect_pair(lens, {3.0 * std::sin(1.0), 0.0, 3.0 * std::cos(1.0)}, 753.04, 240.0);
  expect_pair(lens, {0.0, -std::sin(1.0), std::cos(1.0)}, 320.0, -301.3);
  // theta 2, behind the camera: 2 (1 + 0.4 - 0.32 + 0.192 - 0.1024) = 2.3392; times (0.6, 0.8).
  expect_pair(lens, {0.6 * std::sin(2.0), 0.8 * std::sin(2.0), std::cos(2.0)}, 881.408, 1175.68);
}

TEST(LensTest, DoubleSphereByTheFormula) {
  // (12, 0, 5): d1 = 13, xi d1 + z = 9, d2 = 15, n = 0.4 * 15 + 0.6 * 9 = 11.4.
  expect_pair(DoubleSphereLens({114.0, 114.0, 320.0, 240.0}, {.xi = 4.0 / 13.0, .alpha = 0.4}),
              {12.0, 0.0, 5.0},
              440.0,
              240.0);
  // (0, 12, -5), behind the camera: d1 = 13, xi d1 + z = 5, d2 = 13, n = 0.6 * 13 + 0.4 * 5 = 9.8.
  expect_pair(DoubleSphereLens({98.0, 98.0, 320.0, 240.0}, {.xi = 10.0 / 13.0, .alpha = 0.6}),
              {0.0, 12.0, -5.0},
              320.0,
              360.0);
}

TEST(LensTest, ExtendedUnifiedByTheFormula) {
  // (1.5, 0, 4): rho = sqrt(4 * 2.25 + 16) = 5, n = 0.25 * 5 + 0.75 * 4 = 4.25.
  expect_pair(ExtendedUnifiedLens({425.0, 425.0, 320.0, 240.0}, {.alpha = 0.25, .beta = 4.0}),
              {1.5, 0.0, 4.0},
              470.0,
              240.0);
  // (0, 2, -3), behind the camera: rho = 5, n = 0.6 * 5 - 0.4 * 3 = 1.8.
  expect_pair(ExtendedUnifiedLens({180.0, 180.0, 320.0, 240.0}, {.alpha = 0.6, .beta = 4.0}),
              {0.0, 2.0, -3.0},
              320.0,
              440.0);
}

TEST(LensTest, TheAxisIsSeenAtThePrincipalPoint) {
  for (const auto& example : testing::example_lenses()) {
    SCOPED_TRACE(example.name);
    const Intrinsics& in = intrinsics(example.lens);
    expect_pair(example.lens, {0.0, 0.0, 7.0}, in.cx_px, in.cy_px);
  }
}

TEST(LensTest, GivesBackItsParameters) {
  const Intrinsics in{1.0, 2.0, 3.0, 4.0};
  const RadialTangentialLens::Distortion eight{0.01, 0.02, 0.03, 0.04, 0.05, 0.06, 0.07, 0.08};
  EXPECT_EQ(RadialTangentialLens(in, eight).distortion(), eight);
  const KannalaBrandtLens::Distortion four{0.01, 0.02, 0.03, 0.04};
  EXPECT_EQ(KannalaBrandtLens(in, four).distortion(), four);
  EXPECT_EQ(DoubleSphereLens(in, {.xi = 0.25, .alpha = 0.75}).shape().xi, 0.25);
  EXPECT_EQ(DoubleSphereLens(in, {.xi = 0.25, .alpha = 0.75}).shape().alpha, 0.75);
  EXPECT_EQ(ExtendedUnifiedLens(in, {.alpha = 0.75, .beta = 2.0}).shape().alpha, 0.75);
  EXPECT_EQ(ExtendedUnifiedLens(in, {.alpha = 0.75, .beta = 2.0}).shape().beta, 2.0);
  const Lens lens = KannalaBrandtLens(in, four);
  EXPECT_EQ(intrinsics(lens).fx_px, 1.0);
  EXPECT_EQ(intrinsics(lens).fy_px, 2.0);
  EXPECT_EQ(intrinsics(lens).cx_px, 3.0);
  EXPECT_EQ(intrinsics(lens).cy_px, 4.0);
}

TEST(LensTest, WrongIntrinsicsAreNamed) {
  const std::function<void(const Intrinsics&)> makers[] = {
      [](const Intrinsics& in) { RadialTangentialLens(in, {}); },
      [](const Intrinsics& in) { KannalaBrandtLens(in, {}); },
      [](const Intrinsics& in) { DoubleSphereLens(in, DoubleSphereLens::Shape{}); },
      [](const Intrinsics& in) { ExtendedUnifiedLens(in, ExtendedUnifiedLens::Shape{}); },
      [](const Intrinsics& in) { check(in); }};
  for (const auto& make : makers) {
    EXPECT_NO_THROW(make({400.0, 400.0, -20.0, 0.0}));
    for (const double focal : {0.0, -400.0, kNan, kInfinity, -kInfinity}) {
      SCOPED_TRACE(focal);
      EXPECT_THAT(message_of([&] {
                    make({focal, 400.0, 320.0, 240.0});
                  }),
                  HasSubstr("intrinsics_px"));
      EXPECT_THAT(message_of([&] {
                    make({400.0, focal, 320.0, 240.0});
                  }),
                  HasSubstr("intrinsics_px"));
    }
    for (const double centre : {kNan, kInfinity, -kInfinity}) {
      SCOPED_TRACE(centre);
      EXPECT_THAT(message_of([&] {
                    make({400.0, 400.0, centre, 240.0});
                  }),
                  HasSubstr("intrinsics_px"));
      EXPECT_THAT(message_of([&] {
                    make({400.0, 400.0, 320.0, centre});
                  }),
                  HasSubstr("intrinsics_px"));
    }
  }
}

TEST(LensTest, WrongDistortionIsNamed) {
  const Intrinsics in{400.0, 400.0, 320.0, 240.0};
  for (const double wrong : {kNan, kInfinity, -kInfinity}) {
    for (std::size_t i = 0; i < 8; ++i) {
      RadialTangentialLens::Distortion distortion{};
      distortion[i] = wrong;
      EXPECT_THAT(message_of([&] { RadialTangentialLens(in, distortion); }),
                  HasSubstr("distortion"));
    }
    for (std::size_t i = 0; i < 4; ++i) {
      KannalaBrandtLens::Distortion distortion{};
      distortion[i] = wrong;
      EXPECT_THAT(message_of([&] { KannalaBrandtLens(in, distortion); }), HasSubstr("distortion"));
    }
  }
}

TEST(LensTest, ShapesOutsideTheirDomainAreNamed) {
  const Intrinsics in{400.0, 400.0, 320.0, 240.0};
  const auto double_sphere = [&](double xi, double alpha) {
    return message_of([&] { DoubleSphereLens(in, {.xi = xi, .alpha = alpha}); });
  };
  const auto extended = [&](double alpha, double beta) {
    return message_of([&] { ExtendedUnifiedLens(in, {.alpha = alpha, .beta = beta}); });
  };
  for (const double alpha : {-1e-9, 1.0 + 1e-9, -3.0, 7.0, kNan, kInfinity, -kInfinity}) {
    SCOPED_TRACE(alpha);
    EXPECT_THAT(double_sphere(0.1, alpha), HasSubstr("distortion"));
    EXPECT_THAT(extended(alpha, 1.0), HasSubstr("distortion"));
  }
  for (const double xi : {-1.0, -1.5, 1.0 + 1e-9, 4.0, kNan, kInfinity, -kInfinity}) {
    SCOPED_TRACE(xi);
    EXPECT_THAT(double_sphere(xi, 0.6), HasSubstr("distortion"));
  }
  for (const double beta : {0.0, -1e-9, -2.0, kNan, kInfinity, -kInfinity}) {
    SCOPED_TRACE(beta);
    EXPECT_THAT(extended(0.6, beta), HasSubstr("distortion"));
  }
}

TEST(LensProperty, APointComesBackFromItsPixel) {
  testing::RandomRays random(31);
  for (const auto& example : testing::example_lenses()) {
    SCOPED_TRACE(example.name);
    for (int i = 0; i < 4000; ++i) {
      const Eigen::Vector3d ray =
          i % 10 == 0 ? testing::ray_at(0.999 * max_angle_rad(example.lens), 0.1 * i)
                      : random.ray(0.999 * max_angle_rad(example.lens));
      const auto pixel = project(example.lens, random.in(0.01, 100.0) * ray);
      ASSERT_TRUE(pixel.has_value()) << ray.transpose();
      const auto back = unproject(example.lens, *pixel);
      ASSERT_TRUE(back.has_value()) << ray.transpose() << " at " << pixel->transpose();
      EXPECT_NEAR(back->norm(), 1.0, 1e-14);
      ASSERT_LT(testing::angle_between_rad(*back, ray), 1e-9) << ray.transpose();
    }
  }
}

TEST(LensProperty, RaysCloseToTheAxisComeBack) {
  for (const auto& example : testing::example_lenses()) {
    SCOPED_TRACE(example.name);
    for (double angle_rad = 1e-3; angle_rad > 1e-12; angle_rad /= 3.0) {
      const Eigen::Vector3d ray = testing::ray_at(angle_rad, 1e6 * angle_rad);
      const auto pixel = project(example.lens, ray);
      ASSERT_TRUE(pixel.has_value()) << angle_rad;
      const auto back = unproject(example.lens, *pixel);
      ASSERT_TRUE(back.has_value()) << angle_rad;
      EXPECT_LT(testing::angle_between_rad(*back, ray), 1e-13) << angle_rad;
    }
  }
}

TEST(LensProperty, APixelOfTheImageComesBackFromItsRay) {
  for (const auto& example : testing::example_lenses()) {
    SCOPED_TRACE(example.name);
    int seen = 0;
    for (double v_px = 0.0; v_px < example.size_px.height; v_px += 7.3) {
      for (double u_px = 0.0; u_px < example.size_px.width; u_px += 7.7) {
        const auto ray = unproject(example.lens, {u_px, v_px});
        if (!ray || testing::angle_between_rad(*ray, Eigen::Vector3d::UnitZ()) >
                        0.999999 * max_angle_rad(example.lens)) {
          continue;
        }
        ++seen;
        EXPECT_NEAR(ray->norm(), 1.0, 1e-14);
        const auto back = project(example.lens, *ray);
        ASSERT_TRUE(back.has_value()) << u_px << ' ' << v_px;
        ASSERT_LT((*back - Eigen::Vector2d(u_px, v_px)).norm(),
                  1e-9 * testing::focal_px(example.lens));
      }
    }
    EXPECT_GT(seen, 1000);
  }
}

TEST(LensProperty, TheImageDependsOnTheDirectionAlone) {
  testing::RandomRays random(32);
  for (const auto& example : testing::example_lenses()) {
    SCOPED_TRACE(example.name);
    for (int i = 0; i < 2000; ++i) {
      const Eigen::Vector3d ray = random.ray(0.999 * max_angle_rad(example.lens));
      const auto near = project(example.lens, ray);
      const auto far = project(example.lens, std::pow(10.0, random.in(-280.0, 280.0)) * ray);
      ASSERT_TRUE(near.has_value() && far.has_value()) << ray.transpose();
      ASSERT_LT((*near - *far).norm(), 1e-10 * (testing::focal_px(example.lens) + near->norm()));
    }
  }
}

TEST(LensProperty, TheJacobianIsTheSlope) {
  testing::RandomRays random(33);
  for (const auto& example : testing::example_lenses()) {
    SCOPED_TRACE(example.name);
    for (int i = 0; i < 1000; ++i) {
      const double scale = random.in(0.1, 50.0);
      const Eigen::Vector3d point = scale * random.ray(0.99 * max_angle_rad(example.lens));
      const auto slope = jacobian(example.lens, point);
      ASSERT_TRUE(slope.has_value());
      const double step = 1e-5 * scale;
      LensJacobian expected;
      for (int axis = 0; axis < 3; ++axis) {
        const auto at = [&](double steps) {
          return project(example.lens, point + steps * step * Eigen::Vector3d::Unit(axis)).value();
        };
        expected.col(axis) = (8.0 * (at(1.0) - at(-1.0)) - (at(2.0) - at(-2.0))) / (12.0 * step);
      }
      const double size = expected.norm() + testing::focal_px(example.lens) / scale;
      ASSERT_LT((*slope - expected).norm(), 1e-7 * size) << point.transpose();
      // Along the ray nothing moves.
      ASSERT_LT((*slope * point).norm(), 1e-12 * slope->norm() * scale) << point.transpose();
    }
  }
}

}  // namespace
}  // namespace skyhalo

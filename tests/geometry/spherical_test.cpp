#include "skyhalo/geometry/spherical.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>

namespace skyhalo {
namespace {

constexpr double kPi = std::numbers::pi;

void expect_spherical(const Eigen::Vector3d& p_body_m, const SphericalPoint& expected) {
  const SphericalPoint point = to_spherical(p_body_m);
  EXPECT_NEAR(point.rho_m, expected.rho_m, 1e-14);
  EXPECT_NEAR(point.theta_rad, expected.theta_rad, 1e-14);
  EXPECT_NEAR(point.phi_rad, expected.phi_rad, 1e-14);
}

TEST(SphericalTest, KnowsTheAxesOfTheBody) {
  expect_spherical({2.0, 0.0, 0.0}, {2.0, kPi / 2.0, 0.0});          // forward
  expect_spherical({0.0, 3.0, 0.0}, {3.0, kPi / 2.0, kPi / 2.0});    // left
  expect_spherical({0.0, -3.0, 0.0}, {3.0, kPi / 2.0, -kPi / 2.0});  // right
}

TEST(SphericalTest, KnowsThePoles) {
  expect_spherical({0.0, 0.0, 4.0}, {4.0, 0.0, 0.0});
  expect_spherical({0.0, 0.0, -5.0}, {5.0, kPi, 0.0});
  EXPECT_TRUE(direction(0.0, 1.0).isApprox(Eigen::Vector3d(0.0, 0.0, 1.0), 1e-15));
  EXPECT_NEAR(direction(kPi, 1.0).z(), -1.0, 1e-15);
  EXPECT_LT(direction(kPi, 1.0).head<2>().norm(), 1e-15);
}

TEST(SphericalTest, KnowsTheSeamBehindTheVehicle) {
  expect_spherical({-1.0, 0.0, 0.0}, {1.0, kPi / 2.0, kPi});
  expect_spherical({-1.0, -0.0, 0.0}, {1.0, kPi / 2.0, -kPi});
  EXPECT_LT(to_spherical({-1.0, -1e-9, 0.0}).phi_rad, -3.14);
  EXPECT_GT(to_spherical({-1.0, 1e-9, 0.0}).phi_rad, 3.14);
}

TEST(SphericalTest, KnowsASlantedPoint) {
  // (3, 4, 12): rho = 13, cos(theta) = 12/13, tan(phi) = 4/3.
  expect_spherical({3.0, 4.0, 12.0}, {13.0, std::atan2(5.0, 12.0), std::atan2(4.0, 3.0)});
}

TEST(SphericalTest, TheOriginHasNoDirection) {
  const SphericalPoint point = to_spherical(Eigen::Vector3d::Zero());
  EXPECT_EQ(point.rho_m, 0.0);
  EXPECT_EQ(point.theta_rad, 0.0);
  EXPECT_EQ(point.phi_rad, 0.0);
}

TEST(SphericalTest, NanStaysNan) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  const SphericalPoint point = to_spherical({kNan, 1.0, 1.0});
  EXPECT_TRUE(std::isnan(point.rho_m));
  EXPECT_TRUE(std::isnan(point.theta_rad));
  EXPECT_TRUE(std::isnan(point.phi_rad));
}

TEST(SphericalProperty, DirectionIsTheInverse) {
  std::mt19937 random(13);
  std::normal_distribution<double> coordinate_m(0.0, 20.0);
  for (int i = 0; i < 2000; ++i) {
    const Eigen::Vector3d p_body_m(
        coordinate_m(random), coordinate_m(random), coordinate_m(random));
    const SphericalPoint point = to_spherical(p_body_m);
    const Eigen::Vector3d back_m = point.rho_m * direction(point.theta_rad, point.phi_rad);
    EXPECT_TRUE(back_m.isApprox(p_body_m, 1e-12)) << p_body_m.transpose();
  }
}

TEST(SphericalProperty, AnglesComeBackFromTheirDirection) {
  std::mt19937 random(14);
  std::uniform_real_distribution<double> theta_rad(0.01, kPi - 0.01);
  std::uniform_real_distribution<double> phi_rad(-kPi + 1e-6, kPi - 1e-6);
  for (int i = 0; i < 2000; ++i) {
    const double theta = theta_rad(random);
    const double phi = phi_rad(random);
    const Eigen::Vector3d unit = direction(theta, phi);
    EXPECT_NEAR(unit.norm(), 1.0, 1e-15);
    EXPECT_NEAR(to_spherical(unit).theta_rad, theta, 1e-12);
    EXPECT_NEAR(to_spherical(unit).phi_rad, phi, 1e-12);
  }
}

TEST(SphericalProperty, NearThePolesTheAnglesStayInTheirDomain) {
  std::mt19937 random(15);
  std::uniform_real_distribution<double> tiny_m(-1e-9, 1e-9);
  for (int i = 0; i < 2000; ++i) {
    const double z_m = i % 2 == 0 ? 7.0 : -7.0;
    const SphericalPoint point = to_spherical({tiny_m(random), tiny_m(random), z_m});
    EXPECT_NEAR(point.theta_rad, z_m > 0.0 ? 0.0 : kPi, 1e-7);
    EXPECT_LE(std::abs(point.phi_rad), kPi);
  }
}

}  // namespace
}  // namespace skyhalo

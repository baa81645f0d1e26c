#include "skyhalo/geometry/angle.hpp"

#include <gtest/gtest.h>

#include <numbers>
#include <random>

namespace skyhalo {
namespace {

TEST(AngleTest, KnowsTheQuarterTurns) {
  EXPECT_DOUBLE_EQ(rad_from_deg(180.0), std::numbers::pi);
  EXPECT_DOUBLE_EQ(rad_from_deg(-90.0), -std::numbers::pi / 2.0);
  EXPECT_DOUBLE_EQ(deg_from_rad(std::numbers::pi / 3.0), 60.0);
  EXPECT_EQ(rad_from_deg(0.0), 0.0);
}

TEST(AngleTest, IsAConstantExpression) {
  static_assert(rad_from_deg(0.0) == 0.0);
  constexpr double kRight = deg_from_rad(std::numbers::pi / 2.0);
  EXPECT_DOUBLE_EQ(kRight, 90.0);
}

TEST(AngleProperty, DegreesComeBack) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> angle_deg(-1000.0, 1000.0);
  for (int i = 0; i < 1000; ++i) {
    const double expected_deg = angle_deg(random);
    EXPECT_NEAR(deg_from_rad(rad_from_deg(expected_deg)), expected_deg, 1e-12 * 1000.0);
  }
}

}  // namespace
}  // namespace skyhalo

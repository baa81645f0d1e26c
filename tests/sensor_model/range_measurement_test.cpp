#include "skyhalo/sensor_model/range_measurement.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

namespace skyhalo {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();
constexpr double kHalfPi = 0.5 * std::numbers::pi;

RangeMeasurement echo(double range_m) {
  RangeMeasurement measurement;
  measurement.range_m = range_m;
  return measurement;
}

/// No length or angle that a measurement could have.
std::vector<double> no_measures() {
  return {0.0, -1.0, kNan, kInf, -kInf};
}

TEST(RangeMeasurementTest, DefaultsAreValid) {
  EXPECT_TRUE(is_valid(RangeMeasurement{})) << "no echo";
  EXPECT_TRUE(is_valid(echo(3.0)));
  EXPECT_TRUE(is_valid(echo(1e-6)));
}

TEST(RangeMeasurementTest, ARangeIsAboveZero) {
  for (const double range_m : no_measures()) {
    EXPECT_FALSE(is_valid(echo(range_m))) << range_m;
  }
}

TEST(RangeMeasurementTest, SoIsHowFarTheSensorHears) {
  for (const double range_m : no_measures()) {
    RangeMeasurement measurement;
    measurement.max_range_m = range_m;
    EXPECT_FALSE(is_valid(measurement)) << range_m;
    measurement.range_m = 2.0;
    EXPECT_FALSE(is_valid(measurement)) << range_m;
  }
}

TEST(RangeMeasurementTest, SoIsTheUncertainty) {
  for (const double delta_z_m : no_measures()) {
    RangeMeasurement measurement = echo(2.0);
    measurement.delta_z_m = delta_z_m;
    EXPECT_FALSE(is_valid(measurement)) << delta_z_m;
  }
}

TEST(RangeMeasurementTest, ABeamIsAtMostHalfOfAllDirections) {
  RangeMeasurement measurement = echo(2.0);
  for (const double half_angle_rad : no_measures()) {
    measurement.half_angle_rad = half_angle_rad;
    EXPECT_FALSE(is_valid(measurement)) << half_angle_rad;
  }
  measurement.half_angle_rad = kHalfPi;
  EXPECT_TRUE(is_valid(measurement));
  measurement.half_angle_rad = 1e-9;
  EXPECT_TRUE(is_valid(measurement));
  measurement.half_angle_rad = std::nextafter(kHalfPi, 2.0);
  EXPECT_FALSE(is_valid(measurement));
}

TEST(RangeMeasurementTest, ThePlaceOfTheSensorIsFinite) {
  for (const double bad : {kNan, kInf}) {
    RangeMeasurement measurement = echo(2.0);
    measurement.T_body_sensor.translation().y() = bad;
    EXPECT_FALSE(is_valid(measurement));
    measurement = echo(2.0);
    measurement.T_body_sensor.linear()(2, 1) = bad;
    EXPECT_FALSE(is_valid(measurement));
  }
}

TEST(BeamWeightTest, IsAParabola) {
  EXPECT_DOUBLE_EQ(beam_weight(0.0, 0.2), 1.0);
  EXPECT_DOUBLE_EQ(beam_weight(0.1, 0.2), 0.75);
  EXPECT_NEAR(beam_weight(0.15, 0.2), 0.4375, 1e-12);
  EXPECT_DOUBLE_EQ(beam_weight(0.2, 0.2), 0.0);
  EXPECT_DOUBLE_EQ(beam_weight(0.3, 0.2), 0.0);
  EXPECT_DOUBLE_EQ(beam_weight(3.0, 0.2), 0.0);
}

}  // namespace
}  // namespace skyhalo

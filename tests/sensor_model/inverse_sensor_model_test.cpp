#include "skyhalo/sensor_model/inverse_sensor_model.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "reference/naive_sensor_model.hpp"
#include "skyhalo/camera/pinhole_pair.hpp"
#include "support/expect_error.hpp"

namespace skyhalo {
namespace {

using ::testing::HasSubstr;
using testing::message_of;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();

/// With the thesis's k 0.75, p_unknown 0.5, p_free 0.3 and this uncertainty, exp(-delta_z) is 2/3:
/// a = 0.75 * 0.5 * 2/3 = 0.25 (eq. 6.5) and a / (a + 1 - 0.6) = 0.25 / 0.65 = 5/13, so that
/// c = delta_z * sqrt(ln(18/13) / ln 2) (eq. 6.6).
const double kDeltaZM = std::log(1.5);
constexpr double kZM = 10.0;

InverseSensorModel thesis_model() {
  return {SensorModelConfig{}, kZM, kDeltaZM};
}

std::string refusal(const SensorModelConfig& config) {
  return message_of([&] { check(config); });
}

TEST(InverseSensorModelTest, ThePeakAndTheWidthBehindIt) {
  EXPECT_NEAR(thesis_model().peak(), 0.25, 1e-12);
  EXPECT_NEAR(thesis_model().width_behind_m(),
              kDeltaZM * std::sqrt(std::log(18.0 / 13.0) / std::numbers::ln2),
              1e-12);
  EXPECT_NEAR(thesis_model().width_behind_m(), 0.2778, 1e-4);  // 0.40547 * 0.68519
}

TEST(InverseSensorModelTest, TheMeasurementItselfHasThePeak) {
  EXPECT_NEAR(thesis_model().probability(kZM), 0.75, 1e-12);  // p_unknown + a
}

TEST(InverseSensorModelTest, TheCurveHasNoStepAtTheMeasurement) {
  const InverseSensorModel model = thesis_model();
  EXPECT_NEAR(model.probability(kZM - 1e-9), model.probability(kZM + 1e-9), 1e-8);
}

TEST(InverseSensorModelTest, FarInFrontIsFree) {
  EXPECT_NEAR(thesis_model().probability(1.0), 0.3, 1e-12);
  EXPECT_NEAR(thesis_model().probability(1e-9), 0.3, 1e-12);
}

TEST(InverseSensorModelTest, OneDeviationInFront) {
  // 0.3 + (0.25 + 0.5 - 0.3) exp(-1/2) = 0.3 + 0.45 * 0.60653.
  EXPECT_NEAR(thesis_model().probability(kZM - kDeltaZM), 0.572939, 1e-6);
}

TEST(InverseSensorModelTest, OneWidthBehind) {
  // 0.5 + 0.25 exp(-1/2) = 0.5 + 0.25 * 0.60653.
  const InverseSensorModel model = thesis_model();
  EXPECT_NEAR(model.probability(kZM + model.width_behind_m()), 0.651633, 1e-6);
}

TEST(InverseSensorModelTest, FarBehindIsUnknown) {
  EXPECT_NEAR(thesis_model().probability(kZM + 5.0), 0.5, 1e-12);
  EXPECT_NEAR(thesis_model().probability(1e6), 0.5, 1e-12);
}

TEST(InverseSensorModelTest, TheHalfHeightPointsAreSymmetric) {
  // p = 0.5 + a/2 = 0.625 at delta_z sqrt(2 ln(18/13)) on either side: in front
  // exp(-x^2/2) = 0.325/0.45 = 13/18, behind exp(-ln 2) = 1/2.
  const double half_m = kDeltaZM * std::sqrt(2.0 * std::log(18.0 / 13.0));
  EXPECT_NEAR(thesis_model().probability(kZM - half_m), 0.625, 1e-12);
  EXPECT_NEAR(thesis_model().probability(kZM + half_m), 0.625, 1e-12);
}

TEST(InverseSensorModelTest, RemembersItsMeasurement) {
  EXPECT_EQ(thesis_model().z_m(), kZM);
}

TEST(InverseSensorModelTest, AFarMeasurementMarksNothing) {
  // B 0.54 m, f 360 px: at 100 m delta_z is 10000 * 0.5 / 194.4 = 25.7 m and a is 0.375 e^-25.7.
  const PinholePair pair{.focal_px = 360.0, .baseline_m = 0.54};
  const InverseSensorModel model(SensorModelConfig{}, 100.0, delta_z_m(pair, 100.0, 0.5));
  EXPECT_LT(model.peak(), 1e-11);
  EXPECT_NEAR(model.probability(100.0), 0.5, 1e-9);
  EXPECT_NEAR(model.probability(110.0), 0.5, 1e-9);
  EXPECT_LT(model.probability(10.0), 0.31);  // but it clears
}

TEST(InverseSensorModelTest, AnUncertaintyBeyondAllBoundsStaysFinite) {
  const InverseSensorModel model(SensorModelConfig{}, 1e4, 1e9);
  EXPECT_NEAR(model.probability(1e4), 0.5, 1e-9);
  EXPECT_EQ(model.probability(2e4), 0.5);
  EXPECT_EQ(model.peak(), 0.0);
  EXPECT_EQ(model.width_behind_m(), 0.0);
}

TEST(InverseSensorModelTest, AnExactMeasurementHasASharpPeak) {
  // a is almost k (1 - p_unknown) = 0.375.
  const InverseSensorModel model(SensorModelConfig{}, 2.0, 1e-6);
  EXPECT_NEAR(model.probability(2.0), 0.875, 1e-6);
  EXPECT_NEAR(model.probability(1.999), 0.3, 1e-12);
  EXPECT_NEAR(model.probability(2.001), 0.5, 1e-12);
}

TEST(InverseSensorModelTest, FreeUntilIsWhereTheCurveIsFlat) {
  const InverseSensorModel model = thesis_model();
  EXPECT_NEAR(model.probability(model.free_until_m()), 0.3, 1e-8);
  EXPECT_LT(model.free_until_m(), kZM);
  EXPECT_GT(model.free_until_m(), kZM - 10.0 * kDeltaZM);
}

TEST(InverseSensorModelTest, RangeUncertaintyOfAPinholePair) {
  // z^2 delta_d / (B f) = 100 * 0.5 / (0.5 * 400) = 0.25 m.
  const PinholePair pair{.focal_px = 400.0, .baseline_m = 0.5};
  EXPECT_NEAR(delta_z_m(pair, 10.0, 0.5), 0.25, 1e-12);
  EXPECT_NEAR(delta_z_m(pair, 20.0, 0.5), 1.0, 1e-12);
  EXPECT_NEAR(delta_z_m(pair, 10.0, 1.0), 0.5, 1e-12);
}

TEST(InverseSensorModelTest, TheDefaultsAreTheThesissValues) {
  const SensorModelConfig config;
  EXPECT_EQ(config.k, 0.75);
  EXPECT_EQ(config.p_unknown, 0.5);
  EXPECT_EQ(config.p_free, 0.3);
  EXPECT_NO_THROW(check(config));
}

TEST(InverseSensorModelTest, RefusesSettingsOutsideTheirDomain) {
  for (const double value : {-0.1, 0.0, 1.0, 2.0, kNan}) {
    EXPECT_THAT(refusal({.k = value}), HasSubstr("sensor_model.k")) << value;
  }
  for (const double value : {-0.3, 0.0, 0.51, 1.0, kNan}) {
    EXPECT_THAT(refusal({.p_unknown = 0.9, .p_free = value}), HasSubstr("sensor_model.p_free"));
  }
}

TEST(InverseSensorModelTest, RefusesAnUnknownProbabilityOrADisparityErrorOutsideItsDomain) {
  for (const double value : {-0.5, 0.0, 0.29, 1.0, 1.5, kNan}) {
    EXPECT_THAT(refusal({.p_unknown = value}), HasSubstr("sensor_model.p_unknown")) << value;
  }
  for (const double value : {-0.5, 0.0, kInf, kNan}) {
    EXPECT_THAT(refusal({.delta_d_px = value}), HasSubstr("sensor_model.delta_d_px")) << value;
  }
}

TEST(InverseSensorModelTest, AcceptsSettingsInsideTheirDomain) {
  EXPECT_NO_THROW(check({.k = 0.001, .p_unknown = 0.999, .p_free = 0.5, .delta_d_px = 100.0}));
  EXPECT_NO_THROW(check({.k = 0.999, .p_unknown = 0.01, .p_free = 0.001, .delta_d_px = 0.001}));
}

TEST(InverseSensorModelTest, AFreeProbabilityAsHighAsTheUnknownOneIsRefused) {
  // p_unknown lies in (p_free, 1).
  EXPECT_THAT(refusal({.p_unknown = 0.3, .p_free = 0.3}), HasSubstr("sensor_model.p_unknown"));
}

struct RandomModel {
  SensorModelConfig config;
  double z_m = 0.0;
  double delta_z_m = 0.0;
};

RandomModel random_model(std::mt19937& random) {
  std::uniform_real_distribution<double> unit(0.001, 0.999);
  RandomModel result;
  result.config.k = unit(random);
  result.config.p_free = 0.5 * unit(random);
  result.config.p_unknown = result.config.p_free + (1.0 - result.config.p_free) * unit(random);
  result.z_m = 50.0 * unit(random);
  result.delta_z_m = std::pow(10.0, -4.0 + 6.0 * unit(random));
  return result;
}

TEST(InverseSensorModelProperty, RisesToTheMeasurementAndFallsBehindIt) {
  std::mt19937 random(51);
  for (int i = 0; i < 300; ++i) {
    const RandomModel draw = random_model(random);
    const InverseSensorModel model(draw.config, draw.z_m, draw.delta_z_m);
    constexpr int kSteps = 200;
    for (int step = 1; step < kSteps; ++step) {
      const double before = draw.z_m * step / kSteps;
      EXPECT_LE(model.probability(before),
                model.probability(draw.z_m * (step + 1) / kSteps) + 1e-15);
      const double behind = draw.z_m + 4.0 * draw.delta_z_m * (step - 1) / kSteps;
      const double farther = draw.z_m + 4.0 * draw.delta_z_m * step / kSteps;
      EXPECT_GE(model.probability(behind) + 1e-15, model.probability(farther));
    }
  }
}

TEST(InverseSensorModelProperty, StaysBetweenFreeAndThePeak) {
  std::mt19937 random(52);
  std::uniform_real_distribution<double> distance_m(1e-6, 100.0);
  for (int i = 0; i < 5000; ++i) {
    const RandomModel draw = random_model(random);
    const InverseSensorModel model(draw.config, draw.z_m, draw.delta_z_m);
    const double m_m = distance_m(random);
    const double p = model.probability(m_m);
    EXPECT_GE(p, (m_m <= draw.z_m ? draw.config.p_free : draw.config.p_unknown) - 1e-15);
    EXPECT_LE(p, draw.config.p_unknown + model.peak() + 1e-15);
    EXPECT_LT(p, 1.0);
  }
}

TEST(InverseSensorModelProperty, HalfHeightIsSymmetricForAnyModelWithUnknownAtAHalf) {
  std::mt19937 random(53);
  for (int i = 0; i < 1000; ++i) {
    RandomModel draw = random_model(random);
    draw.config.p_unknown = 0.5;
    draw.config.p_free *= 0.9;
    draw.delta_z_m = std::min(draw.delta_z_m, 3.0);
    const InverseSensorModel model(draw.config, draw.z_m, draw.delta_z_m);
    const double half_m = model.width_behind_m() * std::sqrt(2.0 * std::numbers::ln2);
    EXPECT_NEAR(model.probability(draw.z_m + half_m), 0.5 + model.peak() / 2.0, 1e-9);
    EXPECT_NEAR(model.probability(draw.z_m - half_m), 0.5 + model.peak() / 2.0, 1e-9);
  }
}

TEST(InverseSensorModelProperty, WhatFreeUntilLeavesOutIsNegligible) {
  std::mt19937 random(54);
  for (int i = 0; i < 1000; ++i) {
    const RandomModel draw = random_model(random);
    const InverseSensorModel model(draw.config, draw.z_m, draw.delta_z_m);
    EXPECT_NEAR(
        model.probability(model.free_until_m()), draw.config.p_free, 2e-8);  // exp(-18) = 1.5e-8
  }
}

TEST(InverseSensorModelReference, AgreesOnRandomModels) {
  std::mt19937 random(55);
  std::uniform_real_distribution<double> deviations(-8.0, 8.0);
  std::uniform_real_distribution<double> distance_m(1e-6, 100.0);
  for (int i = 0; i < 5000; ++i) {
    const RandomModel draw = random_model(random);
    const InverseSensorModel model(draw.config, draw.z_m, draw.delta_z_m);
    const reference::NaiveSensorModel naive{
        draw.config.k, draw.config.p_unknown, draw.config.p_free};
    EXPECT_NEAR(model.peak(), reference::naive_peak(naive, draw.delta_z_m), 1e-14);
    const double near_m = draw.z_m + deviations(random) * draw.delta_z_m;
    for (const double m_m : {near_m, distance_m(random), draw.z_m}) {
      EXPECT_NEAR(model.probability(m_m),
                  reference::naive_probability(naive, m_m, draw.z_m, draw.delta_z_m),
                  1e-9);
    }
  }
}

TEST(InverseSensorModelReference, AgreesOnTheRangeUncertainty) {
  std::mt19937 random(56);
  std::uniform_real_distribution<double> value(0.05, 2.0);
  for (int i = 0; i < 1000; ++i) {
    const PinholePair pair{.focal_px = 1000.0 * value(random), .baseline_m = value(random)};
    const double z_m = 30.0 * value(random);
    const double delta_d_px = value(random);
    const double expected_m =
        reference::naive_pinhole_delta_z_m(z_m, pair.baseline_m, pair.focal_px, delta_d_px);
    EXPECT_NEAR(delta_z_m(pair, z_m, delta_d_px), expected_m, 1e-12 * expected_m);
  }
}

}  // namespace
}  // namespace skyhalo

#include "skyhalo/sensor_model/sensor_model_curves.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "reference/naive_sensor_model.hpp"

namespace skyhalo {
namespace {

using ::testing::IsEmpty;
using ::testing::SizeIs;

/// B 0.1 m, f 500 px, delta_d 0.5 px (figure 6.1): delta_z = z^2 * 0.5 / 50 = z^2 / 100.
const PairModel kPinhole = PinholePair{.focal_px = 500.0, .baseline_m = 0.1};
/// delta_z = 0.1 * 0.002 * (1 + (z / 0.1)^2) * 0.5 = 1e-4 (1 + 100 z^2).
const PairModel kSpherical =
    SphericalPair{.delta_theta_u_rad = 0.002, .delta_theta_v_rad = 0.002, .baseline_m = 0.1};
/// Those of figures 4.1 and 4.2.
const PairModel kFigure41 = PinholePair{
    .focal_px = 250.0, .principal_u_px = 600.0, .principal_v_px = 600.0, .baseline_m = 0.1};
const PairModel kFigure42 = SphericalPair{.delta_theta_u_rad = 0.002,
                                          .delta_theta_v_rad = 0.002,
                                          .principal_u_px = 600.0,
                                          .principal_v_px = 600.0,
                                          .baseline_m = 0.1};

constexpr std::array kRangesM{1.0, 2.0, 5.0, 10.0};

ModelCurve one_curve(const PairModel& pair, const SensorModelConfig& config, double z_m) {
  return model_curves(pair, config, {&z_m, 1}).front();
}

TEST(SensorModelCurvesTest, ThePinholesUncertainty) {
  const auto curves = model_curves(kPinhole, {}, kRangesM);
  ASSERT_THAT(curves, SizeIs(4));
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(curves[i].z_m, kRangesM[i]);
    EXPECT_NEAR(curves[i].delta_z_m, kRangesM[i] * kRangesM[i] / 100.0, 1e-12);
  }
}

TEST(SensorModelCurvesTest, TheSphericalsUncertainty) {
  EXPECT_NEAR(one_curve(kSpherical, {}, 2.0).delta_z_m, 0.0401, 1e-12);
  EXPECT_NEAR(one_curve(kSpherical, {.delta_d_px = 1.0}, 2.0).delta_z_m, 0.0802, 1e-12);
}

TEST(SensorModelCurvesTest, ThePeakIsAtTheMeasurement) {
  // p_unknown + k (1 - p_unknown) exp(-delta_z) = 0.5 + 0.375 exp(-z^2 / 100).
  for (const ModelCurve& curve : model_curves(kPinhole, {}, kRangesM)) {
    const double expected = 0.5 + 0.375 * std::exp(-curve.z_m * curve.z_m / 100.0);
    EXPECT_NEAR(curve.peak_probability, expected, 1e-12);
    const auto highest = std::max_element(curve.samples.begin(),
                                          curve.samples.end(),
                                          [](const auto& a, const auto& b) { return a.p < b.p; });
    EXPECT_EQ(highest->m_m, curve.z_m);
    EXPECT_EQ(highest->p, curve.peak_probability);
  }
}

TEST(SensorModelCurvesTest, TheCurveIsFreeInFrontAndUnknownBehind) {
  const ModelCurve curve = one_curve(kPinhole, {}, 5.0);
  EXPECT_NEAR(curve.samples.front().p, 0.3, 1e-9);
  EXPECT_NEAR(curve.samples.back().p, 0.5, 1e-3);
}

TEST(SensorModelCurvesTest, AllCurvesEndAtTheSameDistance) {
  // The farthest, 10 m: a = 0.375 / e = 0.13796, c = sqrt(ln(1 + a / (a + 0.4)) / ln 2) * 1 m
  // = sqrt(ln(1.25645) / ln 2) = 0.57397, and 10 + 4 c = 12.2959.
  for (const ModelCurve& curve : model_curves(kPinhole, {}, kRangesM)) {
    EXPECT_NEAR(curve.samples.back().m_m, 12.2959, 1e-3);
  }
  EXPECT_NEAR(one_curve(kPinhole, {}, 1.0).samples.back().m_m, 1.1, 1e-12);
}

TEST(SensorModelCurvesTest, TheBellIsResolved) {
  // The nearest one, delta_z = 1 cm, over 12 m: still at most a tenth of delta_z from sample to
  // sample within three deviations.
  const ModelCurve curve = model_curves(kPinhole, {}, kRangesM).front();
  for (std::size_t i = 1; i < curve.samples.size(); ++i) {
    if (std::abs(curve.samples[i].m_m - 1.0) < 0.03) {
      EXPECT_LT(curve.samples[i].m_m - curve.samples[i - 1].m_m, 0.0011);
    }
  }
}

TEST(SensorModelCurvesTest, AMeasurementTooFarToMarkAnythingStillClears) {
  const ModelCurve curve = one_curve(kPinhole, {}, 1000.0);  // delta_z 10 km
  EXPECT_EQ(curve.peak_probability, 0.5);
  EXPECT_EQ(curve.samples.back().m_m, 1100.0);
  EXPECT_LT(curve.samples.front().p, 0.5);
}

TEST(SensorModelCurvesTest, NoMeasurementsNoCurves) {
  EXPECT_THAT(model_curves(kPinhole, {}, {}), IsEmpty());
}

TEST(SensorModelCurvesTest, WhereThePeakFallsToTheThreshold) {
  // 0.375 exp(-delta_z) = 0.2: delta_z = ln 1.875 = 0.628609, z = 10 sqrt(0.628609).
  EXPECT_NEAR(occupied_until_m(kPinhole, {}, 0.7), 7.92848, 1e-5);
  // 1e-4 (1 + 100 z^2) = 0.628609.
  EXPECT_NEAR(occupied_until_m(kSpherical, {}, 0.7), std::sqrt(62.85086), 1e-5);
}

TEST(SensorModelCurvesTest, AThresholdOutOfReachOrAlreadyReached) {
  EXPECT_EQ(occupied_until_m(kPinhole, {}, 0.875), 0.0);
  EXPECT_EQ(occupied_until_m(kPinhole, {.k = 0.3}, 0.7), 0.0);
  EXPECT_EQ(occupied_until_m(kPinhole, {}, 0.5), std::numeric_limits<double>::infinity());
  EXPECT_EQ(occupied_until_m(kPinhole, {.p_unknown = 0.8}, 0.7),
            std::numeric_limits<double>::infinity());
}

TEST(SensorModelCurvesTest, APinholeColumnByHand) {
  // u = 350: 250 px left of the centre, f = 250 px, so 45 degrees. At range 2 sqrt(2) m z = 2 m,
  // d = 25 / 2 = 12.5 px; delta = (250, 0, 250) * 0.1 / 12.5^2 * 0.5 = (0.08, 0, 0.08) m.
  const std::array range{2.0 * std::numbers::sqrt2};
  const auto samples = column_uncertainty(kFigure41, 350.0, range, 0.5);
  ASSERT_THAT(samples, SizeIs(1));
  EXPECT_EQ(samples[0].u_px, 350.0);
  EXPECT_EQ(samples[0].range_m, range[0]);
  EXPECT_NEAR(samples[0].d_px, 12.5, 1e-9);
  EXPECT_TRUE(samples[0].delta_m.isApprox(Eigen::Vector3d(0.08, 0.0, 0.08), 1e-9));
  EXPECT_NEAR(samples[0].along_ray_m(), 0.08 * std::numbers::sqrt2, 1e-9);
}

TEST(SensorModelCurvesTest, ASphericalColumnByHand) {
  // Straight ahead, 2 m: tan(delta) = 0.05, delta_z = 0.1 * 0.002 * (1 + 400) * 0.5 = 0.0401 m.
  const std::array range{2.0};
  const auto samples = column_uncertainty(kFigure42, 600.0, range, 0.5);
  ASSERT_THAT(samples, SizeIs(1));
  EXPECT_NEAR(samples[0].d_px, std::atan(0.05) / 0.002, 1e-9);
  EXPECT_TRUE(samples[0].delta_m.isApprox(Eigen::Vector3d(0.0, 0.0, 0.0401), 1e-9));
}

TEST(SensorModelCurvesTest, AColumnBeyondAQuarterTurnHasNoRay) {
  // 800 columns of 0.002 rad are 1.6 rad.
  EXPECT_THAT(column_uncertainty(kFigure42, -200.0, kRangesM, 0.5), IsEmpty());
  EXPECT_THAT(column_uncertainty(kFigure42, 1400.0, kRangesM, 0.5), IsEmpty());
  EXPECT_THAT(column_uncertainty(kFigure41, -200.0, kRangesM, 0.5), SizeIs(4));
}

TEST(SensorModelCurvesProperty, DistancesRiseAndHoldTheMeasurement) {
  std::mt19937 random(91);
  std::uniform_real_distribution<double> exponent(-3.0, 3.0);
  for (int round = 0; round < 200; ++round) {
    const std::array z_m{std::pow(10.0, exponent(random)), std::pow(10.0, exponent(random))};
    for (const ModelCurve& curve : model_curves(round % 2 ? kPinhole : kSpherical, {}, z_m)) {
      bool holds_z = false;
      double before_m = 0.0;
      for (const ModelSample& sample : curve.samples) {
        ASSERT_GT(sample.m_m, before_m);
        before_m = sample.m_m;
        holds_z = holds_z || sample.m_m == curve.z_m;
        ASSERT_TRUE(sample.p > 0.0 && sample.p < 1.0);
      }
      EXPECT_TRUE(holds_z) << curve.z_m;
    }
  }
}

TEST(SensorModelCurvesProperty, TheUncertaintyIsTheSlopeOfTheReprojection) {
  std::mt19937 random(92);
  std::uniform_real_distribution<double> column_px(0.0, 1199.0);
  std::uniform_real_distribution<double> range_m(0.3, 20.0);
  for (int round = 0; round < 500; ++round) {
    const PairModel& pair = round % 2 == 0 ? kFigure41 : kFigure42;
    const double u_px = column_px(random);
    const std::array range{range_m(random)};
    const UncertaintySample sample = column_uncertainty(pair, u_px, range, 0.5).at(0);
    EXPECT_NEAR(reproject(pair, u_px, 600.0, sample.d_px).norm(), range[0], 1e-9 * range[0]);
    const double step_px = 1e-5 * sample.d_px;
    const Eigen::Vector3d slope = (reproject(pair, u_px, 600.0, sample.d_px + step_px) -
                                   reproject(pair, u_px, 600.0, sample.d_px - step_px)) /
                                  (2.0 * step_px);
    EXPECT_TRUE(sample.delta_m.isApprox(0.5 * slope.cwiseAbs(), 1e-6));
  }
}

TEST(SensorModelCurvesReference, EverySampleAgrees) {
  const reference::NaiveSensorModel naive;
  for (const PairModel& pair : {kPinhole, kSpherical}) {
    for (const ModelCurve& curve : model_curves(pair, {}, kRangesM)) {
      const double expected_m =
          std::holds_alternative<PinholePair>(pair)
              ? reference::naive_pinhole_delta_z_m(curve.z_m, 0.1, 500.0, 0.5)
              : reference::naive_spherical_delta_z_m(curve.z_m, 0.1, 0.002, 0.5);
      EXPECT_NEAR(curve.delta_z_m, expected_m, 1e-9 * expected_m);
      for (const ModelSample& sample : curve.samples) {
        EXPECT_NEAR(
            sample.p, reference::naive_probability(naive, sample.m_m, curve.z_m, expected_m), 1e-9);
      }
    }
  }
}

}  // namespace
}  // namespace skyhalo

// The curves of the thesis's figures 6.1 and 6.2. Both name all settings but the disparity's error,
// which is 1 px here.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <string>

#include "reference/naive_sensor_model.hpp"
#include "skyhalo/camera/pair_model.hpp"
#include "skyhalo/sensor_model/inverse_sensor_model.hpp"

namespace skyhalo {
namespace {

constexpr double kBaselineM = 0.1;
constexpr double kDeltaDPx = 1.0;
constexpr std::array kRangesM{1.0, 2.0, 5.0, 10.0, 20.0};
constexpr SensorModelConfig kThesis{.k = 0.75, .p_unknown = 0.5, .p_free = 0.3, .delta_d_px = 1.0};

struct Figure {
  std::string name;
  PairModel pair;
  std::function<double(double)> reference_delta_z_m;
};

Figure figure_6_1() {
  constexpr double kFocalPx = 500.0;
  return {"6.1", PinholePair{.focal_px = kFocalPx, .baseline_m = kBaselineM}, [](double z_m) {
            return reference::naive_pinhole_delta_z_m(z_m, kBaselineM, kFocalPx, kDeltaDPx);
          }};
}

Figure figure_6_2() {
  constexpr double kPixelRad = 2.5 / 1200.0;
  return {
      "6.2",
      SphericalPair{
          .delta_theta_u_rad = kPixelRad, .delta_theta_v_rad = kPixelRad, .baseline_m = kBaselineM},
      [](double z_m) {
        return reference::naive_spherical_delta_z_m(z_m, kBaselineM, kPixelRad, kDeltaDPx);
      }};
}

InverseSensorModel model_of(const Figure& figure, double z_m) {
  return {kThesis, z_m, delta_z_m(figure.pair, z_m, kThesis.delta_d_px)};
}

/// Where a function that is at most `level` at `low` and above it at `high` crosses it; low may lie
/// on either side of high.
double crossing(const std::function<double(double)>& function,
                double level,
                double low,
                double high) {
  for (int i = 0; i < 200; ++i) {
    const double middle = 0.5 * (low + high);
    (function(middle) > level ? high : low) = middle;
  }
  return 0.5 * (low + high);
}

TEST(ThesisFiguresReference, TheUncertaintiesByHand) {
  // 6.1: z^2 / (0.1 * 500). 6.2: 0.1 * 2.5/1200 * (1 + 100 z^2).
  const std::array pinhole{0.02, 0.08, 0.5, 2.0, 8.0};
  const std::array spherical{101.0, 401.0, 2501.0, 10001.0, 40001.0};
  for (std::size_t i = 0; i < kRangesM.size(); ++i) {
    EXPECT_NEAR(delta_z_m(figure_6_1().pair, kRangesM[i], kDeltaDPx), pinhole[i], 1e-12);
    EXPECT_NEAR(delta_z_m(figure_6_2().pair, kRangesM[i], kDeltaDPx), spherical[i] / 4800.0, 1e-12);
  }
}

TEST(ThesisFiguresReference, TheCurvesAgreeEverywhere) {
  constexpr reference::NaiveSensorModel kReference{.k = 0.75, .p_unknown = 0.5, .p_free = 0.3};
  for (const Figure& figure : {figure_6_1(), figure_6_2()}) {
    for (const double z_m : kRangesM) {
      const InverseSensorModel model = model_of(figure, z_m);
      const double delta_m = figure.reference_delta_z_m(z_m);
      for (int i = 1; i <= 3000; ++i) {
        const double m_m = 0.01 * i;
        ASSERT_NEAR(model.probability(m_m),
                    reference::naive_probability(kReference, m_m, z_m, delta_m),
                    1e-12)
            << "figure " << figure.name << ", z " << z_m << " m, m " << m_m << " m";
      }
      EXPECT_NEAR(model.probability(z_m), 0.5 + 0.375 * std::exp(-delta_m), 1e-12);
    }
  }
}

TEST(ThesisFiguresReference, TheHalfHeightPointsLieSymmetricAboutTheMeasurement) {
  for (const Figure& figure : {figure_6_1(), figure_6_2()}) {
    for (const double z_m : kRangesM) {
      const InverseSensorModel model = model_of(figure, z_m);
      const auto p = [&](double m_m) { return model.probability(m_m); };
      const double half = 0.5 * (p(z_m) + kThesis.p_unknown);
      const double before_m = z_m - crossing(p, half, 0.0, z_m);
      const double behind_m = crossing(p, half, 2.0 * z_m, z_m) - z_m;
      EXPECT_GT(before_m, 0.01) << "figure " << figure.name << ", z " << z_m << " m";
      EXPECT_NEAR(before_m, behind_m, 1e-9) << "figure " << figure.name << ", z " << z_m << " m";
    }
  }
}

TEST(ThesisFiguresReference, FarMeasurementsClearButHardlyMark) {
  // As the figures show: the peak sinks to p_unknown with the range, and p_free stays in front.
  for (const Figure& figure : {figure_6_1(), figure_6_2()}) {
    double last_peak = 1.0;
    for (const double z_m : kRangesM) {
      const InverseSensorModel model = model_of(figure, z_m);
      EXPECT_LT(model.probability(z_m), last_peak) << "figure " << figure.name;
      EXPECT_LT(model.probability(0.01), 0.32) << "figure " << figure.name;
      last_peak = model.probability(z_m);
    }
    EXPECT_LT(last_peak, 0.501) << "figure " << figure.name;
  }
}

}  // namespace
}  // namespace skyhalo

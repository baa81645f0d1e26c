#include "skyhalo/camera/pair_model.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

namespace skyhalo {
namespace {

const PinholePair kPinhole{.focal_px = 400.0,
                           .principal_u_px = 320.0,
                           .principal_v_px = 240.0,
                           .baseline_m = 0.5,
                           .disparity_offset_px = 0.0};
const SphericalPair kSpherical{.delta_theta_u_rad = 1.0 / 400.0,
                               .delta_theta_v_rad = 1.0 / 300.0,
                               .principal_u_px = 320.0,
                               .principal_v_px = 240.0,
                               .baseline_m = 0.5};

/// Both kinds; the functions of a pair say what those of its alternative do.
template <class Check>
void for_both(const Check& check) {
  check(PairModel(kPinhole), kPinhole);
  check(PairModel(kSpherical), kSpherical);
}

TEST(PairModelTest, AsksTheAlternative) {
  for_both([](const PairModel& pair, const auto& model) {
    EXPECT_EQ(baseline_m(pair), 0.5);
    EXPECT_EQ(reproject(pair, 300.0, 250.0, 12.0), reproject(model, 300.0, 250.0, 12.0));
    EXPECT_EQ(project(pair, {1.0, -2.0, 5.0}), project(model, {1.0, -2.0, 5.0}));
    EXPECT_EQ(uncertainty_m(pair, {300.0, 250.0, 12.0}, 0.3),
              uncertainty_m(model, {300.0, 250.0, 12.0}, 0.3));
    EXPECT_EQ(delta_z_m(pair, 7.0, 0.3), delta_z_m(model, 7.0, 0.3));
    EXPECT_EQ(range_at_uncertainty_m(pair, 0.7, 0.3), range_at_uncertainty_m(model, 0.7, 0.3));
    EXPECT_EQ(range_at_disparity_m(pair, 20.0), range_at_disparity_m(model, 20.0));
    EXPECT_EQ(min_range_m(pair, 640, 64.0), min_range_m(model, 640, 64.0));
  });
}

TEST(PairModelTest, ShrinksTheAlternative) {
  const PairModel pinhole = downscaled(PairModel(kPinhole), 2);
  ASSERT_TRUE(std::holds_alternative<PinholePair>(pinhole));
  EXPECT_DOUBLE_EQ(std::get<PinholePair>(pinhole).focal_px, 200.0);
  EXPECT_DOUBLE_EQ(std::get<PinholePair>(pinhole).principal_u_px, 159.75);
  const PairModel spherical = downscaled(PairModel(kSpherical), 4);
  ASSERT_TRUE(std::holds_alternative<SphericalPair>(spherical));
  EXPECT_DOUBLE_EQ(std::get<SphericalPair>(spherical).delta_theta_u_rad, 0.01);
  EXPECT_DOUBLE_EQ(std::get<SphericalPair>(spherical).principal_v_px, 59.625);  // 240.5/4 - 0.5
}

TEST(PairModelTest, NoDisparityIsNoPointInEither) {
  for_both([](const PairModel& pair, const auto&) {
    for (const double d_px : {0.0, -3.0, std::numeric_limits<double>::quiet_NaN()}) {
      EXPECT_TRUE(reproject(pair, 300.0, 250.0, d_px).array().isNaN().all()) << d_px;
    }
  });
}

TEST(PairModelProperty, FarAwayAndStraightAheadBothKindsAgree) {
  // With a pixel of 1/f the two differ by the square of the angle only.
  for (const double z_m : {100.0, 300.0, 1000.0}) {
    const Eigen::Vector3d point_m(1e-3 * z_m, -2e-3 * z_m, z_m);
    const Eigen::Vector3d pinhole = project(PairModel(kPinhole), point_m);
    SphericalPair square = kSpherical;
    square.delta_theta_v_rad = 1.0 / 400.0;
    const Eigen::Vector3d spherical = project(PairModel(square), point_m);
    EXPECT_NEAR(spherical.x(), pinhole.x(), 1e-5);
    EXPECT_NEAR(spherical.y(), pinhole.y(), 1e-5);
    EXPECT_NEAR(spherical.z(), pinhole.z(), 1e-4 * pinhole.z());
    EXPECT_NEAR(delta_z_m(PairModel(square), z_m, 0.25),
                delta_z_m(PairModel(kPinhole), z_m, 0.25),
                1e-4 * delta_z_m(PairModel(kPinhole), z_m, 0.25));
  }
}

}  // namespace
}  // namespace skyhalo

#include "skyhalo/config/config.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "support/expect_error.hpp"

namespace skyhalo {
namespace {

using testing::message_of;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

struct BadSetting {
  std::string key;  ///< that the message must name
  std::function<void(Config&)> spoil;
};

void expect_refused(const std::vector<BadSetting>& cases) {
  for (const BadSetting& bad : cases) {
    SCOPED_TRACE(bad.key);
    Config config;
    bad.spoil(config);
    EXPECT_THAT(message_of([&] { check(config); }), ::testing::HasSubstr(bad.key));
  }
}

TEST(ConfigTest, TheDefaultsAreInTheirDomain) {
  EXPECT_NO_THROW(check(Config{}));
}

TEST(ConfigTest, TheDefaultsAreThoseOfTheMethod) {
  // METHOD 7: 27 m ahead, y -50...50, z -3...2.5, 33 m, p > 0.7, cells of 0.5 m.
  const Config config;
  EXPECT_EQ(config.bounds.ahead_m, 27.0);
  EXPECT_EQ(config.bounds.behind_m, 0.0);
  EXPECT_EQ(config.bounds.side_m, 50.0);
  EXPECT_EQ(config.bounds.bottom_m, -3.0);
  EXPECT_EQ(config.bounds.top_m, 2.5);
  EXPECT_EQ(config.evaluation.max_range_m, 33.0);
  EXPECT_EQ(config.evaluation.occupied_probability, 0.7);
  EXPECT_EQ(config.detector.map.voxel_m, 0.5);
}

TEST(ConfigTest, RefusesBoundsOutsideTheirDomain) {
  expect_refused({
      {"bounds.ahead_m", [](Config& c) { c.bounds.ahead_m = -1.0; }},
      {"bounds.ahead_m", [](Config& c) { c.bounds.ahead_m = kNan; }},
      {"bounds.behind_m", [](Config& c) { c.bounds.behind_m = -0.5; }},
      {"bounds.side_m", [](Config& c) { c.bounds.side_m = 0.0; }},
      {"bounds.bottom_m", [](Config& c) { c.bounds.bottom_m = 2.5; }},
      {"bounds.bottom_m", [](Config& c) { c.bounds.top_m = kNan; }},
  });
}

TEST(ConfigTest, RefusesAnEvaluationOutsideItsDomain) {
  expect_refused({
      {"evaluation.max_range_m", [](Config& c) { c.evaluation.max_range_m = 0.0; }},
      {"evaluation.max_range_m", [](Config& c) { c.evaluation.max_range_m = kNan; }},
      {"evaluation.occupied_probability",
       [](Config& c) { c.evaluation.occupied_probability = 1.0; }},
      {"evaluation.occupied_probability",
       [](Config& c) { c.evaluation.occupied_probability = 0.0; }},
  });
}

TEST(ConfigTest, RefusesADetectorOutsideItsDomain) {
  expect_refused({
      {"matching.downscale", [](Config& c) { c.detector.matching.downscale = 0; }},
      {"matching.downscale", [](Config& c) { c.detector.matching.downscale = 17; }},
      {"matching.rcrop_px", [](Config& c) { c.detector.matching.rcrop_px = -1; }},
      {"sphere.sigma_threshold_m",
       [](Config& c) { c.detector.sphere.depth.sigma_threshold_m = -0.1; }},
      {"sphere.sigma_factor", [](Config& c) { c.detector.sphere.depth.sigma_factor = kNan; }},
      {"sphere.nearest_count", [](Config& c) { c.detector.sphere.depth.nearest_count = 9; }},
      {"sphere.quantile", [](Config& c) { c.detector.sphere.depth.quantile = 1.5; }},
      {"safety.radius_m", [](Config& c) { c.safety.radius_m = 0.0; }},
      {"safety.delay_s", [](Config& c) { c.safety.delay_s = kNan; }},
      {"safety.look_angle_deg", [](Config& c) { c.safety.look_angle_rad = 1.6; }},
      {"sphere.max_range_m", [](Config& c) { c.detector.sphere.max_range_m = 0.0; }},
      {"sensor_model.k", [](Config& c) { c.detector.sensor_model.k = 1.0; }},
      {"sensor_model.p_free", [](Config& c) { c.detector.sensor_model.p_free = 0.6; }},
      {"sensor_model.p_unknown", [](Config& c) { c.detector.sensor_model.p_unknown = 0.2; }},
      {"sensor_model.delta_d_px", [](Config& c) { c.detector.sensor_model.delta_d_px = 0.0; }},
      {"map.voxel_m", [](Config& c) { c.detector.map.voxel_m = 0.0; }},
      {"map.log_odds_limit", [](Config& c) { c.detector.map.log_odds_limit = 33.0; }},
  });
}

TEST(ConfigTest, RefusesAMatcherOutsideItsDomain) {
  expect_refused({
      {"max_disparity_px", [](Config& c) { c.detector.matching.matcher.max_disparity_px = 20; }},
      {"max_disparity_px", [](Config& c) { c.detector.matching.matcher.max_disparity_px = 0; }},
      {"max_disparity_px", [](Config& c) { c.detector.matching.matcher.max_disparity_px = 272; }},
      {"block_px", [](Config& c) { c.detector.matching.matcher.opencv.block_px = 4; }},
      {"block_px", [](Config& c) { c.detector.matching.matcher.opencv.block_px = 13; }},
      {"paths", [](Config& c) { c.detector.matching.matcher.opencv.paths = 4; }},
      {"uniqueness_percent",
       [](Config& c) { c.detector.matching.matcher.opencv.uniqueness_percent = 101; }},
      {"left_right_px", [](Config& c) { c.detector.matching.matcher.opencv.left_right_px = 0; }},
      {"speckle_size_px",
       [](Config& c) { c.detector.matching.matcher.opencv.speckle_size_px = -1; }},
  });
}

TEST(ConfigTest, RefusesAGridThatDoesNotFit) {
  expect_refused({
      {"step", [](Config& c) { c.detector.sphere.bounds.step_rad = 0.0; }},
      {"theta", [](Config& c) { c.detector.sphere.bounds.theta_min_rad = rad_from_deg(180.0); }},
      {"phi", [](Config& c) { c.detector.sphere.bounds.phi_max_rad = rad_from_deg(181.0); }},
      // 180 deg is no multiple of 7 deg.
      {"step", [](Config& c) { c.detector.sphere.bounds.step_rad = rad_from_deg(7.0); }},
  });
}

}  // namespace
}  // namespace skyhalo

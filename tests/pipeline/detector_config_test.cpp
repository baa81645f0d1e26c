#include "skyhalo/pipeline/detector_config.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <string>

#include "support/expect_error.hpp"

namespace skyhalo {
namespace {

using ::testing::HasSubstr;
using testing::message_of;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();

std::string refusal(const DetectorConfig& config) {
  return message_of([&] { check(config); });
}

TEST(DetectorConfigTest, TheDefaultsAreInsideTheirDomain) {
  EXPECT_NO_THROW(check(DetectorConfig{}));
}

TEST(DetectorConfigTest, RefusesADownscaleBelowOne) {
  for (const int value : {-1, 0}) {
    DetectorConfig config;
    config.matching.downscale = value;
    EXPECT_THAT(refusal(config), HasSubstr("matching.downscale"));
  }
}

TEST(DetectorConfigTest, RefusesANegativeRcrop) {
  DetectorConfig config;
  config.matching.rcrop_px = -1;
  EXPECT_THAT(refusal(config), HasSubstr("matching.rcrop_px"));
  config.matching.rcrop_px = 0;
  EXPECT_NO_THROW(check(config));
}

TEST(DetectorConfigTest, RefusesMatcherSettingsOutsideTheirDomain) {
  DetectorConfig range;
  range.matching.matcher.max_disparity_px = 17;
  EXPECT_THAT(refusal(range), HasSubstr("matching.max_disparity_px"));
  DetectorConfig block;
  block.matching.matcher.opencv.block_px = 4;
  EXPECT_THAT(refusal(block), HasSubstr("opencv.block_px"));
}

TEST(DetectorConfigTest, RefusesADepthRuleOutsideItsDomain) {
  for (const double value : {-0.1, kNan, kInf}) {
    DetectorConfig threshold;
    threshold.sphere.depth.sigma_threshold_m = value;
    EXPECT_THAT(refusal(threshold), HasSubstr("sphere.sigma_threshold_m")) << value;
    DetectorConfig factor;
    factor.sphere.depth.sigma_factor = value;
    EXPECT_THAT(refusal(factor), HasSubstr("sphere.sigma_factor")) << value;
  }
}

TEST(DetectorConfigTest, RefusesASeenRuleOutsideItsDomain) {
  for (const double value : {0.0, -0.1, kNan, kInf}) {
    DetectorConfig near;
    near.sphere.seen.near_m = value;
    EXPECT_THAT(refusal(near), HasSubstr("sphere.near_m")) << value;
    DetectorConfig share;
    share.sphere.seen.min_share = value;
    EXPECT_THAT(refusal(share), HasSubstr("sphere.min_seen_share")) << value;
  }
  for (const double value : {-0.1, 0.8, kNan, kInf}) {
    DetectorConfig window;
    window.sphere.seen.window_rad = value;
    EXPECT_THAT(refusal(window), HasSubstr("sphere.seen_window_deg")) << value;
  }
}

TEST(DetectorConfigTest, RefusesARangeThatIsNone) {
  for (const double value : {-1.0, 0.0, kNan, kInf}) {
    DetectorConfig config;
    config.sphere.max_range_m = value;
    EXPECT_THAT(refusal(config), HasSubstr("sphere.max_range_m")) << value;
  }
}

TEST(DetectorConfigTest, RefusesAMapThatIsNone) {
  for (const double value : {-1.0, 0.0, kNan, kInf}) {
    DetectorConfig config;
    config.map.voxel_m = value;
    EXPECT_THAT(refusal(config), HasSubstr("map.voxel_m")) << value;
  }
  for (const double value : {-1.0, 0.0, 32.1, kNan, kInf}) {
    DetectorConfig config;
    config.map.log_odds_limit = value;
    EXPECT_THAT(refusal(config), HasSubstr("map.log_odds_limit")) << value;
  }
}

TEST(DetectorConfigTest, RefusesASensorModelOutsideItsDomain) {
  DetectorConfig config;
  config.sensor_model.k = 1.5;
  EXPECT_THAT(refusal(config), HasSubstr("sensor_model.k"));
}

TEST(DetectorConfigTest, RefusesGridBoundsThatAreNone) {
  DetectorConfig step;
  step.sphere.bounds.step_rad = 0.0;
  EXPECT_THAT(refusal(step), HasSubstr("sphere.step_deg"));
  DetectorConfig multiple;
  multiple.sphere.bounds.step_rad = rad_from_deg(7.0);
  EXPECT_THAT(refusal(multiple), HasSubstr("multiple"));
  DetectorConfig sphere;  // a grid of its own, but none of all directions
  sphere.sphere.bounds = {.theta_min_rad = rad_from_deg(70.0),
                          .theta_max_rad = rad_from_deg(105.0),
                          .phi_min_rad = rad_from_deg(-35.0),
                          .phi_max_rad = rad_from_deg(35.0),
                          .step_rad = rad_from_deg(7.0)};
  EXPECT_THAT(refusal(sphere), HasSubstr("multiple of the step (7"));
}

}  // namespace
}  // namespace skyhalo

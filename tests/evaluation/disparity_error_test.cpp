#include "skyhalo/evaluation/disparity_error.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "support/expect_error.hpp"

namespace skyhalo {
namespace {

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();

TEST(DisparityErrorTest, CountsWhereTheTruthIsKnown) {
  // Right, just within the threshold, beyond it, unmatched, and two without truth.
  const cv::Mat1f truth = (cv::Mat1f(2, 3) << 10.0F, 10.0F, 10.0F, 10.0F, kNone, kNone);
  const cv::Mat1f found = (cv::Mat1f(2, 3) << 10.0F, 11.0F, 8.5F, kNone, 3.0F, kNone);
  const DisparityError error = compare_disparity(found, truth, 1.0);
  EXPECT_EQ(error.truth_px, 4);
  EXPECT_EQ(error.matched_px, 3);
  EXPECT_EQ(error.bad_px, 1);
  EXPECT_DOUBLE_EQ(error.density(), 0.75);
  EXPECT_DOUBLE_EQ(error.bad_among_matched(), 1.0 / 3.0);
  EXPECT_DOUBLE_EQ(error.bad_or_unmatched(), 0.5);
}

TEST(DisparityErrorTest, SharesOfNothingAreNone) {
  const cv::Mat1f truth(2, 2, kNone);
  const DisparityError error = compare_disparity(cv::Mat1f(2, 2, 5.0F), truth, 1.0);
  EXPECT_EQ(error.truth_px, 0);
  EXPECT_TRUE(std::isnan(error.density()));
  EXPECT_TRUE(std::isnan(error.bad_among_matched()));
  EXPECT_TRUE(std::isnan(error.bad_or_unmatched()));
}

TEST(DisparityErrorTest, RefusesImagesOfDifferentSizes) {
  EXPECT_THAT(testing::message_of([] {
                (void)compare_disparity(cv::Mat1f(2, 3, 1.0F), cv::Mat1f(3, 2, 1.0F), 1.0);
              }),
              ::testing::HasSubstr("different sizes"));
}

}  // namespace
}  // namespace skyhalo

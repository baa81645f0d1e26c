#include <gtest/gtest.h>

#include <vector>

#include "skyhalo/evaluation/disparity_error.hpp"
#include "skyhalo/stereo/matcher.hpp"
#include "support/recorded_data.hpp"
#include "support/stereo_scenes.hpp"

namespace skyhalo {
namespace {

using testing::StereoScene;

/// Shares, meaned over the scenes.
struct MeanError {
  double density = 0.0;
  double bad = 0.0;
  double bad_or_unmatched = 0.0;
};

MeanError mean_error(const std::vector<StereoScene>& scenes) {
  MeanError mean;
  for (const StereoScene& scene : scenes) {
    MatcherConfig config;
    config.max_disparity_px = scene.max_disparity_px;
    config.alignment = scene.alignment;
    cv::Mat1f disparity;
    Matcher(config).match(scene.left, scene.right, disparity);
    const DisparityError error = compare_disparity(disparity, scene.truth_px, scene.threshold_px);
    const double weight = 1.0 / static_cast<double>(scenes.size());
    mean.density += weight * error.density();
    mean.bad += weight * error.bad_among_matched();
    mean.bad_or_unmatched += weight * error.bad_or_unmatched();
  }
  return mean;
}

TEST(RecordedMatchingSystem, RoomsAreMatchedDenselyAndWell) {
  SKYHALO_SKIP_WITHOUT(testing::recorded_data() / "middlebury");
  const MeanError error = mean_error(testing::middlebury_scenes());
  EXPECT_GE(error.density, 0.97);
  EXPECT_LE(error.bad, 0.027);
  EXPECT_LE(error.bad_or_unmatched, 0.05);
}

TEST(RecordedMatchingSystem, RoadsAreMatchedWithTheSameSettings) {
  SKYHALO_SKIP_WITHOUT(testing::recorded_data() / "kitti2012");
  const MeanError error = mean_error(testing::kitti2012_scenes());
  EXPECT_GE(error.density, 0.92);
  EXPECT_LE(error.bad, 0.040);
  EXPECT_LE(error.bad_or_unmatched, 0.10);
}

}  // namespace
}  // namespace skyhalo

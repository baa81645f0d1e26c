// Rendered pairs through the real rectifier and matcher, against the exact disparities.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <stdexcept>
#include <string>
#include <vector>

#include "skyhalo/config/config.hpp"
#include "skyhalo/pipeline/obstacle_detector.hpp"
#include "skyhalo/sim/make_scene.hpp"
#include "skyhalo/sim/simulated_flight.hpp"
#include "skyhalo/sim/waypoint_flight.hpp"
#include "support/sanitised.hpp"
#include "support/small_rigs.hpp"

namespace skyhalo {
namespace {

/// How far disparities are from the exact ones.
struct DisparityErrors {
  double median_px = 0.0;  // where the left camera sees the point, too
  double outliers = 0.0;   // share of these above 2 px
  double wrong = 0.0;      // share of all pixels with a disparity that is wrong by more than 2 px
  double measured = 0.0;   // share of all pixels
};

/// With this limit of texture.
DisparityErrors errors_in(const SceneWish& wish, int texture_min_grey) {
  constexpr int kFrames = testing::rounds(3);
  Scene scene = make_scene(wish);
  Trajectory trajectory = fly_waypoints(scene.route_m, {}, scene.route_closed);
  SimulationConfig simulation;
  simulation.frames = kFrames;
  simulation.rate_hz = (kFrames - 0.5) / trajectory.duration_s();
  const SimulatedFlight flight(
      std::move(scene),
      std::move(trajectory),
      resolve(testing::rig_of({testing::pinhole_pair(), testing::fisheye_pair()})),
      simulation);
  DetectorConfig config;
  config.matching.matcher.sgm.texture_min_grey = texture_min_grey;
  ObstacleDetector detector(
      flight.rig(),
      config,
      make_voxel_grid({Eigen::Vector3d::Constant(-1.0), Eigen::Vector3d::Constant(1.0)}, 0.5));
  std::vector<float> errors_px;
  std::size_t wrong = 0;
  std::size_t measured = 0;
  std::size_t all = 0;
  for (int frame = 0; frame < kFrames; ++frame) {
    detector.process(flight.read(frame), flight.T_map_body(frame));
    for (std::size_t pair = 0; pair < 2; ++pair) {
      const cv::Mat1f& disparity_px = detector.perception(pair).disparity;
      const DepthTruth truth = flight.truth(frame, pair, 1);
      all += disparity_px.total();
      for (int row = 0; row < disparity_px.rows; ++row) {
        for (int col = 0; col < disparity_px.cols; ++col) {
          const float d_px = disparity_px(row, col);
          if (std::isnan(d_px)) {
            continue;
          }
          ++measured;
          // The sky is at disparity 0.
          const float exact_px =
              std::isnan(truth.disparity_px(row, col)) ? 0.0F : truth.disparity_px(row, col);
          const float error_px = std::abs(d_px - exact_px);
          wrong += error_px > 2.0F ? 1 : 0;
          if (truth.both(row, col) != 0) {
            errors_px.push_back(error_px);
          }
        }
      }
    }
  }
  std::sort(errors_px.begin(), errors_px.end());
  if (errors_px.empty()) {
    throw std::runtime_error("no pixel was measured where both cameras see the point");
  }
  const auto above = errors_px.end() - std::upper_bound(errors_px.begin(), errors_px.end(), 2.0F);
  return {.median_px = static_cast<double>(errors_px[errors_px.size() / 2]),
          .outliers = static_cast<double>(above) / static_cast<double>(errors_px.size()),
          .wrong = static_cast<double>(wrong) / static_cast<double>(all),
          .measured = static_cast<double>(measured) / static_cast<double>(all)};
}

class StereoTruthSystem : public ::testing::TestWithParam<std::string> {};

TEST_P(StereoTruthSystem, DisparitiesAreRightWhereThereIsTexture) {
  if (testing::kSanitised) {
    GTEST_SKIP() << "takes minutes under a sanitiser, and others run the same code there";
  }
  const DisparityErrors errors =
      errors_in({.name = GetParam(), .difficulty = 0.0}, SgmConfig{}.texture_min_grey);
  std::cout << GetParam() << ": median " << errors.median_px << " px, outliers " << errors.outliers
            << ", measured " << errors.measured << "\n";
  EXPECT_LE(errors.median_px, 0.3);
  EXPECT_LE(errors.outliers, 0.05);
  EXPECT_GE(errors.measured, 0.5);
}

INSTANTIATE_TEST_SUITE_P(Textured,
                         StereoTruthSystem,
                         ::testing::Values("forest", "street", "warehouse", "yard"),
                         [](const auto& test) { return test.param; });

// The range of the cameras' noise in 9 x 9 pixels is 5 to 9 grey levels.
TEST(BlankWallSystem, PixelsOfBlankWallsGoInvalidRatherThanWrong) {
  if (testing::kSanitised) {
    GTEST_SKIP() << "takes a minute under a sanitiser, and others run the same code there";
  }
  const DisparityErrors errors = errors_in({.name = "tunnel", .difficulty = 1.0}, 8);
  const DisparityErrors usual =
      errors_in({.name = "tunnel", .difficulty = 1.0}, SgmConfig{}.texture_min_grey);
  std::cout << "wrong " << errors.wrong << ", measured " << errors.measured
            << "; by default: wrong " << usual.wrong << ", measured " << usual.measured << "\n";
  EXPECT_LE(errors.wrong, 0.02);
  EXPECT_GE(errors.measured, 0.25);
  EXPECT_GT(usual.wrong, 2.0 * errors.wrong);  // else nobody has to know
}

}  // namespace
}  // namespace skyhalo

#include "skyhalo/stereo/opencv_sgbm.hpp"

#include <cstdint>
#include <limits>

namespace skyhalo {
namespace {

int mode_of(int paths) {
  switch (paths) {
    case 3:
      return cv::StereoSGBM::MODE_SGBM_3WAY;
    case 5:
      return cv::StereoSGBM::MODE_SGBM;
    default:
      return cv::StereoSGBM::MODE_HH;
  }
}

/// Mirrors OpenCV's fixed-point row (1/16 px, negative where nothing matched) into pixels.
void mirror_row(const std::int16_t* fixed, float* disparity_px, int width) noexcept {
  constexpr float kPxPerUnit = 1.0F / 16.0F;
  constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
  for (int u = 0; u < width; ++u) {
    const std::int16_t d = fixed[width - 1 - u];
    disparity_px[u] = d >= 0 ? static_cast<float>(d) * kPxPerUnit : kNone;
  }
}

}  // namespace

OpencvSgbm::OpencvSgbm(const MatcherConfig& config) : max_disparity_px_(config.max_disparity_px) {
  const int area_px = config.block_px * config.block_px;
  // The smoothness penalties that OpenCV's documentation advises for one channel.
  sgbm_ = cv::StereoSGBM::create(0,
                                 config.max_disparity_px,
                                 config.block_px,
                                 8 * area_px,
                                 32 * area_px,
                                 config.left_right_px,
                                 63,
                                 config.uniqueness_percent,
                                 config.speckle_size_px,
                                 config.speckle_range_px,
                                 mode_of(config.paths));
}

void OpencvSgbm::match(const cv::Mat1b& left, const cv::Mat1b& right, cv::Mat1f& disparity) {
  disparity.create(left.size());
  if (left.cols <= max_disparity_px_) {
    disparity.setTo(std::numeric_limits<float>::quiet_NaN());
    return;
  }
  constexpr int kAroundVerticalAxis = 1;
  cv::flip(left, mirrored_left_, kAroundVerticalAxis);
  cv::flip(right, mirrored_right_, kAroundVerticalAxis);
  sgbm_->compute(mirrored_right_, mirrored_left_, mirrored_disparity_);
  for (int v = 0; v < disparity.rows; ++v) {
    mirror_row(mirrored_disparity_.ptr<std::int16_t>(v), disparity[v], disparity.cols);
  }
}

}  // namespace skyhalo

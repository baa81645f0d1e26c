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

/// OpenCV's fixed-point row (1/16 px, negative where nothing matched) in pixels.
void to_pixels(const std::int16_t* fixed, int width, bool mirrored, float* disparity_px) noexcept {
  constexpr float kPxPerUnit = 1.0F / 16.0F;
  constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
  for (int u = 0; u < width; ++u) {
    const std::int16_t d = fixed[mirrored ? width - 1 - u : u];
    disparity_px[u] = d >= 0 ? static_cast<float>(d) * kPxPerUnit : kNone;
  }
}

}  // namespace

OpencvSgbm::OpencvSgbm(const MatcherConfig& config)
    : align_left_(config.alignment == Alignment::kLeft) {
  const OpencvSgbmConfig& settings = config.opencv;
  const int area_px = settings.block_px * settings.block_px;
  // The smoothness penalties that OpenCV's documentation advises for one channel.
  sgbm_ = cv::StereoSGBM::create(0,
                                 config.max_disparity_px,
                                 settings.block_px,
                                 8 * area_px,
                                 32 * area_px,
                                 settings.left_right_px,
                                 63,
                                 settings.uniqueness_percent,
                                 settings.speckle_size_px,
                                 settings.speckle_range_px,
                                 mode_of(settings.paths));
}

void OpencvSgbm::match(const cv::Mat1b& left, const cv::Mat1b& right, cv::Mat1f& disparity) {
  disparity.create(left.size());
  if (align_left_) {
    sgbm_->compute(left, right, fixed_);
  } else {
    constexpr int kAroundVerticalAxis = 1;
    cv::flip(left, mirrored_left_, kAroundVerticalAxis);
    cv::flip(right, mirrored_right_, kAroundVerticalAxis);
    sgbm_->compute(mirrored_right_, mirrored_left_, fixed_);
  }
  for (int v = 0; v < disparity.rows; ++v) {
    to_pixels(fixed_.ptr<std::int16_t>(v), disparity.cols, !align_left_, disparity[v]);
  }
}

}  // namespace skyhalo

#pragma once

#include <algorithm>
#include <cstdint>
#include <opencv2/core.hpp>
#include <ostream>
#include <random>

#include "reference/naive_sgm.hpp"
#include "skyhalo/stereo/sgm_config.hpp"
#include "stereo/sgm/planes.hpp"
#include "support/textured_pair.hpp"

namespace skyhalo::testing {

/// A pair and all that decides on its disparities.
struct SgmCase {
  SgmConfig config;
  int max_disparity_px = 64;
  bool align_left = false;
  TexturedPair pair;
};

inline std::ostream& operator<<(std::ostream& out, const SgmCase& of) {
  const SgmConfig& c = of.config;
  return out << of.pair.left.cols << "x" << of.pair.left.rows << ", D " << of.max_disparity_px
             << (of.align_left ? ", left" : ", right") << ", p1 " << c.p1 << ", p2 " << c.p2_min
             << "..." << c.p2_max << ", unique " << c.uniqueness_percent << ", left-right "
             << c.left_right_px << ", texture " << c.texture_min_grey << ", repetition "
             << c.repetition_px << ", median " << c.median_passes << ", fill " << c.fill_min_px
             << ", speckle " << c.speckle_size_px << "/" << c.speckle_step_px << ", edge "
             << c.edge_step_px;
}

inline reference::NaiveSgmSettings naive_settings(const SgmCase& of) {
  return {.max_disparity_px = of.max_disparity_px,
          .p1 = of.config.p1,
          .p2_max = of.config.p2_max,
          .p2_min = of.config.p2_min,
          .uniqueness_percent = of.config.uniqueness_percent,
          .left_right_64 = static_cast<int>(of.config.left_right_px * 64.0),
          .texture_min = of.config.texture_min_grey,
          .repetition_px = of.config.repetition_px,
          .fill_min = of.config.fill_min_px,
          .median_passes = of.config.median_passes,
          .speckle_size_px = of.config.speckle_size_px,
          .speckle_step_64 = static_cast<int>(of.config.speckle_step_px * 64.0),
          .edge_step_64 = static_cast<int>(of.config.edge_step_px * 64.0),
          .align_left = of.align_left};
}

/// Draws cases, the same for the same seed.
class SgmCases {
 public:
  explicit SgmCases(unsigned seed) : random_(seed) {}

  int draw(int low, int high) { return std::uniform_int_distribution<int>(low, high)(random_); }

  SgmCase next(const cv::Size& size, int max_disparity_px) {
    SgmCase result;
    result.config = draw(0, 3) == 0 ? SgmConfig() : any_config();
    result.max_disparity_px = max_disparity_px;
    result.align_left = draw(0, 1) == 1;
    result.pair = any_pair(size, max_disparity_px);
    return result;
  }

  /// Lengths are whole numbers of 1/64 px.
  SgmConfig any_config() {
    SgmConfig config;
    config.p1 = draw(0, draw(0, 51));
    config.p2_min = draw(config.p1, 51);
    config.p2_max = draw(config.p2_min, 51);
    config.uniqueness_percent = draw(0, 7) == 0 ? draw(0, 100) : draw(0, 10);
    config.left_right_px = draw(0, 5) == 0 ? 256.0 : draw(0, 200) / 64.0;
    config.texture_min_grey = draw(0, 5) == 0 ? draw(0, 255) : draw(0, 12);
    config.repetition_px = draw(0, 2) == 0 ? draw(1, 20) : draw(20, 82);
    config.median_passes = draw(0, 4);
    config.fill_min_px = draw(1, 26);
    config.speckle_size_px = draw(0, 2) == 0 ? draw(0, 2) : draw(0, 200);
    config.speckle_step_px = draw(0, 5) == 0 ? 256.0 : draw(0, 150) / 64.0;
    config.edge_step_px = draw(0, 3) == 0 ? 0.0 : draw(1, 600) / 64.0;
    return config;
  }

  TexturedPair any_pair(const cv::Size& size, int max_disparity_px) {
    switch (draw(0, 4)) {
      case 0:
        return {random_grey(size, 0, 255, random_), random_grey(size, 0, 255, random_)};
      case 1:
        return textured_pair(size, draw(0, max_disparity_px - 1), any_seed());
      case 2:
        return patches(size, max_disparity_px);
      case 3:
        return two_depths(size, max_disparity_px);
      default:
        return {black_and_white(size), black_and_white(size)};
    }
  }

 private:
  unsigned any_seed() { return static_cast<unsigned>(draw(0, 1'000'000)); }

  cv::Mat1b black_and_white(const cv::Size& size) {
    cv::Mat1b image = random_grey(size, 0, 1, random_);
    image *= 255;
    return image;
  }

  cv::Mat1b noisy(const cv::Mat1b& image, int most) {
    cv::Mat1b result;
    cv::add(image, random_grey(image.size(), 0, most, random_), result);
    return result;
  }

  cv::Rect any_rectangle(const cv::Size& size) {
    const cv::Point corner(draw(0, size.width - 1), draw(0, size.height - 1));
    return {corner, cv::Point(draw(corner.x + 1, size.width), draw(corner.y + 1, size.height))};
  }

  /// Flat patches, the same in both images but for noise.
  TexturedPair patches(const cv::Size& size, int max_disparity_px) {
    cv::Mat1b wide(size.height, size.width + max_disparity_px, std::uint8_t{120});
    for (int patch = draw(1, 30); patch > 0; --patch) {
      wide(any_rectangle(wide.size())) = static_cast<std::uint8_t>(draw(0, 255));
    }
    const int disparity_px = draw(0, max_disparity_px - 1);
    const int noise = draw(0, 3);
    const cv::Rect at(0, 0, size.width, size.height);
    return {noisy(wide(at), noise), noisy(wide(at + cv::Point(disparity_px, 0)), noise)};
  }

  /// A rectangle before the ground.
  TexturedPair two_depths(const cv::Size& size, int max_disparity_px) {
    TexturedPair pair = textured_pair(size, draw(0, max_disparity_px / 2), any_seed());
    const cv::Rect in_right = any_rectangle(size);
    const int disparity_px =
        std::min(draw(0, max_disparity_px - 1), size.width - in_right.x - in_right.width);
    const cv::Mat1b front = texture(in_right.size(), any_seed());
    front.copyTo(pair.right(in_right));
    front.copyTo(pair.left(in_right + cv::Point(disparity_px, 0)));
    return {noisy(pair.left, 4), pair.right};
  }

  std::mt19937 random_;
};

}  // namespace skyhalo::testing

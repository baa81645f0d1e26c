#include "skyhalo/stereo/grey_images.hpp"

#include <algorithm>
#include <opencv2/imgproc.hpp>
#include <string>

#include "skyhalo/base/error.hpp"

namespace skyhalo {
namespace {

constexpr int kLevels = 65536;

std::string size_text(const cv::Mat& image) {
  return std::to_string(image.cols) + "x" + std::to_string(image.rows);
}

void check_pair(const cv::Mat& left, const cv::Mat& right) {
  const auto refuse = [](const std::string& what) { throw Error(ErrorKind::kInput, what); };
  if (left.empty() || right.empty()) {
    refuse("stereo pair: an image is empty");
  }
  if (left.dims > 2 || right.dims > 2) {
    refuse("stereo pair: expected images of two dimensions");
  }
  if (left.size() != right.size()) {
    refuse("stereo pair: the left image is " + size_text(left) + ", the right " + size_text(right));
  }
  if (left.type() != right.type()) {
    refuse("stereo pair: the images differ in depth or channels");
  }
  const bool known_depth = left.depth() == CV_8U || left.depth() == CV_16U;
  const bool known_channels = left.channels() == 1 || left.channels() == 3 || left.channels() == 4;
  if (!known_depth || !known_channels) {
    refuse("stereo pair: expected grey or colour of 8 or 16 bits a channel, without sign");
  }
}

void to_grey(const cv::Mat& image, cv::Mat& own, cv::Mat& grey) {
  if (image.channels() == 1) {
    grey = image;
    return;
  }
  cv::cvtColor(image, own, image.channels() == 3 ? cv::COLOR_BGR2GRAY : cv::COLOR_BGRA2GRAY);
  grey = own;
}

/// The smallest level that more than `count` pixels do not exceed.
int level_above(const std::vector<std::uint32_t>& counts, std::uint64_t count) noexcept {
  std::uint64_t seen = 0;
  for (int level = 0; level < kLevels; ++level) {
    seen += counts[static_cast<std::size_t>(level)];
    if (seen > count) {
      return level;
    }
  }
  return kLevels - 1;
}

}  // namespace

void GreyImages::convert(const cv::Mat& left, const cv::Mat& right) {
  check_pair(left, right);
  if (left.depth() == CV_8U) {
    to_grey(left, own_[0], grey_[0]);
    to_grey(right, own_[1], grey_[1]);
    return;
  }
  to_grey(left, own_wide_[0], wide_[0]);
  to_grey(right, own_wide_[1], wide_[1]);
  narrow();
}

void GreyImages::narrow() {
  counts_.assign(kLevels, 0);
  narrowed_.resize(kLevels);
  for (const cv::Mat1w& image : wide_) {
    for (int v = 0; v < image.rows; ++v) {
      std::for_each(
          image[v], image[v] + image.cols, [this](std::uint16_t level) { ++counts_[level]; });
    }
  }
  const std::uint64_t pixels = 2 * wide_[0].total();
  int darkest = level_above(counts_, 0);
  int brightest = level_above(counts_, pixels - 1);
  if (brightest - darkest > 255) {
    darkest = level_above(counts_, pixels / 1000);
    brightest = level_above(counts_, pixels - 1 - pixels / 1000);
  }
  const int range = std::max(255, brightest - darkest);
  for (int level = 0; level < kLevels; ++level) {
    const int above = std::clamp(level - darkest, 0, range);
    narrowed_[static_cast<std::size_t>(level)] = static_cast<std::uint8_t>(above * 255 / range);
  }
  for (std::size_t side = 0; side < 2; ++side) {
    const cv::Mat1w& image = wide_[side];
    own_[side].create(image.size());
    grey_[side] = own_[side];
    for (int v = 0; v < image.rows; ++v) {
      std::transform(image[v], image[v] + image.cols, own_[side][v], [this](std::uint16_t level) {
        return narrowed_[level];
      });
    }
  }
}

}  // namespace skyhalo

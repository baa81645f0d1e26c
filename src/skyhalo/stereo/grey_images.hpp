#pragma once

#include <array>
#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <vector>

namespace skyhalo {

/// Makes a pair of images what the engines match: 8-bit grey, both by the same rule. Keeps its
/// memory; grey 8-bit images are passed on as they are.
class GreyImages {
 public:
  /// Throws `Error` (input) when the images are empty, differ in size or type, or are neither grey
  /// nor colour (BGR, BGRA) of 8 or 16 unsigned bits. 16-bit images keep their grey steps if 8 bits
  /// hold them; otherwise the range from their darkest to their brightest thousandth is spread over
  /// 0...255.
  void convert(const cv::Mat& left, const cv::Mat& right);

  /// Of the last pair; may share its pixels.
  [[nodiscard]] const cv::Mat1b& left() const noexcept { return grey_[0]; }

  [[nodiscard]] const cv::Mat1b& right() const noexcept { return grey_[1]; }

 private:
  void narrow();

  std::array<cv::Mat1b, 2> grey_;
  std::array<cv::Mat1b, 2> own_;
  std::array<cv::Mat1w, 2> wide_;
  std::array<cv::Mat1w, 2> own_wide_;
  std::vector<std::uint32_t> counts_;  // of each 16-bit grey
  std::vector<std::uint8_t> narrowed_;
};

}  // namespace skyhalo

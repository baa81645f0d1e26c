#include "skyhalo/stereo/matcher.hpp"

#include <string>

#include "skyhalo/base/error.hpp"

namespace skyhalo {
namespace {

constexpr int kLargestSidePx = 32767;

void require(bool holds, const char* key, const char* expected) {
  if (!holds) {
    throw Error(ErrorKind::kInput, std::string(key) + ": expected " + expected);
  }
}

bool within(double value, double low, double high) {
  return value >= low && value <= high;  // not so for NaN
}

void check_sgm(const SgmConfig& config) {
  require(config.p1 >= 0, "sgm.p1", "a penalty >= 0");
  require(config.p2_min >= config.p1, "sgm.p2_min", "a penalty of at least sgm.p1");
  require(config.p2_max >= config.p2_min && config.p2_max <= 51,
          "sgm.p2_max",
          "a penalty from sgm.p2_min to 51");
  require(
      within(config.uniqueness_percent, 0, 100), "sgm.uniqueness_percent", "a number in 0...100");
  require(within(config.left_right_px, 0, 256), "sgm.left_right_px", "a number in 0...256");
  require(within(config.texture_min_grey, 0, 255), "sgm.texture_min_grey", "a number in 0...255");
  require(within(config.repetition_px, 1, 82), "sgm.repetition_px", "a number in 1...82");
  require(within(config.median_passes, 0, 10), "sgm.median_passes", "a number in 0...10");
  require(within(config.fill_min_px, 1, 26), "sgm.fill_min_px", "a number in 1...26");
  require(config.speckle_size_px >= 0, "sgm.speckle_size_px", "a number >= 0");
  require(within(config.speckle_step_px, 0, 256), "sgm.speckle_step_px", "a number in 0...256");
  require(within(config.edge_step_px, 0, 256), "sgm.edge_step_px", "a number in 0...256");
}

void check_opencv(const OpencvSgbmConfig& config) {
  require(within(config.block_px, 1, 11) && config.block_px % 2 == 1,
          "opencv.block_px",
          "an odd number in 1...11");
  require(config.paths == 3 || config.paths == 5 || config.paths == 8, "opencv.paths", "3, 5 or 8");
  require(within(config.uniqueness_percent, 0, 100),
          "opencv.uniqueness_percent",
          "a number in 0...100");
  require(config.left_right_px >= 1, "opencv.left_right_px", "a number of pixels >= 1");
  require(config.speckle_size_px >= 0, "opencv.speckle_size_px", "a number >= 0");
  require(config.speckle_range_px >= 0, "opencv.speckle_range_px", "a number >= 0");
}

std::variant<SgmMatcher, OpencvSgbm> make_engine(const MatcherConfig& config) {
  check(config);
  if (config.kind == MatcherKind::kOpencv) {
    return OpencvSgbm(config);
  }
  return SgmMatcher(config);
}

}  // namespace

void check(const MatcherConfig& config) {
  const int d = config.max_disparity_px;
  require(d >= 16 && d <= 256 && d % 16 == 0,
          "matching.max_disparity_px",
          "a multiple of 16 in 16...256");
  check_sgm(config.sgm);
  check_opencv(config.opencv);
}

Matcher::Matcher(const MatcherConfig& config)
    : max_disparity_px_(config.max_disparity_px), engine_(make_engine(config)) {}

void Matcher::match(const cv::Mat& left, const cv::Mat& right, cv::Mat1f& disparity) {
  grey_.convert(left, right);
  if (left.cols <= max_disparity_px_) {
    throw Error(ErrorKind::kInput,
                "stereo pair: images " + std::to_string(left.cols) +
                    " px wide are too narrow to search " + std::to_string(max_disparity_px_) +
                    " disparities");
  }
  if (left.cols > kLargestSidePx || left.rows > kLargestSidePx) {
    throw Error(
        ErrorKind::kInput,
        "stereo pair: expected images of at most " + std::to_string(kLargestSidePx) + " px a side");
  }
  std::visit([&](auto& engine) { engine.match(grey_.left(), grey_.right(), disparity); }, engine_);
}

}  // namespace skyhalo

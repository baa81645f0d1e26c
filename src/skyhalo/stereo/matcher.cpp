#include "skyhalo/stereo/matcher.hpp"

#include <string>

#include "skyhalo/base/error.hpp"

namespace skyhalo {
namespace {

void require(bool holds, const char* key, const char* expected) {
  if (!holds) {
    throw Error(ErrorKind::kInput, std::string("matching.") + key + ": expected " + expected);
  }
}

}  // namespace

void check(const MatcherConfig& config) {
  const int d = config.max_disparity_px;
  require(d >= 16 && d <= 256 && d % 16 == 0, "max_disparity_px", "a multiple of 16 in 16...256");
  require(config.block_px >= 1 && config.block_px <= 11 && config.block_px % 2 == 1,
          "block_px",
          "an odd number in 1...11");
  require(config.paths == 3 || config.paths == 5 || config.paths == 8, "paths", "3, 5 or 8");
  require(config.uniqueness_percent >= 0 && config.uniqueness_percent <= 100,
          "uniqueness_percent",
          "a number in 0...100");
  require(config.left_right_px >= 1, "left_right_px", "a number of pixels >= 1");
  require(config.speckle_size_px >= 0, "speckle_size_px", "a number >= 0");
  require(config.speckle_range_px >= 0, "speckle_range_px", "a number >= 0");
}

Matcher::Matcher(const MatcherConfig& config) : engine_((check(config), OpencvSgbm(config))) {}

void Matcher::match(const cv::Mat1b& left, const cv::Mat1b& right, cv::Mat1f& disparity) {
  std::visit([&](auto& engine) { engine.match(left, right, disparity); }, engine_);
}

}  // namespace skyhalo

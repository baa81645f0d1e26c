#pragma once

#include <memory>
#include <opencv2/core/mat.hpp>

#include "skyhalo/stereo/matcher_config.hpp"

namespace skyhalo {

/// The project's own Semi-Global Matching (Hirschmueller 2008): eight paths, sub-pixel, checked
/// from left and right. Its loops run on TBB's threads; the same bits with any number of them and
/// on any processor. Allocates for the first pair of a size, and then no more.
class SgmMatcher {
 public:
  /// `config` is one that `check` lets through.
  explicit SgmMatcher(const MatcherConfig& config);
  SgmMatcher(const SgmMatcher&) = delete;
  SgmMatcher(SgmMatcher&& other) noexcept;
  SgmMatcher& operator=(const SgmMatcher&) = delete;
  SgmMatcher& operator=(SgmMatcher&& other) noexcept;
  ~SgmMatcher();

  /// As `Matcher::match`; the images are of one size and wider than the largest disparity.
  void match(const cv::Mat1b& left, const cv::Mat1b& right, cv::Mat1f& disparity);

 private:
  struct Memory;

  std::unique_ptr<Memory> memory_;
};

}  // namespace skyhalo

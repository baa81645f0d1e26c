#pragma once

#include <memory>
#include <opencv2/core/mat.hpp>

#include "skyhalo/stereo/matcher_config.hpp"

namespace skyhalo {

namespace sgm {
class Engine;
}  // namespace sgm

/// The project's own Semi-Global Matching (Hirschmueller 2008): eight paths, sub-pixel, checked
/// from left and right. Its loops run on TBB's threads; the same bits with any number of them and
/// on any processor. Keeps memory for one size, about twice width x height x disparities bytes, and
/// allocates when the size changes; within a frame only TBB does, for its tasks.
class SgmMatcher {
 public:
  /// `config` is one that `check` lets through.
  explicit SgmMatcher(const MatcherConfig& config);
  SgmMatcher(const SgmMatcher&) = delete;
  SgmMatcher(SgmMatcher&& other) noexcept;
  SgmMatcher& operator=(const SgmMatcher&) = delete;
  SgmMatcher& operator=(SgmMatcher&& other) noexcept;
  ~SgmMatcher();

  /// As `Matcher::match`; the images are of one size and wider than the largest disparity. Throws
  /// `Error` (failure) when there is not enough memory for that size.
  void match(const cv::Mat1b& left, const cv::Mat1b& right, cv::Mat1f& disparity);

 private:
  void make_engine(int width_px, int height_px);

  MatcherConfig config_;
  std::unique_ptr<sgm::Engine> engine_;  // of the last size
};

}  // namespace skyhalo

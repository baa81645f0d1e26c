#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>

namespace skyhalo {

/// How a disparity image compares with the truth.
struct DisparityError {
  std::int64_t truth_px = 0;    ///< pixels whose truth is known
  std::int64_t matched_px = 0;  ///< of these, with a disparity
  std::int64_t bad_px = 0;      ///< of these, off by more than the threshold

  /// Shares in [0, 1]; NaN when there is nothing to divide by.
  [[nodiscard]] double density() const noexcept;
  [[nodiscard]] double bad_among_matched() const noexcept;
  [[nodiscard]] double bad_or_unmatched() const noexcept;
};

/// Counts over the pixels whose `truth_px` is not NaN; NaN in `disparity_px` is no disparity. Both
/// images have one size. `threshold_px` >= 0.
[[nodiscard]] DisparityError compare_disparity(const cv::Mat1f& disparity_px,
                                               const cv::Mat1f& truth_px,
                                               double threshold_px);

}  // namespace skyhalo

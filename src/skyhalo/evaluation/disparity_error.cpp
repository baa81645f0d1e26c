#include "skyhalo/evaluation/disparity_error.hpp"

#include <cmath>
#include <limits>

#include "skyhalo/base/error.hpp"

namespace skyhalo {
namespace {

double share(std::int64_t part, std::int64_t whole) noexcept {
  return whole > 0 ? static_cast<double>(part) / static_cast<double>(whole)
                   : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

double DisparityError::density() const noexcept {
  return share(matched_px, truth_px);
}

double DisparityError::bad_among_matched() const noexcept {
  return share(bad_px, matched_px);
}

double DisparityError::bad_or_unmatched() const noexcept {
  return share(truth_px - matched_px + bad_px, truth_px);
}

DisparityError compare_disparity(const cv::Mat1f& disparity_px,
                                 const cv::Mat1f& truth_px,
                                 double threshold_px) {
  if (disparity_px.size() != truth_px.size()) {
    throw Error(ErrorKind::kInput, "disparity and truth: images of different sizes");
  }
  DisparityError error;
  for (int v = 0; v < truth_px.rows; ++v) {
    for (int u = 0; u < truth_px.cols; ++u) {
      const double truth = truth_px(v, u);
      const double found = disparity_px(v, u);
      const bool known = !std::isnan(truth);
      const bool matched = known && !std::isnan(found);
      error.truth_px += known ? 1 : 0;
      error.matched_px += matched ? 1 : 0;
      error.bad_px += matched && std::abs(found - truth) > threshold_px ? 1 : 0;
    }
  }
  return error;
}

}  // namespace skyhalo

#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/core.hpp>

#include "skyhalo/stereo/matcher.hpp"
#include "support/textured_pair.hpp"

namespace skyhalo::testing {

inline MatcherConfig small_config(MatcherKind kind) {
  MatcherConfig config;
  config.kind = kind;
  config.max_disparity_px = 48;
  return config;
}

/// Does the work with a configuration of each engine.
template <class Work>
void for_each_engine(const Work& work) {
  {
    SCOPED_TRACE("sgm");
    work(small_config(MatcherKind::kSgm));
  }
  {
    SCOPED_TRACE("opencv");
    work(small_config(MatcherKind::kOpencv));
  }
}

inline cv::Mat1f matched(const TexturedPair& pair, const MatcherConfig& config) {
  Matcher matcher(config);
  cv::Mat1f disparity;
  matcher.match(pair.left, pair.right, disparity);
  return disparity;
}

/// Share of the pixels in the columns whose disparity is within 0.25 px of the expected.
inline double share_right(const cv::Mat1f& disparity,
                          const cv::Range& columns,
                          double expected_px) {
  int right = 0;
  for (int v = 0; v < disparity.rows; ++v) {
    for (int u = columns.start; u < columns.end; ++u) {
      right += std::abs(disparity(v, u) - expected_px) <= 0.25 ? 1 : 0;  // false for NaN
    }
  }
  return static_cast<double>(right) / (disparity.rows * columns.size());
}

inline int count_found(const cv::Mat1f& disparity) {
  int found = 0;
  for (const float d_px : disparity) {
    found += std::isnan(d_px) ? 0 : 1;
  }
  return found;
}

inline double density(const cv::Mat1f& disparity) {
  return static_cast<double>(count_found(disparity)) / static_cast<double>(disparity.total());
}

/// The pair as two cameras see it in a mirror: left and right change places.
inline TexturedPair mirrored(const TexturedPair& pair) {
  TexturedPair result;
  cv::flip(pair.right, result.left, 1);
  cv::flip(pair.left, result.right, 1);
  return result;
}

/// Two planes, one above the other.
inline TexturedPair two_planes(int upper_px, int lower_px, unsigned seed) {
  const TexturedPair upper = textured_pair({200, 40}, upper_px, seed);
  const TexturedPair lower = textured_pair({200, 40}, lower_px, seed + 1000);
  TexturedPair result;
  cv::vconcat(upper.left, lower.left, result.left);
  cv::vconcat(upper.right, lower.right, result.right);
  return result;
}

}  // namespace skyhalo::testing

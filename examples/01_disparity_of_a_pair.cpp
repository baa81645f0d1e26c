// Dense disparities of one rectified pair, aligned with the right image.
//
// Two pictures of a random texture, 12 pixels apart, stand in for a pair of cameras in front of a
// wall.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <opencv2/core.hpp>
#include <vector>

#include "skyhalo/stereo/matcher.hpp"

int main() {
  constexpr int kDisparityPx = 12;
  cv::Mat1b scene(120, 320 + kDisparityPx);
  cv::RNG(1).fill(scene, cv::RNG::UNIFORM, 0, 256);
  const cv::Mat1b left = scene.colRange(0, 320).clone();
  const cv::Mat1b right = scene.colRange(kDisparityPx, 320 + kDisparityPx).clone();

  skyhalo::Matcher matcher({.max_disparity_px = 32});
  cv::Mat1f disparity;
  matcher.match(left, right, disparity);

  std::vector<float> found;  // NaN marks pixels without a match
  std::copy_if(disparity.begin(), disparity.end(), std::back_inserter(found), [](float d) {
    return !std::isnan(d);
  });
  if (found.empty()) {
    return 1;
  }
  std::nth_element(found.begin(), found.begin() + static_cast<long>(found.size() / 2), found.end());
  std::printf("median disparity %.1f px, %.0f %% of the pixels matched\n",
              static_cast<double>(found[found.size() / 2]),
              100.0 * static_cast<double>(found.size()) / static_cast<double>(disparity.total()));
  return 0;
}

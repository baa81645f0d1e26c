#pragma once

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

namespace skyhalo::testing {

/// A random texture with details of a few pixels, the same for the same seed.
inline cv::Mat1b texture(const cv::Size& size, unsigned seed) {
  cv::Mat1b noise(size);
  cv::RNG random(seed);
  random.fill(noise, cv::RNG::UNIFORM, 0, 256);
  cv::Mat1b smooth;
  cv::GaussianBlur(noise, smooth, cv::Size(3, 3), 0.8);
  return smooth;
}

/// A rectified pair that sees one plane at a whole disparity everywhere: right pixel (u, v) is left
/// pixel (u + disparity, v).
struct TexturedPair {
  cv::Mat1b left;
  cv::Mat1b right;
};

inline TexturedPair textured_pair(const cv::Size& size, int disparity_px, unsigned seed) {
  const cv::Mat1b wide = texture({size.width + disparity_px, size.height}, seed);
  return {wide.colRange(0, size.width).clone(),
          wide.colRange(disparity_px, size.width + disparity_px).clone()};
}

}  // namespace skyhalo::testing

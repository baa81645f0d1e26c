#pragma once

#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

#include "skyhalo/base/timestamp.hpp"
#include "skyhalo/camera/pinhole_pair.hpp"
#include "skyhalo/geometry/pose.hpp"

namespace skyhalo {

/// One stereo pair of the vehicle.
struct StereoPair {
  std::string name;                       ///< for messages and file names
  cv::Size image_size_px;                 ///< of the rectified images before any shrinking
  PinholePair model;                      ///< at that size
  Pose T_body_camera = Pose::Identity();  ///< `cam` (rectified right camera) to body
  std::vector<cv::Rect> masks_px;         ///< airframe, in rectified full-resolution pixels
};

/// All stereo pairs of the vehicle.
struct StereoRig {
  std::vector<StereoPair> pairs;
};

/// The images of one pair: 8- or 16-bit, grey or BGR(A), both of the pair's size.
struct StereoImages {
  cv::Mat left;
  cv::Mat right;
};

/// The images of all pairs, in the order of the rig, taken at one moment.
struct FrameSet {
  Timestamp stamp;
  std::vector<StereoImages> pairs;
};

}  // namespace skyhalo

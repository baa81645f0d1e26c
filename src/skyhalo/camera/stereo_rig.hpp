#pragma once

#include <opencv2/core/mat.hpp>
#include <optional>
#include <string>
#include <vector>

#include "skyhalo/base/timestamp.hpp"
#include "skyhalo/camera/pair_model.hpp"
#include "skyhalo/camera/raw_pair.hpp"
#include "skyhalo/geometry/pose.hpp"

namespace skyhalo {

/// How the raw images of a pair become rectified ones.
struct RawImaging {
  RawCamera left;
  RawCamera right;
  Eigen::Matrix3d R_left_cam = Eigen::Matrix3d::Identity();   ///< `cam` to raw left camera
  Eigen::Matrix3d R_right_cam = Eigen::Matrix3d::Identity();  ///< `cam` to raw right camera
};

/// One stereo pair of the vehicle, ready for use. A number that is left out is the configuration's.
struct StereoPair {
  std::string name;                        ///< for messages and file names
  cv::Size image_size_px;                  ///< of the rectified images before any shrinking
  PairModel model;                         ///< at that size
  Pose T_body_camera = Pose::Identity();   ///< `cam` (rectified right camera) to body
  std::vector<cv::Rect> masks_px = {};     ///< airframe, in rectified full-resolution pixels
  std::optional<RawImaging> raw = {};      ///< where images come raw; else they come rectified
  std::optional<int> downscale = {};       ///< whole factor before matching, 1...16
  std::optional<int> rcrop_px = {};        ///< right-most columns of the matched image discarded
  std::optional<double> min_range_m = {};  ///< nearer points (from the camera) are left out
  std::optional<double> max_range_m = {};  ///< farther points (from the camera) are left out
  double line_time_s = 0.0;                ///< rolling shutter, from row to row; 0 is global
};

/// Size of the images that the pair's left or right camera gives: raw where the pair is raw.
[[nodiscard]] inline cv::Size left_image_size_px(const StereoPair& pair) noexcept {
  return pair.raw ? pair.raw->left.size_px : pair.image_size_px;
}

[[nodiscard]] inline cv::Size right_image_size_px(const StereoPair& pair) noexcept {
  return pair.raw ? pair.raw->right.size_px : pair.image_size_px;
}

/// All stereo pairs of the vehicle.
struct StereoRig {
  std::vector<StereoPair> pairs;
};

/// The images of one pair: 8- or 16-bit, grey or BGR(A), both of the raw cameras' sizes where the
/// pair is raw, else of the pair's size.
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

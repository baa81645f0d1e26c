#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "skyhalo/camera/stereo_rig.hpp"
#include "skyhalo/camera/virtual_pair.hpp"

namespace skyhalo {

/// A raw pair as a rig file describes it: its images are to be rectified.
struct RawPairDescription {
  RawPair cameras;
  VirtualPairWish rectify_to;
};

/// A pair whose images come rectified.
struct RectifiedPairDescription {
  cv::Size size_px;
  PairModel model;
};

/// One pair as a rig file describes it; what is left out is chosen or the configuration's.
struct PairDescription {
  std::string name;
  std::variant<RawPairDescription, RectifiedPairDescription> images;
  Pose T_body_camera = Pose::Identity();  ///< the right camera to body: raw where the pair is raw
  std::optional<int> downscale = {};      ///< whole factor before matching, 1...16
  std::optional<int> rcrop_px = {};       ///< right-most columns of the matched image discarded
  std::vector<cv::Rect> masks_px = {};    ///< airframe, in rectified full-resolution pixels
  std::optional<double> min_range_m = {};
  std::optional<double> max_range_m = {};
  double line_time_s = 0.0;  ///< rolling shutter, from row to row; 0 is global
};

/// A rig file's content: what is known of the vehicle's cameras, before anything is derived from
/// it.
struct RigDescription {
  std::string name;
  std::optional<Pose> T_body_imu;  ///< where calibration and poses refer to an IMU
  std::vector<PairDescription> pairs;
};

/// The rig that the description means: virtual pairs of the raw ones are chosen. Throws `Error`
/// (input) with `pairs[i].key` for what cannot be used.
[[nodiscard]] StereoRig resolve(const RigDescription& description);

}  // namespace skyhalo

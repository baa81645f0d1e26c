#pragma once

#include <opencv2/core/types.hpp>

#include "skyhalo/camera/lens.hpp"
#include "skyhalo/geometry/pose.hpp"

namespace skyhalo {

/// A camera as it is built: its image size and its lens. Frame: x right, y down, z forward.
struct RawCamera {
  cv::Size size_px;
  Lens lens;
};

/// Two raw cameras and how they stand to each other.
struct RawPair {
  RawCamera left;
  RawCamera right;
  Pose T_right_left = Pose::Identity();  ///< raw left camera to raw right camera
};

}  // namespace skyhalo

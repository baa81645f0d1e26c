#pragma once

#include <opencv2/core/types.hpp>
#include <optional>

#include "skyhalo/camera/lens.hpp"
#include "skyhalo/geometry/pose.hpp"

namespace skyhalo {

/// A camera as it is built: its image size and its lens. Frame: x right, y down, z forward.
struct RawCamera {
  cv::Size size_px;
  Lens lens;
};

/// True when the camera images the ray (its own frame) inside its outermost pixel centres.
[[nodiscard]] inline bool sees(const RawCamera& camera, const Eigen::Vector3d& ray) noexcept {
  const std::optional<Eigen::Vector2d> pixel = project(camera.lens, ray);
  return pixel && pixel->x() >= 0.0 && pixel->y() >= 0.0 &&
         pixel->x() <= camera.size_px.width - 1.0 && pixel->y() <= camera.size_px.height - 1.0;
}

/// Two raw cameras and how they stand to each other.
struct RawPair {
  RawCamera left;
  RawCamera right;
  Pose T_right_left = Pose::Identity();  ///< raw left camera to raw right camera
};

}  // namespace skyhalo

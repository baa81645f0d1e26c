#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <string>

#include "skyhalo/camera/stereo_rig.hpp"
#include "skyhalo/dataset/kitti_labels.hpp"
#include "skyhalo/dataset/scene_object.hpp"

namespace skyhalo {

/// The camera that labels are given for: a rectified pinhole camera, whose frame is also that of
/// the boxes.
struct LabelCamera {
  double focal_px = 0.0;
  double principal_u_px = 0.0;
  double principal_v_px = 0.0;
  cv::Size size_px;
};

/// The values of an object's label (m) where its pose in the camera's frame is known: the smallest
/// box that holds the object's, stands upright along the camera's y axis and looks where the
/// object's x axis points across it. Before a level camera it is the object's own.
[[nodiscard]] LabelBox label_box(const SceneObject& object, const Pose& T_camera_object);

/// Where a box shows in the image: pixels, edges included.
struct LabelRegion {
  Eigen::AlignedBox2d box_px;  ///< of the projected corners, cut to the image
  int truncated = 0;           ///< 0 whole, 1 up to half of it is outside, 2 more
};

/// None where nothing of the box is in front of the camera and within the image. What lies nearer
/// than 0.1 m, or behind, is cut off before it is projected.
[[nodiscard]] std::optional<LabelRegion> label_region(const LabelBox& box,
                                                      const LabelCamera& camera);

/// The line of a tracking label file: 17 columns, with the angle alpha between the box and the ray
/// to it in -pi...pi. None where `label_region` has none.
[[nodiscard]] std::optional<std::string> label_line(const SceneObject& object,
                                                    int frame,
                                                    const Pose& T_camera_object,
                                                    const LabelCamera& camera);

}  // namespace skyhalo

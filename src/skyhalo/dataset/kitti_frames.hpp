#pragma once

#include <opencv2/core/types.hpp>
#include <span>

#include "skyhalo/calibration/kitti_calibration.hpp"
#include "skyhalo/camera/stereo_rig.hpp"
#include "skyhalo/dataset/laser_source.hpp"

namespace skyhalo {

/// The calibrated pair as a rig: `front`, in the frame of the INS. Internal to this layer, as all
/// of this header.
[[nodiscard]] StereoRig kitti_stereo_rig(const KittiCalibration& calibration,
                                         const cv::Size& size_px);

/// The annotated camera, which is the left one; its principal point differs from the right one's by
/// the disparity offset.
[[nodiscard]] TruthCamera kitti_truth_camera(const KittiCalibration& calibration,
                                             const cv::Size& size_px);

/// Gives a drive another body than the INS. The map frame is then that body's at the first frame.
void move_body(const Pose& T_body_imu, KittiCalibration& calibration, std::span<Pose> poses);

}  // namespace skyhalo

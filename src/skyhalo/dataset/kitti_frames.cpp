#include "skyhalo/dataset/kitti_frames.hpp"

namespace skyhalo {

StereoRig kitti_stereo_rig(const KittiCalibration& calibration, const cv::Size& size_px) {
  return {{{.name = "front",
            .image_size_px = size_px,
            .model = calibration.pair,
            .T_body_camera = calibration.T_body_right(),
            .masks_px = {}}}};
}

TruthCamera kitti_truth_camera(const KittiCalibration& calibration, const cv::Size& size_px) {
  const PinholePair& pair = calibration.pair;
  return {pair.focal_px,
          pair.principal_u_px - pair.disparity_offset_px,
          pair.principal_v_px,
          size_px,
          calibration.T_left_reference * calibration.T_reference_laser};
}

void move_body(const Pose& T_body_imu, KittiCalibration& calibration, std::span<Pose> poses) {
  calibration.T_body_laser = T_body_imu * calibration.T_body_laser;
  for (Pose& T_map_body : poses) {
    T_map_body = T_body_imu * T_map_body * T_body_imu.inverse();
  }
}

}  // namespace skyhalo

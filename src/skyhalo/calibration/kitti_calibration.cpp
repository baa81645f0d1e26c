#include "skyhalo/calibration/kitti_calibration.hpp"

#include <string>
#include <vector>

#include "skyhalo/calibration/key_value_file.hpp"
#include "skyhalo/calibration/kitti_projection.hpp"

namespace skyhalo {
namespace {

Pose read_transform(const KeyValueFile& file) {
  const std::vector<double> t_m = file.numbers("T", 3);
  return make_pose(read_kitti_rotation(file, "R"), Eigen::Vector3d(t_m[0], t_m[1], t_m[2]));
}

std::string projection_key(int camera) {
  return "P_rect_0" + std::to_string(camera);
}

}  // namespace

KittiCalibration read_kitti_raw_calibration(const std::filesystem::path& day_folder,
                                            KittiPair pair) {
  const KeyValueFile cameras(day_folder / "calib_cam_to_cam.txt");
  const KittiProjections projections = read_kitti_projections(
      cameras, projection_key(left_camera(pair)), projection_key(left_camera(pair) + 1));
  const Pose T_camera_laser = read_transform(KeyValueFile(day_folder / "calib_velo_to_cam.txt"));
  const Pose T_laser_body = read_transform(KeyValueFile(day_folder / "calib_imu_to_velo.txt"));
  const Eigen::Matrix3d R_reference_camera = read_kitti_rotation(cameras, "R_rect_00");
  return {
      .pair = projections.pair,
      .T_body_laser = T_laser_body.inverse(),
      .T_reference_laser = make_pose(R_reference_camera, Eigen::Vector3d::Zero()) * T_camera_laser,
      .T_left_reference = projections.T_left_reference,
      .T_right_reference = projections.T_right_reference};
}

}  // namespace skyhalo

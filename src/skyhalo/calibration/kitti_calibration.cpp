#include "skyhalo/calibration/kitti_calibration.hpp"

#include <string>
#include <vector>

#include "skyhalo/calibration/key_value_file.hpp"
#include "skyhalo/calibration/kitti_projection.hpp"
#include "skyhalo/calibration/rotation_input.hpp"

namespace skyhalo {
namespace {

using RowMajor34 = Eigen::Matrix<double, 3, 4, Eigen::RowMajor>;

Pose read_transform(const KeyValueFile& file) {
  const std::vector<double> t_m = file.numbers("T", 3);
  return make_pose(read_kitti_rotation(file, "R"), Eigen::Vector3d(t_m[0], t_m[1], t_m[2]));
}

std::string projection_key(int camera) {
  return "P_rect_0" + std::to_string(camera);
}

/// The first spelling that is there; throws when none is.
std::string spelling(const KeyValueFile& file,
                     const std::string& first,
                     const std::string& second) {
  if (!file.has(first) && !file.has(second)) {
    throw file.error(first, "this key is missing, and so is " + second);
  }
  return file.has(first) ? first : second;
}

/// A transform of 12 numbers, row by row (m).
Pose read_matrix(const KeyValueFile& file, const std::string& key) {
  const std::vector<double> values = file.numbers(key, 12);
  const RowMajor34 T = Eigen::Map<const RowMajor34>(values.data());
  const Eigen::Matrix3d R = T.leftCols<3>();
  if (!is_rotation(R, 1e-4)) {
    throw file.error(key, "its first three columns are not a rotation matrix");
  }
  return make_pose(nearest_rotation(R), T.col(3));
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

KittiCalibration read_kitti_tracking_calibration(const std::filesystem::path& file) {
  const KeyValueFile values(file);
  const KittiProjections projections = read_kitti_projections(values, "P2", "P3");
  const Pose T_laser_body = read_matrix(values, spelling(values, "Tr_imu_velo", "Tr_imu_to_velo"));
  const Pose T_camera_laser =
      read_matrix(values, spelling(values, "Tr_velo_cam", "Tr_velo_to_cam"));
  const Eigen::Matrix3d R_reference_camera =
      nearest_rotation(read_kitti_rotation(values, spelling(values, "R_rect", "R0_rect")));
  return {
      .pair = projections.pair,
      .T_body_laser = T_laser_body.inverse(),
      .T_reference_laser = make_pose(R_reference_camera, Eigen::Vector3d::Zero()) * T_camera_laser,
      .T_left_reference = projections.T_left_reference,
      .T_right_reference = projections.T_right_reference};
}

}  // namespace skyhalo

#include "skyhalo/dataset/kitti_calibration.hpp"

#include <string>

#include "skyhalo/dataset/key_value_file.hpp"

namespace skyhalo {
namespace {

using RowMajor3 = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
using RowMajor34 = Eigen::Matrix<double, 3, 4, Eigen::RowMajor>;

// The files print seven digits.
constexpr double kRotationTolerance = 1e-4;

Eigen::Matrix3d read_rotation(const KeyValueFile& file, const std::string& key) {
  const std::vector<double> values = file.numbers(key, 9);
  Eigen::Matrix3d R = Eigen::Map<const RowMajor3>(values.data());
  if (!is_rotation(R, kRotationTolerance)) {
    throw file.error(key, "is not a rotation matrix");
  }
  return R;
}

Pose read_transform(const KeyValueFile& file) {
  const std::vector<double> t_m = file.numbers("T", 3);
  return make_pose(read_rotation(file, "R"), Eigen::Vector3d(t_m[0], t_m[1], t_m[2]));
}

/// A 3x4 projection matrix P = K [I | t] of a rectified camera.
struct Projection {
  double focal_px = 0.0;
  double principal_u_px = 0.0;
  double principal_v_px = 0.0;
  Eigen::Vector3d t_m = Eigen::Vector3d::Zero();  ///< reference to this camera
};

Projection read_projection(const KeyValueFile& file, const std::string& key) {
  const std::vector<double> values = file.numbers(key, 12);
  const RowMajor34 P = Eigen::Map<const RowMajor34>(values.data());
  if (!(P(0, 0) > 0.0) || P(0, 0) != P(1, 1) || P(2, 2) != 1.0) {
    throw file.error(key, "is not the projection of a rectified camera (equal focal lengths > 0)");
  }
  const Eigen::Matrix3d K = P.leftCols<3>();
  return {P(0, 0), P(0, 2), P(1, 2), K.inverse() * P.col(3)};
}

std::string camera_key(const std::string& prefix, int camera) {
  return prefix + "_0" + std::to_string(camera);
}

}  // namespace

KittiCalibration read_kitti_raw_calibration(const std::filesystem::path& day_folder,
                                            KittiPair pair) {
  const KeyValueFile cameras(day_folder / "calib_cam_to_cam.txt");
  const std::string left_key = camera_key("P_rect", left_camera(pair));
  const std::string right_key = camera_key("P_rect", left_camera(pair) + 1);
  const Projection left = read_projection(cameras, left_key);
  const Projection right = read_projection(cameras, right_key);
  const double baseline_m = left.t_m.x() - right.t_m.x();
  if (!(baseline_m > 0.0)) {
    throw cameras.error(right_key, "the right camera is not to the right of the left one");
  }
  if (left.principal_v_px != right.principal_v_px) {
    throw cameras.error(right_key, "the principal point's row differs from the left camera's");
  }
  if (left.focal_px != right.focal_px) {
    throw cameras.error(right_key, "the focal length differs from the left camera's");
  }
  const Pose T_camera_laser = read_transform(KeyValueFile(day_folder / "calib_velo_to_cam.txt"));
  const Pose T_laser_body = read_transform(KeyValueFile(day_folder / "calib_imu_to_velo.txt"));
  const Eigen::Matrix3d R_reference_camera = read_rotation(cameras, "R_rect_00");
  return {
      .pair = {right.focal_px,
               right.principal_u_px,
               right.principal_v_px,
               baseline_m,
               right.principal_u_px - left.principal_u_px},
      .T_body_laser = T_laser_body.inverse(),
      .T_reference_laser = make_pose(R_reference_camera, Eigen::Vector3d::Zero()) * T_camera_laser,
      .T_left_reference = make_pose(Eigen::Matrix3d::Identity(), left.t_m),
      .T_right_reference = make_pose(Eigen::Matrix3d::Identity(), right.t_m)};
}

}  // namespace skyhalo

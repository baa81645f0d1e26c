#include "skyhalo/calibration/kitti_projection.hpp"

#include <vector>

namespace skyhalo {
namespace {

using RowMajor3 = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
using RowMajor34 = Eigen::Matrix<double, 3, 4, Eigen::RowMajor>;

// The files print seven digits.
constexpr double kRotationTolerance = 1e-4;

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

}  // namespace

Eigen::Matrix3d read_kitti_rotation(const KeyValueFile& file, const std::string& key) {
  const std::vector<double> values = file.numbers(key, 9);
  Eigen::Matrix3d R = Eigen::Map<const RowMajor3>(values.data());
  if (!is_rotation(R, kRotationTolerance)) {
    throw file.error(key, "is not a rotation matrix");
  }
  return R;
}

KittiProjections read_kitti_projections(const KeyValueFile& file,
                                        const std::string& left_key,
                                        const std::string& right_key) {
  const Projection left = read_projection(file, left_key);
  const Projection right = read_projection(file, right_key);
  const double baseline_m = left.t_m.x() - right.t_m.x();
  if (!(baseline_m > 0.0)) {
    throw file.error(right_key, "the right camera is not to the right of the left one");
  }
  if (left.principal_v_px != right.principal_v_px) {
    throw file.error(right_key, "the principal point's row differs from the left camera's");
  }
  if (left.focal_px != right.focal_px) {
    throw file.error(right_key, "the focal length differs from the left camera's");
  }
  return {.pair = {right.focal_px,
                   right.principal_u_px,
                   right.principal_v_px,
                   baseline_m,
                   right.principal_u_px - left.principal_u_px},
          .T_left_reference = make_pose(Eigen::Matrix3d::Identity(), left.t_m),
          .T_right_reference = make_pose(Eigen::Matrix3d::Identity(), right.t_m)};
}

}  // namespace skyhalo

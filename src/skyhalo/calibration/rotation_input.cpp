#include "skyhalo/calibration/rotation_input.hpp"

#include <Eigen/SVD>
#include <cmath>
#include <sstream>

namespace skyhalo {
namespace {

using RowMajor3 = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
using RowMajor4 = Eigen::Matrix<double, 4, 4, Eigen::RowMajor>;

constexpr double kWarnAbove = 1e-5;
constexpr double kRefuseAbove = 1e-3;

std::string off_by(std::string_view what, double distance) {
  std::ostringstream text;
  text << what << " by " << distance;
  return text.str();
}

/// Complains when the distance is large; a NaN is.
void judge(double distance,
           std::string_view what,
           const ErrorAt& error_at,
           std::vector<std::string>& warnings) {
  if (!(distance <= kRefuseAbove)) {
    throw error_at(off_by(what, distance) + ", expected at most 0.001");
  }
  if (distance > kWarnAbove) {
    warnings.emplace_back(error_at(off_by(what, distance) + "; made a rotation").what());
  }
}

void expect_count(std::span<const double> numbers, std::size_t count, const ErrorAt& error_at) {
  if (numbers.size() != count) {
    throw error_at("expected " + std::to_string(count) + " numbers, found " +
                   std::to_string(numbers.size()));
  }
}

}  // namespace

Eigen::Matrix3d nearest_rotation(const Eigen::Matrix3d& R) {
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(R, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const double handedness = (svd.matrixU() * svd.matrixV().transpose()).determinant();
  const Eigen::Vector3d signs(1.0, 1.0, handedness < 0.0 ? -1.0 : 1.0);
  return svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();
}

Eigen::Matrix3d rotation_from(const Eigen::Matrix3d& R,
                              const ErrorAt& error_at,
                              std::vector<std::string>& warnings) {
  const Eigen::Matrix3d residual = R * R.transpose() - Eigen::Matrix3d::Identity();
  const double distance = residual.cwiseAbs().maxCoeff();
  judge(distance, "the rotation is not orthonormal", error_at, warnings);
  if (R.determinant() < 0.0) {
    throw error_at("the rotation is a mirror image (its determinant is -1)");
  }
  // What was only printed with few digits stays to the last bit: files can be read back unchanged,
  // and mean what other readers of them take them for.
  return distance <= kWarnAbove ? R : nearest_rotation(R);
}

Eigen::Matrix3d rotation_from(std::span<const double> numbers,
                              const ErrorAt& error_at,
                              std::vector<std::string>& warnings) {
  expect_count(numbers, 9, error_at);
  const Eigen::Matrix3d R = Eigen::Map<const RowMajor3>(numbers.data());
  return rotation_from(R, error_at, warnings);
}

Eigen::Matrix3d rotation_from(const Eigen::Quaterniond& q,
                              const ErrorAt& error_at,
                              std::vector<std::string>& warnings) {
  judge(std::abs(q.norm() - 1.0), "the norm of the quaternion is off 1", error_at, warnings);
  return q.normalized().toRotationMatrix();
}

Pose pose_from(std::span<const double> numbers,
               const ErrorAt& error_at,
               std::vector<std::string>& warnings) {
  expect_count(numbers, 16, error_at);
  const Eigen::Matrix4d T = Eigen::Map<const RowMajor4>(numbers.data());
  if (!T.row(3).isApprox(Eigen::RowVector4d(0.0, 0.0, 0.0, 1.0), 1e-9)) {
    throw error_at("expected 0 0 0 1 as the last row of the transform");
  }
  const Eigen::Matrix3d R = T.topLeftCorner<3, 3>();
  return make_pose(rotation_from(R, error_at, warnings), T.topRightCorner<3, 1>());
}

}  // namespace skyhalo

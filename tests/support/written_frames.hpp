#pragma once

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <opencv2/core.hpp>
#include <random>
#include <string>

#include "skyhalo/calibration/rig_description.hpp"
#include "skyhalo/dataset/scene_object.hpp"
#include "skyhalo/dataset/velodyne_file.hpp"
#include "support/textured_pair.hpp"

namespace skyhalo::testing {

/// Looking ahead: the camera's x is the body's -y, its y the body's -z, its z the body's x.
inline Eigen::Matrix3d forward_camera() {
  Eigen::Matrix3d R;
  R << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  return R;
}

/// A rectified pinhole pair: the right camera at (1, -0.25, 0.375) of the body, the left one 0.5 m
/// to its left, whose principal point is 4 px further left.
inline PairDescription forward_pair() {
  return {.name = "front",
          .images = RectifiedPairDescription{{320, 96}, PinholePair{256.0, 160.0, 48.0, 0.5, 4.0}},
          .T_body_camera = make_pose(forward_camera(), {1.0, -0.25, 0.375})};
}

/// The scanner's place in the body.
inline Pose laser_place() {
  return make_pose(Eigen::Matrix3d::Identity(), {0.75, 0.0, 0.5});
}

/// Some pose, far from the origin for large `spread_m`.
inline Pose some_pose(std::mt19937& random, double spread_m) {
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  Eigen::Quaterniond q(unit(random), unit(random), unit(random), unit(random));
  const double x = unit(random);
  const double y = unit(random);
  const double z = unit(random);
  return make_pose(q.normalized().toRotationMatrix(), spread_m * Eigen::Vector3d(x, y, z));
}

/// A pose of a vehicle: any heading, tilted up to about 0.3 rad.
inline Pose driving_pose(std::mt19937& random, double spread_m) {
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  const Eigen::AngleAxisd yaw(3.1 * unit(random), Eigen::Vector3d::UnitZ());
  const Eigen::AngleAxisd pitch(0.3 * unit(random), Eigen::Vector3d::UnitY());
  const Eigen::AngleAxisd roll(0.3 * unit(random), Eigen::Vector3d::UnitX());
  const double x = unit(random);
  const double y = unit(random);
  return make_pose((yaw * pitch * roll).toRotationMatrix(), spread_m * Eigen::Vector3d(x, y, 0.02));
}

inline StereoImages textured_images(const cv::Size& size, unsigned seed) {
  return {texture(size, 2 * seed + 1), texture(size, 2 * seed + 2)};
}

/// A few points, exactly representable or not.
inline LaserReturns some_scan(unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> unit(-40.0F, 40.0F);
  LaserReturns scan;
  for (int i = 0; i < 20; ++i) {
    const float x = unit(random);
    const float y = unit(random);
    scan.points_m.emplace_back(x, y, unit(random));
    scan.reflectances.push_back(0.05F * static_cast<float>(i));
  }
  return scan;
}

inline bool same_image(const cv::Mat& a, const cv::Mat& b) {
  return a.size() == b.size() && a.type() == b.type() && cv::norm(a, b, cv::NORM_INF) == 0.0;
}

/// How far two poses are apart (m) and turned (rad).
struct PoseDifference {
  double distance_m = 0.0;
  double angle_rad = 0.0;
};

inline PoseDifference difference(const Pose& a, const Pose& b) {
  // For small angles as good as the angle, and without the arc cosine's loss of digits.
  return {(a.translation() - b.translation()).norm(), (a.linear() - b.linear()).norm()};
}

inline std::string text_in(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

}  // namespace skyhalo::testing

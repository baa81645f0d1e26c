#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <opencv2/core.hpp>
#include <vector>

#include "skyhalo/camera/stereo_rig.hpp"
#include "skyhalo/camera/virtual_pair.hpp"
#include "support/example_lenses.hpp"

namespace skyhalo::testing {

/// One lens of each model, each with an image of 752 x 480 px and about 350 to 460 px per radian.
inline std::vector<ExampleLens> four_lenses() {
  return {radial_tangential_examples()[1],
          kannala_brandt_examples()[0],
          double_sphere_examples()[0],
          extended_unified_examples()[0]};
}

inline RawCamera camera_of(const ExampleLens& example) {
  return {example.size_px, example.lens};
}

/// What a camera sees when `grey` gives the value that comes along a ray (unit vector in the raw
/// camera's frame). Pixels that the lens does not show get `outside`.
template <class Grey>
cv::Mat1b render(const RawCamera& camera, const Grey& grey, double outside = 0.0) {
  cv::Mat1b image(camera.size_px);
  for (int v = 0; v < image.rows; ++v) {
    for (int u = 0; u < image.cols; ++u) {
      const auto ray = unproject(camera.lens, {static_cast<double>(u), static_cast<double>(v)});
      image(v, u) = cv::saturate_cast<uchar>(ray ? grey(*ray) : outside);
    }
  }
  return image;
}

/// A smooth pattern (grey levels) of the viewing direction: waves of 0.3 rad and more.
inline double wavy_sky(const Eigen::Vector3d& ray) {
  return 128.0 + 35.0 * std::sin(18.0 * ray.x() + 0.3) +
         30.0 * std::sin(15.0 * ray.y() + 7.0 * ray.x() + 1.1) +
         25.0 * std::cos(16.0 * ray.z() - 9.0 * ray.y());
}

/// Two cameras with these lenses. Their frames are turned from a common one by up to 4 degrees
/// each; the left one is 0.3 m to the left, up to 3 degrees askew.
inline RawPair turned_pair(const ExampleLens& left, const ExampleLens& right, RandomRays& random) {
  constexpr double kTurn = 4.0 * std::numbers::pi / 180.0;
  constexpr double kBaselineM = 0.3;
  const Eigen::Matrix3d R_left_common = random.rotation(kTurn);
  const Eigen::Matrix3d R_right_common = random.rotation(kTurn);
  const Eigen::Vector3d left_m =
      -kBaselineM * (random.rotation(0.75 * kTurn) * Eigen::Vector3d::UnitX());
  return {.left = camera_of(left),
          .right = camera_of(right),
          .T_right_left =
              make_pose(R_right_common * R_left_common.transpose(), R_right_common * left_m)};
}

/// The pair as a rig has it, with the virtual pair that is wished.
inline StereoPair stereo_pair(const RawPair& raw, const VirtualPairWish& wish) {
  const VirtualPair chosen = make_virtual_pair(raw, wish);
  StereoPair pair;
  pair.name = "front";
  pair.image_size_px = chosen.size_px;
  pair.model = chosen.model;
  pair.raw = RawImaging{.left = raw.left,
                        .right = raw.right,
                        .R_left_cam = chosen.R_left_cam,
                        .R_right_cam = chosen.R_right_cam};
  return pair;
}

/// The images of a scene: `grey` gives the value that comes to a place (m) along a ray (unit
/// vector away from it), both in the raw right camera's frame.
template <class Grey>
StereoImages render_pair(const RawPair& raw, const Grey& grey, double outside = 0.0) {
  const Eigen::Matrix3d R_right_left = raw.T_right_left.linear();
  const Eigen::Vector3d left_m = raw.T_right_left.translation();
  const Eigen::Vector3d right_m = Eigen::Vector3d::Zero();
  return {render(
              raw.left,
              [&](const Eigen::Vector3d& ray) { return grey(left_m, R_right_left * ray); },
              outside),
          render(
              raw.right, [&](const Eigen::Vector3d& ray) { return grey(right_m, ray); }, outside)};
}

/// A plane `normal . p = distance_m`; normal is a unit vector.
struct Plane {
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();
  double distance_m = 1.0;

  /// How far along a ray the plane is; not above 0 or not finite where the ray does not meet it.
  [[nodiscard]] double range_m(const Eigen::Vector3d& from_m, const Eigen::Vector3d& ray) const {
    return (distance_m - normal.dot(from_m)) / normal.dot(ray);
  }
};

}  // namespace skyhalo::testing

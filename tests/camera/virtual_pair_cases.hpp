#pragma once

#include <cmath>
#include <numbers>
#include <opencv2/core.hpp>
#include <optional>
#include <vector>

#include "skyhalo/camera/virtual_pair.hpp"
#include "support/example_lenses.hpp"

namespace skyhalo::testing {

inline constexpr double kDegree = std::numbers::pi / 180.0;

/// Two parallel cameras with the left one `baseline_m` to the left.
inline RawPair parallel_pair(const ExampleLens& example, double baseline_m) {
  RawPair raw{.left = {example.size_px, example.lens}, .right = {example.size_px, example.lens}};
  raw.T_right_left.translation() = Eigen::Vector3d(-baseline_m, 0.0, 0.0);
  return raw;
}

inline ExampleLens euroc() {
  return radial_tangential_examples()[1];
}

inline ExampleLens pinhole() {
  return radial_tangential_examples()[0];
}

/// Lenses that see 70 degrees to every side.
inline std::vector<ExampleLens> wide_lenses() {
  std::vector<ExampleLens> wide;
  for (const auto& example : example_lenses()) {
    if (max_angle_rad(example.lens) > 80.0 * kDegree) {
      wide.push_back(example);
    }
  }
  return wide;
}

/// Lenses of any kind, both cameras turned by up to 5 degrees from the baseline's, which itself is
/// up to `slant_rad` off their x axis.
inline RawPair random_pair(RandomRays& random,
                           const std::vector<ExampleLens>& lenses,
                           double slant_rad) {
  const auto any = [&] {
    return lenses[static_cast<std::size_t>(
        random.in(0.0, static_cast<double>(lenses.size()) - 1e-9))];
  };
  const auto left = any();
  const auto right = any();
  const Eigen::Matrix3d R_left_common = random.rotation(5.0 * kDegree);
  const Eigen::Matrix3d R_right_common = random.rotation(5.0 * kDegree);
  const Eigen::Vector3d left_m =
      -random.in(0.05, 1.0) * (random.rotation(slant_rad) * Eigen::Vector3d::UnitX());
  return {.left = {left.size_px, left.lens},
          .right = {right.size_px, right.lens},
          .T_right_left =
              make_pose(R_right_common * R_left_common.transpose(), R_right_common * left_m)};
}

/// Pixel of a ray (`cam`) in an image of the pair, from the definition of the models.
inline Eigen::Vector2d pixel_of(const PairModel& model, const Eigen::Vector3d& ray) {
  if (const auto* pair = std::get_if<PinholePair>(&model)) {
    return {pair->principal_u_px + pair->focal_px * ray.x() / ray.z(),
            pair->principal_v_px + pair->focal_px * ray.y() / ray.z()};
  }
  const auto& pair = std::get<SphericalPair>(model);
  return {pair.principal_u_px +
              std::atan2(ray.x(), std::hypot(ray.y(), ray.z())) / pair.delta_theta_u_rad,
          pair.principal_v_px + std::atan2(ray.y(), ray.z()) / pair.delta_theta_v_rad};
}

inline Eigen::Vector2d principal_point(const PairModel& model) {
  return pixel_of(model, Eigen::Vector3d::UnitZ());
}

inline double disparity_offset_px(const PairModel& model) {
  const auto* pair = std::get_if<PinholePair>(&model);
  return pair != nullptr ? pair->disparity_offset_px : 0.0;
}

/// The ray of a pixel (`cam`), from the definition of the models.
inline Eigen::Vector3d ray_through(const PairModel& model, double u_px, double v_px) {
  if (const auto* pair = std::get_if<PinholePair>(&model)) {
    return Eigen::Vector3d((u_px - pair->principal_u_px) / pair->focal_px,
                           (v_px - pair->principal_v_px) / pair->focal_px,
                           1.0)
        .normalized();
  }
  const auto& pair = std::get<SphericalPair>(model);
  const double alpha = (u_px - pair.principal_u_px) * pair.delta_theta_u_rad;
  const double beta = (v_px - pair.principal_v_px) * pair.delta_theta_v_rad;
  return {std::sin(alpha), std::cos(alpha) * std::sin(beta), std::cos(alpha) * std::cos(beta)};
}

/// True when the camera sees the ray (raw frame) within its image, give or take `margin_px`.
inline bool sees(const RawCamera& camera, const Eigen::Vector3d& ray, double margin_px) {
  const auto pixel = project(camera.lens, ray);
  return pixel && pixel->x() > -0.5 - margin_px && pixel->y() > -0.5 - margin_px &&
         pixel->x() < camera.size_px.width - 0.5 + margin_px &&
         pixel->y() < camera.size_px.height - 0.5 + margin_px;
}

inline bool both_see(
    const RawPair& raw, const VirtualPair& pair, double u_px, double v_px, double margin_px) {
  const Eigen::Vector3d ray = ray_through(pair.model, u_px, v_px);
  return sees(raw.left, pair.R_left_cam * ray, margin_px) &&
         sees(raw.right, pair.R_right_cam * ray, margin_px);
}

inline VirtualPairWish make_wish(PairModelKind kind,
                                 std::optional<double> hfov_rad = {},
                                 std::optional<double> vfov_rad = {},
                                 std::optional<cv::Size> size_px = {}) {
  return {.model = kind, .hfov_rad = hfov_rad, .vfov_rad = vfov_rad, .size_px = size_px};
}

inline constexpr auto kPinhole = PairModelKind::kPinhole;
inline constexpr auto kSpherical = PairModelKind::kSpherical;
inline constexpr std::nullopt_t kNone = std::nullopt;

inline VirtualPairWish pinhole_wish() {
  return make_wish(kPinhole, 80.0 * kDegree, kNone, cv::Size(640, 400));
}

inline VirtualPairWish spherical_wish() {
  return make_wish(kSpherical, 100.0 * kDegree, 80.0 * kDegree, cv::Size(800, 600));
}

}  // namespace skyhalo::testing

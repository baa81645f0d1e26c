#pragma once

#include <string>
#include <vector>

#include "rectify/raw_scene.hpp"
#include "skyhalo/rectify/remapper.hpp"

namespace skyhalo::testing {

/// A camera, its turn and the virtual image before shrinking.
struct RemapCase {
  std::string name;
  RawCamera camera;
  Eigen::Matrix3d R_raw_cam = Eigen::Matrix3d::Identity();
  PairModel model;
  cv::Size size_px;
};

inline RemapGoal goal_of(const RemapCase& one, int factor) {
  return {.camera = one.camera,
          .R_raw_cam = one.R_raw_cam,
          .model = downscaled(one.model, factor),
          .size_px = {one.size_px.width / factor, one.size_px.height / factor}};
}

/// Every lens, turned by a few degrees, to both models with 400 px per radian in the middle.
inline std::vector<RemapCase> remap_cases(const cv::Size& size_px, unsigned seed) {
  RandomRays random(seed);
  std::vector<RemapCase> cases;
  const double u0_px = 0.5 * size_px.width - 3.7;
  const double v0_px = 0.5 * size_px.height + 2.2;
  for (const ExampleLens& lens : four_lenses()) {
    const Eigen::Matrix3d R_raw_cam = random.rotation(0.1);
    cases.push_back({lens.name + " to pinhole",
                     camera_of(lens),
                     R_raw_cam,
                     PinholePair{.focal_px = 400.0,
                                 .principal_u_px = u0_px,
                                 .principal_v_px = v0_px,
                                 .baseline_m = 0.3,
                                 .disparity_offset_px = 0.0},
                     size_px});
    cases.push_back({lens.name + " to spherical",
                     camera_of(lens),
                     R_raw_cam,
                     SphericalPair{.delta_theta_u_rad = 1.0 / 400.0,
                                   .delta_theta_v_rad = 1.0 / 390.0,
                                   .principal_u_px = u0_px,
                                   .principal_v_px = v0_px,
                                   .baseline_m = 0.3},
                     size_px});
  }
  return cases;
}

/// An ideal pinhole camera, and the virtual one at its own place whose pixel (u, v) sees the raw
/// pixel (u, v) + shift.
inline RemapCase ideal_pinhole(const cv::Size& size_px, const Eigen::Vector2d& shift_px) {
  constexpr double kFocalPx = 200.0;
  const Intrinsics intrinsics{
      kFocalPx, kFocalPx, 0.5 * size_px.width - 0.5, 0.5 * size_px.height - 0.5};
  return {"ideal pinhole",
          {size_px, RadialTangentialLens(intrinsics, {})},
          Eigen::Matrix3d::Identity(),
          PinholePair{.focal_px = kFocalPx,
                      .principal_u_px = intrinsics.cx_px - shift_px.x(),
                      .principal_v_px = intrinsics.cy_px - shift_px.y(),
                      .baseline_m = 0.3,
                      .disparity_offset_px = 0.0},
          size_px};
}

inline cv::Mat1b remapped(Remapper& remapper, const cv::Mat1b& raw) {
  cv::Mat1b out;
  remapper.remap(raw, out);
  return out;
}

}  // namespace skyhalo::testing

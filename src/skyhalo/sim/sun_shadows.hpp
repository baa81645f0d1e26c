#pragma once

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>

#include "skyhalo/sim/scene_tracer.hpp"

namespace skyhalo {

/// Where what stands still keeps the sun away, as a picture of the scene seen from the sun, so that
/// shading a point costs no ray of its own.
class SunShadows {
 public:
  /// Everything is in the light when the scene has no sun.
  explicit SunShadows(const SceneTracer& tracer);

  /// Share of the sun's light, 0...1, that arrives at a point (m, scene) of a surface with this
  /// unit normal.
  [[nodiscard]] float light(const Eigen::Vector3f& point_m,
                            const Eigen::Vector3f& normal) const noexcept;

 private:
  Eigen::Matrix3f R_sun_scene_ = Eigen::Matrix3f::Identity();  // z away from the sun
  Eigen::Vector3f origin_m_ = Eigen::Vector3f::Zero();         // of the picture, sun frame
  float pixel_m_ = 1.0F;
  cv::Mat1f depth_m_;  // from the origin; empty: no shadow anywhere
};

}  // namespace skyhalo

#pragma once

#include <Eigen/Core>
#include <vector>

namespace skyhalo {

/// A lamp that shines in all directions, without shadows.
struct Lamp {
  Eigen::Vector3f position_m = Eigen::Vector3f::Zero();
  Eigen::Vector3f strength_bgr_m2 = Eigen::Vector3f::Ones();  ///< brightness at 1 m
};

/// Where light comes from. A surface that throws all light back has the brightness of the light
/// that falls on it; the camera's exposure maps brightness 1 to white.
struct Lighting {
  Eigen::Vector3f sun_direction = Eigen::Vector3f(0.4F, 0.3F, 0.87F).normalized();  ///< to the sun
  Eigen::Vector3f sun_bgr = Eigen::Vector3f(0.80F, 0.90F, 0.95F);  ///< zero: no sun, no shadows
  Eigen::Vector3f ambient_bgr =
      Eigen::Vector3f(0.40F, 0.36F, 0.34F);  ///< from above; half from below
  Eigen::Vector3f zenith_bgr = Eigen::Vector3f(0.85F, 0.60F, 0.40F);  ///< colour of the sky
  Eigen::Vector3f horizon_bgr = Eigen::Vector3f(0.92F, 0.86F, 0.80F);
  int cloud_texture =
      -1;  ///< index among the scene's: brightness is how much cloud; negative: none
  std::vector<Lamp> lamps;
};

}  // namespace skyhalo

#pragma once

#include <Eigen/Core>

#include "skyhalo/sim/scene_tracer.hpp"
#include "skyhalo/sim/sun_shadows.hpp"

namespace skyhalo {

/// What rays see of a scene: textures under sun, sky and lamps. Refers to the tracer's scene.
class SurfaceColour {
 public:
  explicit SurfaceColour(const SceneTracer& tracer) : scene_(tracer.scene()), shadows_(tracer) {}

  /// Brightness (blue, green, red; 1 is white) of what a ray met. `pixel_rad` is how wide the ray
  /// looks.
  [[nodiscard]] Eigen::Vector3f of(const SceneRay& ray,
                                   const SceneHit& hit,
                                   float pixel_rad) const noexcept;

  /// Brightness of the sky in a direction (unit vector).
  [[nodiscard]] Eigen::Vector3f of_sky(const Eigen::Vector3f& direction,
                                       float pixel_rad) const noexcept;

 private:
  [[nodiscard]] Eigen::Vector3f light_at(const Eigen::Vector3f& point_m,
                                         const Eigen::Vector3f& normal) const noexcept;

  const Scene& scene_;
  SunShadows shadows_;
};

}  // namespace skyhalo

#include "skyhalo/sim/sun_shadows.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "skyhalo/base/for_each_index.hpp"

namespace skyhalo {
namespace {

constexpr int kLargestSidePx = 2048;
constexpr float kFinestM = 0.02F;

/// A frame with z away from the sun.
Eigen::Matrix3f frame_of(const Eigen::Vector3f& sun_direction) {
  const Eigen::Vector3f z = -sun_direction.normalized();
  const Eigen::Vector3f x = z.unitOrthogonal();
  Eigen::Matrix3f R_sun_scene;
  R_sun_scene.row(0) = x;
  R_sun_scene.row(1) = z.cross(x);
  R_sun_scene.row(2) = z;
  return R_sun_scene;
}

}  // namespace

SunShadows::SunShadows(const SceneTracer& tracer) {
  const Scene& scene = tracer.scene();
  if (scene.lighting.sun_bgr.isZero()) {
    return;
  }
  R_sun_scene_ = frame_of(scene.lighting.sun_direction);
  Eigen::AlignedBox3f box;
  for (const Eigen::Vector3f& vertex_m : scene.fixed.vertices_m) {
    box.extend(Eigen::Vector3f(R_sun_scene_ * vertex_m));
  }
  const Eigen::Vector3f size_m = box.sizes();
  pixel_m_ = std::max(size_m.head<2>().maxCoeff() / static_cast<float>(kLargestSidePx), kFinestM);
  origin_m_ = box.min() - Eigen::Vector3f(0.0F, 0.0F, 1.0F);
  depth_m_.create(static_cast<int>(size_m.y() / pixel_m_) + 1,
                  static_cast<int>(size_m.x() / pixel_m_) + 1);
  const SceneMoment moment(tracer, {});
  const Eigen::Vector3f direction = R_sun_scene_.row(2);
  for_each_index(static_cast<std::size_t>(depth_m_.rows), [&](std::size_t row) {
    std::vector<SceneRay> rays(static_cast<std::size_t>(depth_m_.cols));
    std::vector<SceneHit> hits(rays.size());
    for (std::size_t col = 0; col < rays.size(); ++col) {
      const Eigen::Vector3f start_m =
          origin_m_ + pixel_m_ * Eigen::Vector3f(static_cast<float>(col) + 0.5F,
                                                 static_cast<float>(row) + 0.5F,
                                                 0.0F);
      rays[col] = {R_sun_scene_.transpose() * start_m, direction, 0.0F};
    }
    moment.trace(rays, hits);
    for (std::size_t col = 0; col < hits.size(); ++col) {
      // What moves casts none: it will have gone on.
      depth_m_(static_cast<int>(row), static_cast<int>(col)) = hits[col].range_m;
    }
  });
}

float SunShadows::light(const Eigen::Vector3f& point_m,
                        const Eigen::Vector3f& normal) const noexcept {
  if (depth_m_.empty()) {
    return 1.0F;
  }
  // Aside along the normal, so that a surface does not lie in its own shadow.
  const Eigen::Vector3f p_m = R_sun_scene_ * (point_m + (1.5F * pixel_m_) * normal) - origin_m_;
  const float x = p_m.x() / pixel_m_ - 0.5F;
  const float y = p_m.y() / pixel_m_ - 0.5F;
  const float last_x = static_cast<float>(depth_m_.cols - 1);
  const float last_y = static_cast<float>(depth_m_.rows - 1);
  if (!(x >= 0.0F && y >= 0.0F && x < last_x && y < last_y)) {
    return 1.0F;
  }
  const int col = static_cast<int>(x);
  const int row = static_cast<int>(y);
  const float fx = x - static_cast<float>(col);
  const float fy = y - static_cast<float>(row);
  const float nearer_m = p_m.z() - pixel_m_;
  const auto lit = [&](int r, int c) { return depth_m_(r, c) >= nearer_m ? 1.0F : 0.0F; };
  return (1.0F - fy) * ((1.0F - fx) * lit(row, col) + fx * lit(row, col + 1)) +
         fy * ((1.0F - fx) * lit(row + 1, col) + fx * lit(row + 1, col + 1));
}

}  // namespace skyhalo

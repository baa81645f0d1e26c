#include "skyhalo/sphere/accumulate.hpp"

namespace skyhalo {

PixelCounts accumulate(const cv::Mat1f& disparity,
                       const PairGeometry& pair,
                       SphericalGrid& grid) noexcept {
  PixelCounts counts;
  const double max_range_m2 = pair.max_range_m * pair.max_range_m;
  for (int v = 0; v < disparity.rows; ++v) {
    const float* row = disparity[v];
    for (int u = 0; u < disparity.cols; ++u) {
      const double d_px = row[u];
      // Written so that NaN, and a disparity at infinity, fail it.
      if (!(d_px + pair.model.disparity_offset_px > 0.0)) {
        continue;
      }
      ++counts.measured;
      const Eigen::Vector3d p_camera_m = reproject(pair.model, u, v, d_px);
      if (p_camera_m.squaredNorm() > max_range_m2) {
        continue;
      }
      ++counts.used;
      grid.add(pair.T_body_camera * p_camera_m);
    }
  }
  return counts;
}

}  // namespace skyhalo

#include "skyhalo/sphere/accumulate.hpp"

namespace skyhalo {
namespace {

/// `Model` is a rectified pair model, known for the whole frame.
template <class Model>
PixelCounts accumulate_with(const Model& model,
                            const cv::Mat1f& disparity,
                            const PairGeometry& pair,
                            SphericalGrid& grid) noexcept {
  PixelCounts counts;
  const double min_range_m2 = pair.min_range_m * pair.min_range_m;
  const double max_range_m2 = pair.max_range_m * pair.max_range_m;
  for (int v = 0; v < disparity.rows; ++v) {
    const float* row = disparity[v];
    for (int u = 0; u < disparity.cols; ++u) {
      const Eigen::Vector3d p_camera_m = reproject(model, u, v, row[u]);
      if (std::isnan(p_camera_m.z())) {  // no disparity, or none that this pixel can have
        continue;
      }
      ++counts.measured;
      const double range_m2 = p_camera_m.squaredNorm();
      if (!(range_m2 >= min_range_m2 && range_m2 <= max_range_m2)) {
        continue;
      }
      ++counts.used;
      grid.add(pair.T_body_camera * p_camera_m);
    }
  }
  return counts;
}

}  // namespace

PixelCounts accumulate(const cv::Mat1f& disparity,
                       const PairGeometry& pair,
                       SphericalGrid& grid) noexcept {
  return ask(pair.model,
             [&](const auto& model) { return accumulate_with(model, disparity, pair, grid); });
}

}  // namespace skyhalo

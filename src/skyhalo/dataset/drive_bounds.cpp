#include "skyhalo/dataset/drive_bounds.hpp"

namespace skyhalo {

Eigen::AlignedBox3d drive_bounds(const FrameSource& source, const BoundsConfig& config) {
  Eigen::AlignedBox3d path(Eigen::Vector3d::Zero());
  for (int frame = 0; frame < source.frame_count(); ++frame) {
    path.extend(source.T_map_body(frame).translation());
  }
  const double right_m = path.min().y();
  const double left_m = path.max().y();
  const Eigen::Vector3d min_m(path.min().x() - config.behind_m,
                              right_m < -config.side_m ? right_m - config.ahead_m : -config.side_m,
                              config.bottom_m);
  const Eigen::Vector3d max_m(path.max().x() + config.ahead_m,
                              left_m > config.side_m ? left_m + config.ahead_m : config.side_m,
                              config.top_m);
  return {min_m, max_m};
}

}  // namespace skyhalo

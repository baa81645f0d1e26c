#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "skyhalo/camera/pair_model.hpp"
#include "skyhalo/geometry/pose.hpp"
#include "skyhalo/map/dense_map.hpp"
#include "skyhalo/sensor_model/inverse_sensor_model.hpp"
#include "skyhalo/sphere/halo.hpp"

namespace skyhalo {

/// What turns a pair's depths into map updates.
struct RangeModel {
  PairModel pair;  ///< at the matched resolution
  SensorModelConfig sensor;
  int limit_units = 5000;  ///< of the log odds, in units of 0.001
};

/// Sends one ray per cell of a halo that has a depth into the map, from the body origin along the
/// cell's centre direction, with the range uncertainty of the pair that the depth comes from
/// (METHOD 5).
class HaloRays {
 public:
  explicit HaloRays(const GridGeometry& geometry);

  /// Updates the map; rays go in row-major order of the cells. Returns the number of rays.
  /// `halo` has the geometry given to the constructor; `models` has an entry for each of its
  /// sources, and depths of other sources are left out.
  int integrate(const Halo& halo,
                std::span<const RangeModel> models,
                const Pose& T_map_body,
                DenseMap& map) const noexcept;

 private:
  std::vector<Eigen::Vector3d> directions_;  // body frame, one per cell
};

}  // namespace skyhalo

#pragma once

#include <vector>

#include "skyhalo/camera/pair_model.hpp"
#include "skyhalo/geometry/pose.hpp"
#include "skyhalo/map/dense_map.hpp"
#include "skyhalo/sensor_model/inverse_sensor_model.hpp"
#include "skyhalo/sphere/spherical_grid.hpp"

namespace skyhalo {

/// What turns a grid's depths into map updates.
struct RangeModel {
  PairModel pair;  ///< at the matched resolution
  SensorModelConfig sensor;
  DepthRule depth;
  int limit_units = 5000;  ///< of the log odds, in units of 0.001
};

/// Sends one ray per grid cell that has a depth into the map, from the body origin along the cell's
/// centre direction, with the range uncertainty of the pair (METHOD 5).
class GridRays {
 public:
  explicit GridRays(const GridGeometry& geometry);

  /// Updates the map; rays go in row-major order of the cells. Returns the number of rays.
  /// `grid` has the geometry given to the constructor.
  int integrate(const SphericalGrid& grid,
                const RangeModel& model,
                const Pose& T_map_body,
                DenseMap& map) const noexcept;

 private:
  std::vector<Eigen::Vector3d> directions_;  // body frame, one per cell
};

}  // namespace skyhalo

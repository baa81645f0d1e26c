#pragma once

#include "skyhalo/geometry/ray_walk.hpp"
#include "skyhalo/map/dense_map.hpp"
#include "skyhalo/sensor_model/inverse_sensor_model.hpp"

namespace skyhalo {

/// Enters one range measurement into the map (thesis eq. 6.2 and 6.4): every cell that the ray
/// crosses up to the measurement, and beyond it as long as the model still says something, gets the
/// log odds of its probability. A cell's distance m is the point of its chord nearest to the
/// measurement, so that the cell which holds the end point is the one that is marked. What speaks
/// for "free" counts with the share of the cell's edge that was crossed: a ray that clips a corner
/// says little. Log odds stay within `+-limit_units`. Parts of the ray outside the map are ignored.
void integrate(const Ray& ray,
               const InverseSensorModel& model,
               int limit_units,
               DenseMap& map) noexcept;

}  // namespace skyhalo

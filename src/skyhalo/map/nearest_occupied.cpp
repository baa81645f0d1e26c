#include "skyhalo/map/nearest_occupied.hpp"

#include <tuple>

namespace skyhalo {

void NearestCell::offer(const Eigen::Vector3i& cell) noexcept {
  const double distance_m2 = squared_distance_m2({cell, cell.array() + 1});
  const auto order = [](const Eigen::Vector3i& a) { return std::make_tuple(a.x(), a.y(), a.z()); };
  const bool is_nearer = distance_m2 < limit_m2_ ||
                         (distance_m2 == limit_m2_ && (!is_found_ || order(cell) < order(cell_)));
  if (is_nearer) {
    limit_m2_ = distance_m2;
    cell_ = cell;
    is_found_ = true;
  }
}

bool NearestCell::may_gain_outside(const CellBox& cells) const noexcept {
  // From inside, the nearest way out; a point that is not inside may be there already.
  const Eigen::Array3d to_min_m = point_m_ - lattice_.corner_m(cells.min);
  const Eigen::Array3d to_max_m = lattice_.corner_m(cells.max) - point_m_;
  const double out_m = std::max(0.0, to_min_m.min(to_max_m).minCoeff());
  return out_m * out_m <= limit_m2_;
}

double NearestCell::squared_distance_m2(const CellBox& cells) const noexcept {
  const Eigen::Array3d below_m = (lattice_.corner_m(cells.min) - point_m_).array();
  const Eigen::Array3d above_m = (point_m_ - lattice_.corner_m(cells.max)).array();
  return below_m.max(above_m).max(0.0).square().sum();
}

}  // namespace skyhalo

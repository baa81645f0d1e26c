#include "skyhalo/sphere/spherical_grid.hpp"

#include <algorithm>
#include <cmath>

#include "skyhalo/geometry/spherical.hpp"

namespace skyhalo {

SphericalGrid::SphericalGrid(const GridGeometry& geometry, const DepthRule& rule)
    : geometry_(geometry),
      rule_((check(rule, "sphere"), rule)),
      points_(geometry.cell_count(), rule),
      looks_(static_cast<std::size_t>(geometry.cell_count())),
      depths_m_(looks_.size(), std::numeric_limits<float>::quiet_NaN()),
      free_to_m_(looks_.size(), 0.0F) {}

void SphericalGrid::clear() noexcept {
  points_.clear();
  std::fill(looks_.begin(), looks_.end(), CellLooks{});
  std::fill(depths_m_.begin(), depths_m_.end(), std::numeric_limits<float>::quiet_NaN());
  std::fill(free_to_m_.begin(), free_to_m_.end(), 0.0F);
}

void SphericalGrid::add(const Eigen::Vector3d& p_body_m) noexcept {
  const SphericalPoint point = to_spherical(p_body_m);
  const std::optional<GridCell> cell = geometry_.cell_of(point.theta_rad, point.phi_rad);
  if (!cell || !(point.rho_m > 0.0) || !std::isfinite(point.rho_m)) {
    return;
  }
  points_.add(geometry_.offset_of(*cell), point.rho_m);
}

void SphericalGrid::merge(const CellPoints& points,
                          std::span<const CellLooks> looks,
                          CellSpan cells) noexcept {
  points_.merge(points, cells);
  for (auto cell = static_cast<std::size_t>(cells.begin);
       cell < static_cast<std::size_t>(cells.end);
       ++cell) {
    looks_[cell].valid += looks[cell].valid;
    looks_[cell].invalid += looks[cell].invalid;
    looks_[cell].nearest_m = std::min(looks_[cell].nearest_m, looks[cell].nearest_m);
  }
}

void SphericalGrid::settle(PairView& view) noexcept {
  view.find_free(looks_, free_to_m_);
  for (std::size_t cell = 0; cell < depths_m_.size(); ++cell) {
    depths_m_[cell] = static_cast<float>(points_.depth_m(static_cast<int>(cell)));
    if (depths_m_[cell] < free_to_m_[cell]) {
      free_to_m_[cell] = depths_m_[cell];
    }
  }
}

std::optional<CellStatistics> SphericalGrid::statistics(GridCell cell) const noexcept {
  return points_.statistics(geometry_.offset_of(cell));
}

std::optional<double> SphericalGrid::depth_m(GridCell cell) const noexcept {
  const double depth_m = points_.depth_m(geometry_.offset_of(cell));
  return std::isnan(depth_m) ? std::nullopt : std::optional(depth_m);
}

int SphericalGrid::occupied_cell_count() const noexcept {
  int count = 0;
  for (int cell = 0; cell < geometry_.cell_count(); ++cell) {
    count += points_.count(cell) > 0 ? 1 : 0;
  }
  return count;
}

}  // namespace skyhalo

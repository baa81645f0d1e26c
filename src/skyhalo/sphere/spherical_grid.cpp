#include "skyhalo/sphere/spherical_grid.hpp"

#include <algorithm>
#include <cmath>

namespace skyhalo {

SphericalGrid::SphericalGrid(const GridGeometry& geometry)
    : geometry_(geometry), cells_(static_cast<std::size_t>(geometry.cell_count())) {}

void SphericalGrid::clear() noexcept {
  std::fill(cells_.begin(), cells_.end(), Sums{});
}

void SphericalGrid::add(const Eigen::Vector3d& p_body_m) noexcept {
  const SphericalPoint point = to_spherical(p_body_m);
  const std::optional<GridCell> cell = geometry_.cell_of(point.theta_rad, point.phi_rad);
  if (!cell || !(point.rho_m > 0.0) || !std::isfinite(point.rho_m)) {
    return;
  }
  Sums& sums = cells_[static_cast<std::size_t>(geometry_.offset_of(*cell))];
  sums.min_m = sums.count == 0 ? point.rho_m : std::min(sums.min_m, point.rho_m);
  ++sums.count;
  sums.sum_m += point.rho_m;
  sums.sum_m2 += point.rho_m * point.rho_m;
}

std::optional<CellStatistics> SphericalGrid::statistics(GridCell cell) const noexcept {
  const Sums& sums = cells_[static_cast<std::size_t>(geometry_.offset_of(cell))];
  if (sums.count == 0) {
    return std::nullopt;
  }
  const double mean_m = sums.sum_m / sums.count;
  // Rounding can leave a variance of equal ranges slightly below zero.
  const double variance_m2 = std::max(0.0, sums.sum_m2 / sums.count - mean_m * mean_m);
  return CellStatistics{sums.count, mean_m, std::sqrt(variance_m2), sums.min_m};
}

std::optional<double> SphericalGrid::depth_m(GridCell cell, const DepthRule& rule) const noexcept {
  const std::optional<CellStatistics> s = statistics(cell);
  if (!s) {
    return std::nullopt;
  }
  const bool one_surface = s->sigma_m < rule.sigma_threshold_m;
  const double nearest_m = one_surface ? s->mean_m - rule.sigma_factor * s->sigma_m : s->min_m;
  return std::max(nearest_m, rule.min_range_m);
}

int SphericalGrid::occupied_cell_count() const noexcept {
  return static_cast<int>(
      std::count_if(cells_.begin(), cells_.end(), [](const Sums& s) { return s.count > 0; }));
}

}  // namespace skyhalo

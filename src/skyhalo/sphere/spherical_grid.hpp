#pragma once

#include <optional>
#include <vector>

#include "skyhalo/sphere/grid_geometry.hpp"

namespace skyhalo {

/// When a cell's points become its depth (thesis eq. 5.4).
struct DepthRule {
  double sigma_threshold_m = 0.5;  ///< cells whose deviation is below this are one surface
  double sigma_factor = 3.0;       ///< how many deviations in front of the mean
  double min_range_m = 0.0;        ///< the smallest range that the pair can measure (f B / d_max)
};

/// What the points of one cell amount to; distances from the body origin.
struct CellStatistics {
  int count = 0;
  double mean_m = 0.0;   ///< mu
  double sigma_m = 0.0;  ///< population standard deviation
  double min_m = 0.0;
};

/// One pair's view as nearest distances by direction (thesis 5.3). Cells keep running sums, never
/// their points. Adding is deterministic: the same points in the same order give the same bits.
class SphericalGrid {
 public:
  explicit SphericalGrid(const GridGeometry& geometry);

  [[nodiscard]] const GridGeometry& geometry() const noexcept { return geometry_; }

  /// Forgets all points; keeps the memory.
  void clear() noexcept;

  /// Adds a point (m, body). One that is outside the bounds, at the origin or not finite is
  /// ignored.
  void add(const Eigen::Vector3d& p_body_m) noexcept;

  /// Statistics of a cell; none for a cell without points.
  [[nodiscard]] std::optional<CellStatistics> statistics(GridCell cell) const noexcept;

  /// Depth of a cell (m along the ray): `mu - 3 sigma` if sigma is below the threshold, else the
  /// minimum, never below the smallest measurable range (thesis eq. 5.4). None without points.
  [[nodiscard]] std::optional<double> depth_m(GridCell cell, const DepthRule& rule) const noexcept;

  /// Number of cells that have points.
  [[nodiscard]] int occupied_cell_count() const noexcept;

 private:
  struct Sums {
    int count = 0;
    double sum_m = 0.0;
    double sum_m2 = 0.0;
    double min_m = 0.0;
  };

  GridGeometry geometry_;
  std::vector<Sums> cells_;
};

}  // namespace skyhalo

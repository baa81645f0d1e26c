#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <optional>
#include <vector>

namespace skyhalo::reference {

/// Bounds and step of a spherical grid in the body frame (x forward, y left, z up), radians.
/// theta is the polar angle (0 is up), phi the azimuth (0 is forward, positive left). Covers
/// [theta_min, theta_max) x [phi_min, phi_max); both extents are whole multiples of the step, the
/// phi extent is at most 2 pi and may run over +-pi (METHOD.md section 3).
struct NaiveGridSpec {
  double theta_min_rad = 0.0;
  double theta_max_rad = 0.0;
  double phi_min_rad = 0.0;
  double phi_max_rad = 0.0;
  double step_rad = 0.0;
};

/// Statistics of the ranges (metres from the body origin) that fell into one cell. All metric
/// values are NaN where n == 0.
struct NaiveCell {
  int n = 0;
  double mean_m = std::numeric_limits<double>::quiet_NaN();
  double sigma_m = std::numeric_limits<double>::quiet_NaN();
  double min_m = std::numeric_limits<double>::quiet_NaN();
  double depth_m = std::numeric_limits<double>::quiet_NaN();
};

/// Spherical coordinates of a body-frame point (thesis eq. 5.2).
struct NaiveSpherical {
  double rho_m = 0.0;
  double theta_rad = 0.0;
  double phi_rad = 0.0;
};

/// Number of polar rows of the grid.
inline int naive_row_count(const NaiveGridSpec& spec) {
  return static_cast<int>(std::lround((spec.theta_max_rad - spec.theta_min_rad) / spec.step_rad));
}

/// Number of azimuth columns of the grid.
inline int naive_column_count(const NaiveGridSpec& spec) {
  return static_cast<int>(std::lround((spec.phi_max_rad - spec.phi_min_rad) / spec.step_rad));
}

/// Body-frame point in metres to rho = |p|, theta = acos(z / rho) in [0, pi] and
/// phi = atan2(y, x) (thesis eq. 5.2). Nothing for a point that is not finite or is the origin.
inline std::optional<NaiveSpherical> naive_spherical(const std::array<double, 3>& point_body_m) {
  const double x_m = point_body_m[0];
  const double y_m = point_body_m[1];
  const double z_m = point_body_m[2];
  if (!std::isfinite(x_m) || !std::isfinite(y_m) || !std::isfinite(z_m)) {
    return std::nullopt;
  }
  const double rho_m = std::sqrt(x_m * x_m + y_m * y_m + z_m * z_m);
  if (rho_m == 0.0) {
    return std::nullopt;
  }
  NaiveSpherical result;
  result.rho_m = rho_m;
  result.theta_rad = std::acos(std::clamp(z_m / rho_m, -1.0, 1.0));
  result.phi_rad = std::atan2(y_m, x_m);
  return result;
}

/// Index of the step that holds angle_rad in the half-open interval [min_rad, max_rad) of `count`
/// steps; nothing outside. The last index is kept although the quotient may round up to `count`.
inline std::optional<int> naive_step_index(double angle_rad,
                                           double min_rad,
                                           double max_rad,
                                           int count) {
  if (angle_rad < min_rad || angle_rad >= max_rad) {
    return std::nullopt;
  }
  const double step_rad = (max_rad - min_rad) / count;
  const int index = static_cast<int>(std::floor((angle_rad - min_rad) / step_rad));
  return std::min(index, count - 1);
}

/// Row-major index (row = theta, column = phi) of the cell that holds a direction, nothing outside
/// the grid. phi counts modulo 2 pi, so phi = pi is the first column of a grid over [-pi, pi)
/// (METHOD.md section 3, the cells of thesis eq. 5.3).
inline std::optional<std::size_t> naive_cell_index(const NaiveGridSpec& spec,
                                                   const NaiveSpherical& direction) {
  const int rows = naive_row_count(spec);
  const int columns = naive_column_count(spec);
  const std::optional<int> row =
      naive_step_index(direction.theta_rad, spec.theta_min_rad, spec.theta_max_rad, rows);
  if (!row.has_value()) {
    return std::nullopt;
  }
  for (const double turn_rad : {0.0, 2.0 * std::numbers::pi, -2.0 * std::numbers::pi}) {
    const std::optional<int> column =
        naive_step_index(direction.phi_rad + turn_rad, spec.phi_min_rad, spec.phi_max_rad, columns);
    if (column.has_value()) {
      return static_cast<std::size_t>(*row) * static_cast<std::size_t>(columns) +
             static_cast<std::size_t>(*column);
    }
  }
  return std::nullopt;
}

/// Two-pass mean and population standard deviation, minimum, and the depth of one cell from all
/// its ranges, in metres: mean - 3 sigma if sigma < threshold, else the minimum, but never below
/// min_range_m (thesis eq. 5.4). An empty list gives the empty cell.
inline NaiveCell naive_cell(const std::vector<double>& ranges_m,
                            double sigma_threshold_m,
                            double min_range_m) {
  NaiveCell cell;
  if (ranges_m.empty()) {
    return cell;
  }
  cell.n = static_cast<int>(ranges_m.size());
  double sum_m = 0.0;
  cell.min_m = ranges_m.front();
  for (const double range_m : ranges_m) {
    sum_m += range_m;
    cell.min_m = std::min(cell.min_m, range_m);
  }
  cell.mean_m = sum_m / cell.n;
  double squares_m2 = 0.0;
  for (const double range_m : ranges_m) {
    squares_m2 += (range_m - cell.mean_m) * (range_m - cell.mean_m);
  }
  cell.sigma_m = std::sqrt(squares_m2 / cell.n);
  if (cell.sigma_m < sigma_threshold_m) {
    cell.depth_m = cell.mean_m - 3.0 * cell.sigma_m;
  } else {
    cell.depth_m = cell.min_m;
  }
  cell.depth_m = std::max(cell.depth_m, min_range_m);
  return cell;
}

/// Accumulates body-frame points (metres) into the cells of a spherical grid and gives each cell's
/// depth (thesis eq. 5.2-5.4). Row-major, row = theta index, column = phi index. Points that are
/// not finite, at the origin or outside the bounds are ignored; min_range_m limits only the depth.
inline std::vector<NaiveCell> naive_spherical_grid(
    const NaiveGridSpec& spec,
    const std::vector<std::array<double, 3>>& points_body_m,
    double sigma_threshold_m,
    double min_range_m) {
  const std::size_t cell_count = static_cast<std::size_t>(naive_row_count(spec)) *
                                 static_cast<std::size_t>(naive_column_count(spec));
  std::vector<std::vector<double>> ranges_m(cell_count);
  for (const std::array<double, 3>& point_body_m : points_body_m) {
    const std::optional<NaiveSpherical> spherical = naive_spherical(point_body_m);
    if (!spherical.has_value()) {
      continue;
    }
    const std::optional<std::size_t> index = naive_cell_index(spec, *spherical);
    if (index.has_value()) {
      ranges_m[*index].push_back(spherical->rho_m);
    }
  }
  std::vector<NaiveCell> cells;
  cells.reserve(cell_count);
  for (const std::vector<double>& cell_ranges_m : ranges_m) {
    cells.push_back(naive_cell(cell_ranges_m, sigma_threshold_m, min_range_m));
  }
  return cells;
}

}  // namespace skyhalo::reference

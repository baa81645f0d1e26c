#pragma once

#include <Eigen/Core>
#include <cmath>
#include <numbers>
#include <optional>

#include "skyhalo/geometry/spherical.hpp"

namespace skyhalo {

/// A cell of a spherical grid: row = polar angle (downwards), column = azimuth (towards the left).
struct GridCell {
  int row = 0;
  int col = 0;

  friend bool operator==(const GridCell&, const GridCell&) = default;
};

/// How the sphere round the body is divided (METHOD 3): `[theta_min, theta_max) x [phi_min,
/// phi_max)` in equal steps. Bounds are multiples of the steps, so that all grids of one body are
/// aligned. Azimuths wrap: a grid may cross the half-plane straight behind.
struct GridGeometry {
  double theta_min_rad = 0.0;  ///< first polar angle, >= 0 (0 is up)
  double theta_step_rad = 0.0;
  int rows = 0;
  double phi_min_rad = 0.0;  ///< first azimuth, >= -pi (0 is forward, positive left)
  double phi_step_rad = 0.0;
  int cols = 0;

  friend bool operator==(const GridGeometry&, const GridGeometry&) = default;

  [[nodiscard]] int cell_count() const noexcept { return rows * cols; }

  /// Position of a cell in memory, row-major.
  [[nodiscard]] int offset_of(GridCell cell) const noexcept { return cell.row * cols + cell.col; }

  /// True when the columns go all the way round.
  [[nodiscard]] bool is_whole_circle() const noexcept {
    return std::abs(cols * phi_step_rad - 2.0 * std::numbers::pi) < 0.5 * phi_step_rad;
  }

  /// True when the last row ends straight down.
  [[nodiscard]] bool reaches_down() const noexcept {
    return std::abs(theta_min_rad + rows * theta_step_rad - std::numbers::pi) <
           0.5 * theta_step_rad;
  }

  /// The cell that a direction falls into, theta in [0, pi] and phi in [-pi, pi]; none outside the
  /// bounds or for NaN. Straight backwards (phi = pi) is phi = -pi, straight down (theta = pi) the
  /// last row of a grid that ends there.
  [[nodiscard]] std::optional<GridCell> cell_of(double theta_rad, double phi_rad) const noexcept {
    const double from_first_rad = phi_rad - phi_min_rad;
    const double turned_rad =
        from_first_rad < 0.0 ? from_first_rad + 2.0 * std::numbers::pi : from_first_rad;
    double row = std::floor((theta_rad - theta_min_rad) / theta_step_rad);
    double col = std::floor(turned_rad / phi_step_rad);
    row -= row == rows && reaches_down() ? 1.0 : 0.0;
    col -= col == cols && is_whole_circle() ? col : 0.0;
    if (!(row >= 0.0 && row < rows && col >= 0.0 && col < cols)) {
      return std::nullopt;
    }
    return GridCell{static_cast<int>(row), static_cast<int>(col)};
  }

  /// Unit vector (body frame) through the middle of a cell.
  [[nodiscard]] Eigen::Vector3d center_direction(GridCell cell) const noexcept {
    return direction(theta_min_rad + (cell.row + 0.5) * theta_step_rad,
                     phi_min_rad + (cell.col + 0.5) * phi_step_rad);
  }
};

/// Angular bounds and steps as a person gives them (radians).
struct GridBounds {
  double theta_min_rad = 0.0;
  double theta_max_rad = 0.0;
  double phi_min_rad = 0.0;
  double phi_max_rad = 0.0;  ///< above pi where the grid crosses the half-plane behind
  double step_rad = 0.0;     ///< of both angles
};

/// The grid with these bounds. Throws `Error` (input) naming what is wrong unless the step is above
/// 0, `0 <= theta_min < theta_max <= pi`, `-pi <= phi_min < pi`, `phi_min < phi_max <= phi_min + 2
/// pi`, all bounds are multiples of the step (within 1e-6 of a step) and there are at most 10^7
/// cells.
[[nodiscard]] GridGeometry make_grid_geometry(const GridBounds& bounds);

/// The grid of all directions, from straight up and straight backwards on. Throws `Error` (input)
/// unless the step divides a half turn and leaves at most 10^7 cells.
[[nodiscard]] GridGeometry whole_sphere(double step_rad);

}  // namespace skyhalo

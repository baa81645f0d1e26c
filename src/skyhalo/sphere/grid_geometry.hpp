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
/// aligned.
struct GridGeometry {
  double theta_min_rad = 0.0;  ///< first polar angle, >= 0 (0 is up)
  double theta_step_rad = 0.0;
  int rows = 0;
  double phi_min_rad = 0.0;  ///< first azimuth, >= -pi (0 is forward, positive left)
  double phi_step_rad = 0.0;
  int cols = 0;

  [[nodiscard]] int cell_count() const noexcept { return rows * cols; }

  /// Position of a cell in memory, row-major.
  [[nodiscard]] int offset_of(GridCell cell) const noexcept { return cell.row * cols + cell.col; }

  /// The cell that a direction falls into, theta in [0, pi] and phi in [-pi, pi]; none outside the
  /// bounds or for NaN. Straight backwards (phi = pi) is the first column of a whole circle,
  /// straight down (theta = pi) the last row of a grid that ends there.
  [[nodiscard]] std::optional<GridCell> cell_of(double theta_rad, double phi_rad) const noexcept {
    constexpr double kPi = std::numbers::pi;
    const double wrapped_rad = phi_rad < kPi ? phi_rad : phi_rad - 2.0 * kPi;
    double row = std::floor((theta_rad - theta_min_rad) / theta_step_rad);
    const double col = std::floor((wrapped_rad - phi_min_rad) / phi_step_rad);
    row -= theta_rad >= kPi && row == rows ? 1.0 : 0.0;
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
  double phi_max_rad = 0.0;
  double step_rad = 0.0;  ///< of both angles
};

/// The grid with these bounds. Throws `Error` (input) naming what is wrong unless the step is above
/// 0, `0 <= theta_min < theta_max <= pi`, `-pi <= phi_min < phi_max <= pi`, all bounds are
/// multiples of the step (within 1e-6 of a step) and there are at most 10^7 cells.
[[nodiscard]] GridGeometry make_grid_geometry(const GridBounds& bounds);

}  // namespace skyhalo

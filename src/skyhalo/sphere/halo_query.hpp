#pragma once

#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "skyhalo/sphere/halo.hpp"

namespace skyhalo {

/// What a halo says of several cells together.
struct RegionView {
  double nearest_m = std::numeric_limits<double>::infinity();  ///< range of the nearest thing
  std::optional<GridCell> nearest_cell = {};                   ///< where that is
  double free_to_m = std::numeric_limits<double>::infinity();  ///< all of it is free up to here
  int cells = 0;
  int unseen_cells = 0;

  /// Obstacle where there is any, else unseen where any cell is (or there is none), else free.
  [[nodiscard]] Sight sight() const noexcept {
    if (nearest_cell) {
      return Sight::kObstacle;
    }
    return unseen_cells > 0 || cells == 0 ? Sight::kUnseen : Sight::kFree;
  }

  /// Takes in one more cell of the halo.
  void add(const Halo& halo, GridCell cell) noexcept;
};

/// The cells for which `belongs(cell, depth_m) -> bool` holds; the depth is NaN where there is
/// none.
template <class Belongs>
[[nodiscard]] RegionView view_where(const Halo& halo, const Belongs& belongs) {
  RegionView view;
  const GridGeometry& grid = halo.geometry();
  for (int row = 0; row < grid.rows; ++row) {
    for (int col = 0; col < grid.cols; ++col) {
      const GridCell cell{row, col};
      if (belongs(cell, halo.depths_m()[static_cast<std::size_t>(grid.offset_of(cell))])) {
        view.add(halo, cell);
      }
    }
  }
  return view;
}

/// The cell that holds a direction (body, any length above 0); nothing but unseen for none.
[[nodiscard]] RegionView view_along(const Halo& halo,
                                    const Eigen::Vector3d& direction_body) noexcept;

/// The cells whose middles lie within an angle of an axis (body, any length above 0), and the cell
/// that holds the axis.
[[nodiscard]] RegionView view_in_cone(const Halo& halo,
                                      const Eigen::Vector3d& axis_body,
                                      double half_angle_rad) noexcept;

/// A box of angles `[theta_min, theta_max) x [phi_min, phi_max)`. Azimuths count modulo a turn: a
/// phi_max below phi_min goes round behind, one a turn above it takes all.
struct AngleBox {
  double theta_min_rad = 0.0;
  double theta_max_rad = 0.0;
  double phi_min_rad = 0.0;
  double phi_max_rad = 0.0;
};

/// The cells whose middles lie in a box of angles; with all polar angles it is an azimuth sector.
[[nodiscard]] RegionView view_in_box(const Halo& halo, const AngleBox& box) noexcept;

/// A band of pitches (rad, up positive) about the horizon.
struct PitchBand {
  double min_rad = 0.0;
  double max_rad = 0.0;
};

inline constexpr int kRingSectors = 72;

/// 72 sectors of 5 degrees: sector k lies about azimuth 5 k degrees, 0 ahead, to the left.
using Ring = std::array<RegionView, kRingSectors>;

/// The halo seen as a level ring: of each sector the cells within a band of pitches. Of the
/// attitude only the tilt matters, sectors stay with the nose's heading. Cells count for every
/// sector that a disc round them reaches into, where it reaches into the band.
[[nodiscard]] Ring ring_of(const Halo& halo,
                           const PitchBand& pitch,
                           const Eigen::Matrix3d& R_map_body) noexcept;

/// A straight tube from the body origin: the way of a ball of this radius.
struct Tube {
  Eigen::Vector3d direction_body = Eigen::Vector3d::UnitX();  ///< any length above 0
  double radius_m = 0.0;                                      ///< >= 0
  double distance_m = 0.0;                                    ///< of the ball's centre, >= 0
  /// Cells farther off the direction need not be seen; a quarter turn asks for all that the ball
  /// comes nearer to. Things count in all directions.
  double look_angle_rad = std::numbers::pi / 6.0;
};

/// How far the ball can go.
struct TubeView {
  Sight sight = Sight::kUnseen;  ///< free, or what stops it first
  double clear_to_m = 0.0;       ///< travel of the ball's centre, at most the tube's distance
  std::optional<GridCell> limiting_cell = {};
};

/// How far a ball can go along a tube before it touches a thing, or comes to where nothing was
/// seen. A cell's thing may be anywhere in the cell. What lies nearer than the radius is the ball's
/// own place, as far as it is unseen.
[[nodiscard]] TubeView view_along_tube(const Halo& halo, const Tube& tube) noexcept;

}  // namespace skyhalo

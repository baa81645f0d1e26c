#pragma once

#include <Eigen/Core>

// What a velocity means for all cells of a halo at once, by vectors of single precision.

namespace skyhalo {

/// Arrays of cells are padded to a multiple of this, with directions of zero.
inline constexpr int kCellPadding = 64;

/// Unit vectors (body) of the cells.
struct CellDirections {
  const float* x;
  const float* y;
  const float* z;
  int count;  ///< without the padding
};

/// How fast one may approach.
struct Braking {
  Eigen::Vector3f up_body;  ///< the map's z
  float horizontal_mps2;    ///< what one cell may use of the braking limit, > 0
  float vertical_mps2;      ///< the same of the vertical one, > 0
  float delay_s;            ///< >= 0
  float keep_m;             ///< distance that must remain, >= 0
  float cell_radius_rad;    ///< a thing may be so far from the middle of its cell
  float unseen_speed_mps;   ///< towards the unseen at any rate; infinite to allow it
};

/// What is known of the cells, as a halo says it, padded.
struct CellRanges {
  const float* depths_m;
  const float* free_to_m;
};

/// Room for a speed per cell, and the padding.
struct CellSpeeds {
  float* thing_mps;
  float* unseen_mps;
};

/// For each cell the speed towards its middle from which `delay_s` and then braking still stop
/// `keep_m` before its thing (infinite without one), and before what was not seen of it.
void find_speed_limits(const CellDirections& cells,
                       const CellRanges& ranges,
                       const Braking& braking,
                       const CellSpeeds& speeds) noexcept;

/// A cell, and a number that belongs to it.
struct CellValue {
  int cell;
  float value;
};

/// The cell whose limit a velocity (body) exceeds most, or is nearest to, and by how much.
[[nodiscard]] CellValue most_exceeded(const CellDirections& cells,
                                      const float* speeds_mps,
                                      const Eigen::Vector3f& velocity_mps) noexcept;

/// The share of a velocity (body) that keeps all limits, at most 1, and the cell that asks for it
/// (-1 for none); only cells that it approaches by at least `least_mps` count, which is above 0.
[[nodiscard]] CellValue allowed_share(const CellDirections& cells,
                                      const float* speeds_mps,
                                      const Eigen::Vector3f& velocity_mps,
                                      float least_mps) noexcept;

}  // namespace skyhalo

#pragma once

#include <array>
#include <cstdint>

#include "skyhalo/sphere/grid_geometry.hpp"
#include "skyhalo/sphere/keep_nearest.hpp"

// Where the pixels of one image row see, by vectors of single precision.

namespace skyhalo {

/// Marks in a row of seen ranges: something nearer than the limit, and no disparity.
inline constexpr float kTooNear = -1.0F;
inline constexpr float kInvalid = -2.0F;

/// A grid's geometry in single precision.
struct LocateGrid {
  explicit LocateGrid(const GridGeometry& geometry) noexcept;

  float theta_min_rad;
  float rows_per_rad;
  float phi_min_rad;
  float cols_per_rad;
  std::int32_t rows;
  std::int32_t cols;
  std::int32_t no_cell;        ///< stands for no point there: one behind the last cell
  std::int32_t doubtful_cell;  ///< for a pixel that single precision cannot place surely
  bool whole_circle;
  bool reaches_down;
};

/// The range limits of a pair, from its camera (m).
struct LocateLimits {
  float min_range_m;
  float max_range_m;
};

/// A row of a pinhole pair: column u with disparity d sees the point `origin + (base + (u - u0)
/// step)/(d + offset)` of the body.
struct PinholeRow {
  std::array<float, 3> origin_m;
  std::array<float, 3> base_m_px;
  std::array<float, 3> step_m_px;
  float principal_u_px;
  float across2_m2_px2;  ///< squared length of `base`
  float step2_m2_px2;    ///< squared length of `step`, which is orthogonal to it
  float offset_px;
};

/// A row of a spherical pair: column u with parallax delta sees the point `origin + k (sin(alpha)
/// side + cos(alpha) ahead)`, `k = B (cos(alpha)/tan(delta) - sin(alpha))`.
struct SphericalRow {
  std::array<float, 3> origin_m;
  std::array<float, 3> side;
  std::array<float, 3> ahead;
  const float* sin_alpha;
  const float* cos_alpha;
  const float* max_delta_rad;  ///< `pi/2 - alpha`; 0 where a column sees nothing
  float delta_theta_u_rad;
  float baseline_m;
};

/// What a row's pixels see. Each array has room for the row's width, rounded up to `kRowPadding`,
/// and is filled to the end of the last vector.
struct LocatedRow {
  std::int32_t* cell;  ///< of the point, by its place in memory, or one of the grid's two marks
  float* range_m;      ///< of the point from the body origin
  float* seen_m;       ///< from the camera: a range, infinity beyond the limit, or a mark below 0
};

/// How many pixels have a disparity, see something within the limits, and are doubtful (and counted
/// in none of the others, for they have to be looked at again).
struct LocatedCounts {
  int measured = 0;
  int used = 0;
  int doubtful = 0;
};

/// Where a row's pixels go.
struct LocateTarget {
  const LocateGrid& grid;
  const LocateLimits& limits;
  const LocatedRow& located;
};

/// Locates the pixels of a row of disparities (px; NaN, also beyond the row's end, where there is
/// none).
LocatedCounts locate(const PinholeRow& row,
                     const LocateTarget& target,
                     const float* disparity_px,
                     int width) noexcept;
LocatedCounts locate(const SphericalRow& row,
                     const LocateTarget& target,
                     const float* disparity_px,
                     int width) noexcept;

}  // namespace skyhalo

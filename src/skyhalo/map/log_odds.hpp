#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "skyhalo/sensor_model/probability.hpp"

namespace skyhalo {

/// Log odds of occupancy as a fixed-point number of 2 bytes, in units of 0.001 (METHOD 5). All maps
/// share this cell type.
using LogOdds = std::int16_t;

/// A cell that no ray has touched. It reads as probability 0.5.
inline constexpr LogOdds kUnknown = std::numeric_limits<LogOdds>::min();

inline constexpr double kLogOddsPerUnit = 0.001;

/// Log odds in units of 0.001, rounded to the nearest.
[[nodiscard]] inline int log_odds_units(double log_odds_value) noexcept {
  return static_cast<int>(std::lround(log_odds_value / kLogOddsPerUnit));
}

/// Probability of a cell (thesis eq. 6.3); 0.5 for an unknown one.
[[nodiscard]] inline double probability_of(LogOdds cell) noexcept {
  return cell == kUnknown ? 0.5 : 1.0 / (1.0 + std::exp(-kLogOddsPerUnit * cell));
}

/// The cell after a measurement (thesis eq. 6.2): the sum, kept within +-limit. An unknown cell
/// counts as 0 before it. `limit_units` in [1, 32767].
[[nodiscard]] inline LogOdds updated(LogOdds cell, int increment_units, int limit_units) noexcept {
  const int before = cell == kUnknown ? 0 : cell;
  return static_cast<LogOdds>(std::clamp(before + increment_units, -limit_units, limit_units));
}

}  // namespace skyhalo

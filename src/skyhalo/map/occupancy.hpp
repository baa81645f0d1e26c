#pragma once

#include "skyhalo/map/log_odds.hpp"

namespace skyhalo {

/// What a cell, or several together, are.
enum class Occupancy { kNotKnown, kFree, kOccupied };

/// When the log odds of a cell mean occupied or free; in between, it counts as unknown.
struct OccupancyRule {
  LogOdds occupied_above = 0;
  LogOdds free_below = 0;  ///< at most `occupied_above`

  [[nodiscard]] Occupancy operator()(LogOdds cell) const noexcept {
    if (cell == kUnknown) {
      return Occupancy::kNotKnown;
    }
    if (cell > occupied_above) {
      return Occupancy::kOccupied;
    }
    return cell < free_below ? Occupancy::kFree : Occupancy::kNotKnown;
  }
};

/// What two are together: occupied if any is, else unknown if any is, else free.
[[nodiscard]] inline Occupancy together(Occupancy a, Occupancy b) noexcept {
  if (a == Occupancy::kOccupied || b == Occupancy::kOccupied) {
    return Occupancy::kOccupied;
  }
  return a == Occupancy::kFree && b == Occupancy::kFree ? Occupancy::kFree : Occupancy::kNotKnown;
}

}  // namespace skyhalo

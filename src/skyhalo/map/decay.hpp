#pragma once

#include <span>

#include "skyhalo/map/log_odds.hpp"

namespace skyhalo {

/// How fast a map forgets what it does not see again: the time after which the log odds of a cell
/// have halved. 0 = never.
struct DecayConfig {
  double half_life_occupied_s = 0.0;  ///< of cells that are rather occupied, >= 0
  double half_life_free_s = 0.0;      ///< of cells that are rather free, >= 0
};

/// One step of forgetting: the shares (in 1/65536) that log odds above and below 0 keep. Cells that
/// come nearer to 0 than `unknown_below` units become unknown.
struct DecayStep {
  int keep_occupied = 65536;
  int keep_free = 65536;
  int unknown_below = 50;
};

/// Throws `Error` (input) naming the key unless both half-lives are finite and at least 0.
void check(const DecayConfig& config);

/// Collects the time that passes into steps that are worth a pass over the map.
class DecayClock {
 public:
  explicit DecayClock(const DecayConfig& config) noexcept;

  /// Lets `elapsed_s` pass (less than 0 and NaN: nothing). Returns the step to apply to the map
  /// now: of each state what a sixteenth of its half-life or more takes, once that has come
  /// together; before, a step that keeps all.
  [[nodiscard]] DecayStep pass(double elapsed_s) noexcept;

 private:
  DecayConfig config_;
  double waiting_occupied_s_ = 0.0;
  double waiting_free_s_ = 0.0;
};

/// Whether a step changes anything.
[[nodiscard]] constexpr bool forgets(const DecayStep& step) noexcept {
  return step.keep_occupied < 65536 || step.keep_free < 65536;
}

/// A cell after a step; rounded towards 0, so that it always comes nearer.
[[nodiscard]] constexpr LogOdds decayed(LogOdds cell, const DecayStep& step) noexcept {
  const int value = cell;
  const int keep = value < 0 ? step.keep_free : step.keep_occupied;
  if (cell == kUnknown || keep >= 65536) {
    return cell;
  }
  const int size = value < 0 ? -value : value;
  const auto kept =
      static_cast<int>((static_cast<unsigned>(size) * static_cast<unsigned>(keep)) >> 16U);
  const int signed_kept = value < 0 ? -kept : kept;
  return kept < step.unknown_below ? kUnknown : static_cast<LogOdds>(signed_kept);
}

/// All cells after a step. Returns whether any has changed.
bool decay(std::span<LogOdds> cells, const DecayStep& step) noexcept;

}  // namespace skyhalo

#include "skyhalo/map/decay.hpp"

#include <cmath>
#include <string>
#include <utility>

#include "skyhalo/base/error.hpp"

namespace skyhalo {
namespace {

void require(bool holds, const char* key) {
  if (!holds) {
    throw Error(ErrorKind::kInput, std::string("map.") + key + ": expected a time of 0 s or more");
  }
}

/// The share that a state keeps now, of 65536; begins to wait anew when it is not all.
int take_share(double half_life_s, double& waiting_s) noexcept {
  constexpr double kStepsPerHalfLife = 16.0;
  if (!(half_life_s > 0.0) || waiting_s < half_life_s / kStepsPerHalfLife) {
    return 65536;
  }
  const double elapsed_s = std::exchange(waiting_s, 0.0);
  return static_cast<int>(std::lround(65536.0 * std::exp2(-elapsed_s / half_life_s)));
}

}  // namespace

void check(const DecayConfig& config) {
  const auto is_time = [](double time_s) { return time_s >= 0.0 && std::isfinite(time_s); };
  require(is_time(config.half_life_occupied_s), "half_life_occupied_s");
  require(is_time(config.half_life_free_s), "half_life_free_s");
}

DecayClock::DecayClock(const DecayConfig& config) noexcept : config_(config) {}

DecayStep DecayClock::pass(double elapsed_s) noexcept {
  const double passed_s = elapsed_s > 0.0 ? elapsed_s : 0.0;
  waiting_occupied_s_ += passed_s;
  waiting_free_s_ += passed_s;
  return {.keep_occupied = take_share(config_.half_life_occupied_s, waiting_occupied_s_),
          .keep_free = take_share(config_.half_life_free_s, waiting_free_s_)};
}

bool decay(std::span<LogOdds> cells, const DecayStep& step) noexcept {
  int changes = 0;
  for (LogOdds& cell : cells) {
    const LogOdds after = decayed(cell, step);
    changes |= after ^ cell;
    cell = after;
  }
  return changes != 0;
}

}  // namespace skyhalo

#include "stage_clock.hpp"

#include <algorithm>
#include <cmath>

namespace skyhalo::app {
namespace {

/// The smallest value that at least this share of the sorted values does not exceed.
double percentile(const std::vector<double>& sorted, double share) {
  const auto rank = static_cast<std::size_t>(std::ceil(share * static_cast<double>(sorted.size())));
  return sorted[std::clamp<std::size_t>(rank, 1, sorted.size()) - 1];
}

}  // namespace

void StageClock::begin(Stage stage, std::size_t pair) noexcept {
  const std::lock_guard lock(mutex_);
  started_[{stage, pair}] = Clock::now();
}

void StageClock::end(Stage stage, std::size_t pair) noexcept {
  const Clock::time_point now = Clock::now();
  const std::lock_guard lock(mutex_);
  durations_ms_[stage].push_back(
      std::chrono::duration<double, std::milli>(now - started_[{stage, pair}]).count());
}

std::vector<StageTimes> StageClock::times() const {
  const std::lock_guard lock(mutex_);
  std::vector<StageTimes> times;
  for (auto [stage, durations_ms] : durations_ms_) {
    std::sort(durations_ms.begin(), durations_ms.end());
    times.push_back({std::string(name_of(stage)),
                     percentile(durations_ms, 0.5),
                     percentile(durations_ms, 0.95)});
  }
  return times;
}

nlohmann::json stages_json(const std::vector<StageTimes>& times) {
  nlohmann::json stages = nlohmann::json::object();
  for (const StageTimes& stage : times) {
    stages[stage.stage] = {{"p50_ms", stage.p50_ms}, {"p95_ms", stage.p95_ms}};
  }
  return stages;
}

}  // namespace skyhalo::app

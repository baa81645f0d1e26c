#pragma once

#include <chrono>
#include <map>
#include <mutex>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "skyhalo/evaluation/report.hpp"
#include "skyhalo/pipeline/stage_observer.hpp"

namespace skyhalo::app {

/// Times the detector's stages.
class StageClock final : public StageObserver {
 public:
  void begin(Stage stage, std::size_t pair) noexcept override;
  void end(Stage stage, std::size_t pair) noexcept override;

  /// Median and 95th percentile of each stage over all frames and pairs, in the stages' order.
  [[nodiscard]] std::vector<StageTimes> times() const;

 private:
  using Clock = std::chrono::steady_clock;

  mutable std::mutex mutex_;
  std::map<std::pair<Stage, std::size_t>, Clock::time_point> started_;
  std::map<Stage, std::vector<double>> durations_ms_;
};

/// `{"stage": {"p50_ms": .., "p95_ms": ..}, ...}`.
nlohmann::json stages_json(const std::vector<StageTimes>& times);

}  // namespace skyhalo::app

#pragma once

#include <string_view>

namespace skyhalo {

/// The stages of one frame, in the order the data takes.
enum class Stage { kRectify, kMatch, kSphere, kStitch, kMap };

/// The stage's name in reports.
[[nodiscard]] constexpr std::string_view name_of(Stage stage) noexcept {
  switch (stage) {
    case Stage::kRectify:
      return "rectify";
    case Stage::kMatch:
      return "match";
    case Stage::kSphere:
      return "sphere";
    case Stage::kStitch:
      return "stitch";
    case Stage::kMap:
      return "map";
  }
  return "";
}

/// Is told when a stage begins and ends, so that an application can hold its own clock to it; the
/// library has none. Pairs run in parallel: calls come from several threads, each stage of one pair
/// begins and ends on the same thread. Stitching and the map take all pairs together, and count as
/// pair 0. A stage that throws has no end.
class StageObserver {
 public:
  StageObserver() = default;
  StageObserver(const StageObserver&) = delete;
  StageObserver& operator=(const StageObserver&) = delete;
  StageObserver(StageObserver&&) = delete;
  StageObserver& operator=(StageObserver&&) = delete;
  virtual ~StageObserver() = default;

  virtual void begin(Stage stage, std::size_t pair) noexcept = 0;
  virtual void end(Stage stage, std::size_t pair) noexcept = 0;
};

}  // namespace skyhalo

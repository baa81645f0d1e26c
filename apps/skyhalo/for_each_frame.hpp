#pragma once

#include <tbb/parallel_pipeline.h>

#include <array>
#include <cstddef>
#include <optional>
#include <type_traits>

#include "common_options.hpp"
#include "interrupt.hpp"
#include "progress_bar.hpp"

namespace skyhalo::app {

/// Reads frames ahead on other threads and uses them one by one in order: `read(frame) -> Item`,
/// then `use(frame, item)`. Memory holds a few frames at most. Stops at a frame's end when
/// interrupted.
template <class Read, class Use>
void for_each_frame(FrameRange range, ProgressBar& bar, const Read& read, const Use& use) {
  using Item = std::invoke_result_t<Read, int>;
  constexpr int kFramesInFlight = 4;
  // The pipeline passes frame numbers only: TBB drops what it holds, undestroyed, when a stage
  // throws. Frames leave in order, so those in flight follow each other and no two share a slot.
  std::array<std::optional<Item>, kFramesInFlight> slots;
  const auto slot = [&](int frame) -> std::optional<Item>& {
    return slots[static_cast<std::size_t>((frame - range.first) % kFramesInFlight)];
  };
  int next = range.first;
  const auto number = [&](tbb::flow_control& flow) {
    if (next > range.last) {
      flow.stop();
      return 0;
    }
    return next++;
  };
  const auto fill = [&](int frame) {
    slot(frame).emplace(read(frame));
    return frame;
  };
  const auto consume = [&](int frame) {
    stop_if_interrupted();
    use(frame, *slot(frame));
    slot(frame).reset();
    bar.advance();
  };
  tbb::parallel_pipeline(
      kFramesInFlight,
      tbb::make_filter<void, int>(tbb::filter_mode::serial_in_order, number) &
          tbb::make_filter<int, int>(tbb::filter_mode::parallel, fill) &
          tbb::make_filter<int, void>(tbb::filter_mode::serial_in_order, consume));
}

}  // namespace skyhalo::app

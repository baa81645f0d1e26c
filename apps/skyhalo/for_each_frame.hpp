#pragma once

#include <tbb/parallel_pipeline.h>

#include <type_traits>
#include <utility>

#include "common_options.hpp"
#include "interrupt.hpp"
#include "progress_bar.hpp"

namespace skyhalo::app {

/// Reads frames ahead on other threads and uses them one by one in order: `read(frame) -> Item`,
/// then `use(frame, item)`. Memory holds a few frames at most. Stops at a frame's end when
/// interrupted.
template <class Read, class Use>
void for_each_frame(FrameRange range, ProgressBar& bar, const Read& read, const Use& use) {
  using Item = std::pair<int, std::invoke_result_t<Read, int>>;
  constexpr std::size_t kFramesInFlight = 4;
  int next = range.first;
  const auto number = [&](tbb::flow_control& flow) {
    if (next > range.last) {
      flow.stop();
      return 0;
    }
    return next++;
  };
  const auto consume = [&](const Item& item) {
    stop_if_interrupted();
    use(item.first, item.second);
    bar.advance();
  };
  tbb::parallel_pipeline(
      kFramesInFlight,
      tbb::make_filter<void, int>(tbb::filter_mode::serial_in_order, number) &
          tbb::make_filter<int, Item>(tbb::filter_mode::parallel,
                                      [&](int frame) { return Item(frame, read(frame)); }) &
          tbb::make_filter<Item, void>(tbb::filter_mode::serial_in_order, consume));
}

}  // namespace skyhalo::app

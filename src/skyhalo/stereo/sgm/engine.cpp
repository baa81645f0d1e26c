#include "skyhalo/stereo/sgm/engine.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstring>
#include <utility>

#include "skyhalo/stereo/sgm/depth_edge.hpp"
#include "skyhalo/stereo/sgm/left_right.hpp"
#include "skyhalo/stereo/sgm/repetition.hpp"
#include "skyhalo/stereo/sgm/smoothing.hpp"
#include "skyhalo/stereo/sgm/texture.hpp"

namespace skyhalo::sgm {
namespace {

constexpr int kBlock = 16;       // steps that are skewed together
constexpr int kGuideLead = 16;   // steps before the first and after the last that paths look at
constexpr int kGuideLanes = 16;  // lanes beside the strip's own
constexpr int kBandRows = 16;

template <class... Factors>
std::size_t product(Factors... factors) noexcept {
  return (static_cast<std::size_t>(factors) * ...);
}

/// A positive length stays one: 0 means that there is no check.
int in_64ths(double px) noexcept {
  return px > 0.0 ? std::max(1, static_cast<int>(std::lround(px * 64.0))) : 0;
}

/// Calls `work(first, last)` for bands of the rows [begin, end).
template <class Work>
void for_each_band(Executor& executor, int begin, int end, const Work& work) {
  const auto band = [&](int i) {
    const int first = begin + i * kBandRows;
    work(first, std::min(end, first + kBandRows));
  };
  executor.for_each((end - begin + kBandRows - 1) / kBandRows, Task(band));
}

template <class Work>
void for_each_row(Executor& executor, int begin, int end, const Work& work) {
  for_each_band(executor, begin, end, [&](int first, int last) {
    for (int v = first; v < last; ++v) {
      work(v);
    }
  });
}

/// Copies a row, mirrored for left-aligned matching: the mirrored left image is a right image.
template <class T>
void copy_row(const T* from, int width, bool mirrored, T* to) noexcept {
  if (mirrored) {
    std::reverse_copy(from, from + width, to);
  } else {
    std::copy(from, from + width, to);
  }
}

}  // namespace

Engine::Engine(const SgmConfig& config, const EngineSize& size)
    : config_(config),
      size_(size),
      layout_(size.width_px, size.height_px, size.max_disparity_px, vector_lanes()),
      left_(make_side(layout_.steps + layout_.disparities)),
      right_(make_side(layout_.steps)),
      guide_(size.width_px, size.height_px),
      textured_(size.width_px, size.height_px),
      repeated_(size.width_px, size.height_px),
      repeated_counts_(size.width_px, size.height_px),
      confident_(size.width_px, size.height_px),
      guide_rows_(product(layout_.lanes + kGuideLanes, layout_.lane_stride())),
      guide_steps_(product(layout_.steps + 2 * kGuideLead, layout_.lanes + kGuideLanes)),
      limit_(product(layout_.steps, layout_.lanes)),
      inside_(product(layout_.steps, layout_.lanes)),
      forward_(layout_),
      backward_(layout_),
      half_sum_(product(layout_.steps, layout_.lanes, layout_.disparities)),
      winners_(product(3, layout_.steps, layout_.lanes)),
      forward_left_(product(2, layout_.steps + layout_.disparities, layout_.lanes)),
      backward_left_(product(2, layout_.steps + layout_.disparities, layout_.lanes)),
      winner_rows_(product(4, layout_.lanes, layout_.lane_stride())),
      disparity_64_(size.width_px, size.height_px),
      filled_64_(size.width_px, size.height_px),
      medians_{{size.width_px, size.height_px}, {size.width_px, size.height_px}},
      speckles_(size.width_px, size.height_px),
      disparity_px_(size.width_px, size.height_px) {
  assert(size.max_disparity_px % 16 == 0 && size.max_disparity_px <= 256);
  assert(size.width_px > size.max_disparity_px && size.height_px > 0);
  disparity_64_.fill_margin(-1);
  filled_64_.fill_margin(-1);
  lay_out_limits();
}

Engine::Side Engine::make_side(int steps) const {
  const auto plane = [this] { return Plane<std::uint8_t>(size_.width_px, size_.height_px); };
  return {{plane(), plane(), plane()},
          {plane(), plane(), plane()},
          AlignedBuffer<std::uint8_t>(product(3, layout_.lanes, layout_.lane_stride())),
          AlignedBuffer<std::uint8_t>(product(3, steps, layout_.lanes))};
}

void Engine::lay_out_limits() {
  for (int v = 0; v < size_.height_px; ++v) {
    const int lane = v % layout_.lanes;
    const int start = v / layout_.lanes * layout_.period + 2 * lane;
    for (int u = 0; u < size_.width_px; ++u) {
      const std::size_t at = product(start + u, layout_.lanes) + static_cast<std::size_t>(lane);
      limit_.data()[at] = static_cast<std::uint8_t>(std::min(255, size_.width_px - 1 - u));
      inside_.data()[at] = 255;
    }
  }
}

void Engine::match(const GreyPair& pair,
                   const ImageRows<float>& disparity_px,
                   Executor& executor,
                   EngineListener* listener) {
  const auto done = [listener](EngineStage stage) {
    if (listener != nullptr) {
      listener->done(stage);
    }
  };
  smooth_both(pair, executor);
  done(EngineStage::kSmooth);
  take_both_census(executor);
  done(EngineStage::kCensus);
  skew_all(executor);
  done(EngineStage::kSkew);
  sweep(executor);
  done(EngineStage::kSweeps);
  check_winners(executor);
  done(EngineStage::kLeftRight);
  fill_holes(executor);
  done(EngineStage::kMedian);
  drop_speckles(executor);
  done(EngineStage::kSpeckles);
  drop_edges(pair, disparity_px, executor);
  done(EngineStage::kEdges);
}

void Engine::smooth_both(const GreyPair& pair, Executor& executor) {
  const auto& left = pair.align_left ? pair.right : pair.left;
  const auto& right = pair.align_left ? pair.left : pair.right;
  for_each_row(executor, 0, size_.height_px, [&](int v) {
    copy_row(left.row(v), size_.width_px, pair.align_left, left_.images.raw.row(v));
    copy_row(right.row(v), size_.width_px, pair.align_left, right_.images.raw.row(v));
    left_.images.raw.replicate_sides(v);
    right_.images.raw.replicate_sides(v);
  });
  for_each_band(executor, 0, size_.height_px, [&](int first, int last) {
    smooth(left_, first, last);
    smooth(right_, first, last);
    median_3x3(right_.images.raw, first, last, guide_);
    for (int v = first; v < last; ++v) {
      mark_texture(right_.images.raw, v, config_.texture_min_grey, textured_);
    }
  });
}

void Engine::take_both_census(Executor& executor) {
  for_each_row(executor, 0, size_.height_px, [&](int v) {
    take_census(left_, v);
    take_census(right_, v);
    place_guide(v);
  });
}

void Engine::smooth(Side& side, int first, int last) noexcept {
  smooth_cross(side.images.raw, first, last, side.images.cross);
  smooth_box(side.images.raw, first, last, side.images.box);
}

LaneRows Engine::lane_rows_of(AlignedBuffer<std::uint8_t>& planes, int plane) const noexcept {
  return {planes.data() + layout_.lane_stride() * layout_.lanes * plane + layout_.lead(),
          layout_.lane_stride()};
}

void Engine::take_census(Side& side, int v) noexcept {
  census_row(
      side.images, v, {side.census.raw.row(v), side.census.cross.row(v), side.census.box.row(v)});
  const std::ptrdiff_t plane = layout_.lanes * layout_.lane_stride();
  std::uint8_t* const to = side.lane_rows.data() + layout_.row_offset(v);
  std::copy_n(side.census.raw.row(v), size_.width_px, to);
  std::copy_n(side.census.cross.row(v), size_.width_px, to + plane);
  std::copy_n(side.census.box.row(v), size_.width_px, to + 2 * plane);
}

/// The guide's rows also stand beside the strips above and below their own: lane i of a strip is
/// row i + 1 here.
void Engine::place_guide(int v) noexcept {
  const int lane = v % layout_.lanes;
  const int strip = v / layout_.lanes;
  const auto put = [&](int at, int in_strip) {
    if (in_strip >= 0 && in_strip < layout_.strips) {
      std::copy_n(guide_.row(v),
                  size_.width_px,
                  guide_rows_.data() + at * layout_.lane_stride() + layout_.lead() +
                      static_cast<std::ptrdiff_t>(in_strip) * layout_.period);
    }
  };
  put(lane + 1, strip);
  if (lane == layout_.lanes - 1) {
    put(0, strip + 1);
  }
  if (lane == 0) {
    put(layout_.lanes + 1, strip - 1);
  }
}

void Engine::skew_side(Side& side, int step) noexcept {
  const std::ptrdiff_t lanes = layout_.lanes;
  for (int plane = 0; plane < 3; ++plane) {
    skew(lane_rows_of(side.lane_rows, plane),
         layout_.lanes,
         step,
         {side.steps.data() + plane * lanes, 3 * lanes});
  }
}

void Engine::skew_all(Executor& executor) {
  const int blocks = (layout_.steps + std::max(layout_.disparities, 2 * kGuideLead)) / kBlock;
  const std::ptrdiff_t guide_stride = layout_.lanes + kGuideLanes;
  const auto block = [&](int i) {
    const int step = i * kBlock;
    if (step < layout_.steps + layout_.disparities) {
      skew_side(left_, step);
    }
    if (step < layout_.steps) {
      skew_side(right_, step);
    }
    if (step < layout_.steps + 2 * kGuideLead) {
      // Lane i + 1 of the guide is two columns behind lane i, as is the strip's own lane.
      skew({guide_rows_.data() + layout_.lead() + 2, layout_.lane_stride()},
           layout_.lanes + kGuideLanes,
           step - kGuideLead,
           {guide_steps_.data() + kGuideLead * guide_stride, guide_stride});
    }
  };
  executor.for_each(blocks, Task(block));
}

Sweep Engine::sweep_of(SweepState& state, AlignedBuffer<std::uint8_t>& left) noexcept {
  const std::ptrdiff_t guide_stride = layout_.lanes + kGuideLanes;
  const std::size_t half = left.size() / 2;
  std::memset(left.data(), 255, half);
  state.clear();
  return {{layout_,
           right_.steps.data(),
           left_.steps.data(),
           guide_steps_.data() + kGuideLead * guide_stride,
           guide_stride,
           limit_.data(),
           inside_.data()},
          {half_sum_.data(),
           winners_.data(),
           winners_.data() + winners_.size() / 3,
           winners_.data() + winners_.size() / 3 * 2},
          {left.data(), left.data() + half},
          {static_cast<std::uint8_t>(config_.p1),
           static_cast<std::uint8_t>(config_.p2_min),
           static_cast<std::uint8_t>(config_.p2_max),
           static_cast<std::uint8_t>(config_.uniqueness_percent)},
          &state};
}

/// The sweeps set out from both ends at once. Where they meet each finds the other's sums, and goes
/// on as the one that picks the winners.
void Engine::sweep(Executor& executor) {
  const Sweep forward = sweep_of(forward_, forward_left_);
  const Sweep backward = sweep_of(backward_, backward_left_);
  const int middle = layout_.steps / 2 / kBlock * kBlock;
  const auto towards = [&](int i) {
    i == 0 ? store_forward(forward, 0, middle) : store_backward(backward, middle, layout_.steps);
  };
  executor.for_each(2, Task(towards));
  const auto apart = [&](int i) {
    i == 0 ? finish_forward(forward, middle, layout_.steps) : finish_backward(backward, 0, middle);
  };
  executor.for_each(2, Task(apart));
  join_left_winners();
}

/// Left pixels whose candidates both sweeps saw: the backward sweep has the larger disparities.
void Engine::join_left_winners() noexcept {
  const int middle = layout_.steps / 2 / kBlock * kBlock;
  const std::size_t half = forward_left_.size() / 2;
  const std::size_t first = product(middle, layout_.lanes);
  const std::size_t last = first + product(layout_.disparities, layout_.lanes);
  for (std::size_t i = first; i < last; ++i) {
    if (backward_left_.data()[i] < forward_left_.data()[i]) {
      forward_left_.data()[half + i] = backward_left_.data()[half + i];
    }
  }
}

void Engine::back_to_rows(Executor& executor) {
  const int middle = layout_.steps / 2 / kBlock * kBlock;
  const std::size_t plane = winners_.size() / 3;
  const auto block = [&](int i) {
    const int step = i * kBlock;
    auto& left = step < middle ? backward_left_ : forward_left_;
    const auto back = [&](std::uint8_t* steps, int to) {
      unskew({steps, layout_.lanes}, layout_.lanes, step, lane_rows_of(winner_rows_, to));
    };
    back(winners_.data(), 0);
    back(winners_.data() + plane, 1);
    back(winners_.data() + 2 * plane, 2);
    back(left.data() + left.size() / 2, 3);
  };
  executor.for_each(layout_.steps / kBlock, Task(block));
}

void Engine::check_winners(Executor& executor) {
  back_to_rows(executor);
  const std::ptrdiff_t plane = layout_.lanes * layout_.lane_stride();
  const auto winners = [&](int v) { return winner_rows_.data() + layout_.row_offset(v); };
  for_each_row(executor, 0, size_.height_px, [&](int v) {
    std::copy_n(winners(v) + 2 * plane, size_.width_px, repeated_.row(v));
    repeated_.replicate_sides(v);
    count_repeated(repeated_, v, repeated_counts_);
  });
  for_each_row(executor, 0, size_.height_px, [&](int v) {
    mark_confident(repeated_counts_, textured_, v, config_.repetition_px, confident_);
    const std::uint8_t* const row = winners(v);
    check_left_right({row, row + plane, row + 3 * plane, confident_.row(v)},
                     size_.width_px,
                     in_64ths(config_.left_right_px),
                     disparity_64_.row(v));
  });
}

void Engine::fill_holes(Executor& executor) {
  for (int pass = 0; pass < config_.median_passes; ++pass) {
    for_each_row(executor, -2, size_.height_px + 2, [&](int v) {
      median_along_row(disparity_64_, v, medians_);
    });
    for_each_row(executor, 0, size_.height_px, [&](int v) {
      median_down_column(disparity_64_, medians_, v, config_.fill_min_px, filled_64_);
    });
    std::swap(disparity_64_, filled_64_);
  }
  for_each_row(
      executor, 0, size_.height_px, [&](int v) { keep_confident(confident_, v, disparity_64_); });
}

void Engine::drop_speckles(Executor& executor) {
  if (config_.speckle_size_px <= 1) {
    return;
  }
  for_each_row(executor, 0, size_.height_px, [&](int v) {
    speckles_.look_at(disparity_64_, v, in_64ths(config_.speckle_step_px));
  });
  speckles_.drop_small(disparity_64_, config_.speckle_size_px);
}

void Engine::drop_edges(const GreyPair& pair,
                        const ImageRows<float>& disparity_px,
                        Executor& executor) {
  for_each_row(executor, 0, size_.height_px, [&](int v) {
    float* const row = disparity_px_.row(v);
    drop_depth_edges(disparity_64_, v, in_64ths(config_.edge_step_px), row);
    copy_row(row, size_.width_px, pair.align_left, disparity_px.row(v));
  });
}

}  // namespace skyhalo::sgm

#include "skyhalo/stereo/sgm/aggregation.hpp"

#include <algorithm>
#include <cstring>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "skyhalo/stereo/sgm/aggregation.cpp"
#include <hwy/foreach_target.h>
// They must come after what includes this file again for each target.
#include <hwy/cache_control.h>
#include <hwy/highway.h>

#include "skyhalo/stereo/sgm/matching_cost-inl.hpp"
#include "skyhalo/stereo/sgm/paths-inl.hpp"
#include "skyhalo/stereo/sgm/sub_pixel-inl.hpp"
#include "skyhalo/stereo/sgm/winner-inl.hpp"

HWY_BEFORE_NAMESPACE();

namespace skyhalo::sgm::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

enum class Way : std::uint8_t { kForward, kBackward };
enum class Goal : std::uint8_t { kStore, kFinish };

int lanes_of_target() {
  return static_cast<int>(hn::Lanes(Bytes()));
}

/// Offsets of a step's winners, or that they are none: not unique, or outside either image.
HWY_INLINE void judge(const Sweep& sweep, std::ptrdiff_t step, const Carry& winners) {
  const Bytes bytes;
  const Ints ints;
  const auto lanes = static_cast<std::ptrdiff_t>(hn::Lanes(bytes));
  std::uint8_t* const offset = sweep.out.offset + step * lanes;
  const auto winner = winners.load(kWinner);
  hn::Store(winner, bytes, sweep.out.disparity + step * lanes);
  const auto runs = winners.load(kRuns);
  const auto repeated = hn::Eq(hn::Max(runs, hn::Set(bytes, kRepeatedRuns)), runs);
  hn::Store(
      hn::IfThenElseZero(repeated, hn::Set(bytes, 1)), bytes, sweep.out.repeated + step * lanes);
  const auto last = hn::Set(bytes, static_cast<std::uint8_t>(sweep.in.layout.disparities - 1));
  const auto at_end = hn::Or(hn::Eq(winner, hn::Zero(bytes)), hn::Eq(winner, last));
  const auto best = winners.load(kBest);
  winners.store(kBelowBest, hn::IfThenElse(at_end, best, winners.load(kBelowBest)));
  winners.store(kAboveBest, hn::IfThenElse(at_end, best, winners.load(kAboveBest)));
  const auto lane = [&](int which, std::ptrdiff_t i)
                        HWY_ATTR { return widened(winners.memory + which * lanes + i); };
  for (std::ptrdiff_t i = 0; i < lanes; i += static_cast<std::ptrdiff_t>(hn::Lanes(ints))) {
    const auto least = lane(kBest, i);
    const auto bottom = v_bottom(lane(kBelowBest, i), least, lane(kAboveBest, i));
    const auto unique = is_unique(least, lane(kSecond, i), sweep.settings.uniqueness_percent);
    const auto judged = hn::IfThenElse(unique, bottom, hn::Set(ints, -128));
    const hn::Rebind<std::int8_t, Ints> signed_bytes;
    hn::StoreU(hn::DemoteTo(signed_bytes, judged),
               signed_bytes,
               reinterpret_cast<std::int8_t*>(offset + i));
  }
  const auto limit = hn::Load(bytes, sweep.in.limit + step * lanes);
  const auto seen = hn::Eq(hn::Max(winner, limit), limit);
  const auto none = hn::Set(bytes, kNoOffset);
  const auto inside = hn::Eq(hn::Load(bytes, sweep.in.inside + step * lanes), hn::Set(bytes, 255));
  hn::Store(hn::IfThenElse(hn::And(seen, inside), hn::Load(bytes, offset), none), bytes, offset);
}

/// The four paths of a sweep at one step, each with its predecessors: along the row and down the
/// column, and along both diagonals.
struct FourPaths {
  TwoPaths straight;
  TwoPaths diagonal;
};

template <Way kWay>
FourPaths paths_of(const Sweep& sweep, int step) {
  const auto lanes = static_cast<std::ptrdiff_t>(hn::Lanes(Bytes()));
  const SkewLayout& layout = sweep.in.layout;
  SweepState& state = *sweep.state;
  // The columns that the last lane of one strip leaves, and the first of the next finds.
  const int leave = (step + layout.period - 2 * (layout.lanes - 1) % layout.period) % layout.period;
  const int find = (step + 2) % layout.period;
  const int out = kWay == Way::kForward ? leave : find;
  const int in = kWay == Way::kForward ? find : leave;
  const auto path = [&](int slot, int edge) {
    return PathRows{
        state.rows(slot), state.least(slot), state.edge(in, edge), state.edge(out, edge)};
  };
  const auto carry = [&](int which) { return Carry{state.carry() + lanes * which * kPathVectors}; };
  return {{path(0, 0), path(1 + step % 2, 0), carry(0), carry(1)},
          {path(3 + step % 3, 1), path(6, 2), carry(2), carry(3)}};
}

template <int kShift>
HWY_INLINE void begin_paths(const Sweep& sweep, std::ptrdiff_t step, const FourPaths& paths) {
  const Bytes bytes;
  const auto lanes = static_cast<std::ptrdiff_t>(hn::Lanes(bytes));
  const std::uint8_t* const guide = sweep.in.guide + step * sweep.in.guide_stride;
  const auto level = [&](int steps_before, int lanes_before) HWY_ATTR {
    return hn::LoadU(bytes,
                     guide - kShift * (steps_before * sweep.in.guide_stride + lanes_before) + 1);
  };
  const auto inside = hn::Load(bytes, sweep.in.inside + step * lanes);
  const auto here = level(0, 0);
  const auto p2 = [&](int steps_before, int lanes_before) HWY_ATTR {
    return large_penalty(here, level(steps_before, lanes_before), inside, sweep.settings);
  };
  begin_path(paths.straight.a, p2(1, 0), paths.straight.carry_a);
  begin_path(paths.straight.b, p2(2, 1), paths.straight.carry_b);
  begin_path(paths.diagonal.a, p2(3, 1), paths.diagonal.carry_a);
  begin_path(paths.diagonal.b, p2(1, 1), paths.diagonal.carry_b);
}

template <int kShift>
HWY_INLINE void end_paths(const FourPaths& paths, std::ptrdiff_t disparities) {
  store_least<0>(paths.straight.carry_a.load(kNewLeast), paths.straight.a, disparities);
  store_least<kShift>(paths.straight.carry_b.load(kNewLeast), paths.straight.b, disparities);
  store_least<kShift>(paths.diagonal.carry_a.load(kNewLeast), paths.diagonal.a, disparities);
  store_least<kShift>(paths.diagonal.carry_b.load(kNewLeast), paths.diagonal.b, disparities);
}

/// One step of a sweep: cost, four paths, and what its goal is.
template <Way kWay, Goal kGoal, bool kTail>
HWY_NOINLINE void advance(const Sweep& sweep, int step) {
  const auto lanes = static_cast<std::ptrdiff_t>(hn::Lanes(Bytes()));
  constexpr int kShift = kWay == Way::kForward ? 1 : -1;
  constexpr bool kStore = kGoal == Goal::kStore;
  const std::ptrdiff_t disparities = sweep.in.layout.disparities;
  SweepState& state = *sweep.state;
  const FourPaths paths = paths_of<kWay>(sweep, step);
  const Carry winners{state.carry() + lanes * 4 * kPathVectors};
  begin_paths<kShift>(sweep, step, paths);
  begin_winners(winners);
  for (Block block; block.last < disparities;) {
    block = {block.last, std::min(disparities, block.last + kBlockDisparities)};
    cost_rows<kTail>(sweep.in, step, block, state.costs());
    extend_two<0, kShift, false, false>(
        paths.straight, sweep.settings.p1, block, {state.costs(), nullptr, state.sums()});
    std::uint8_t* const sums =
        kStore ? sweep.out.half_sum + (step * disparities + block.first) * lanes : state.sums();
    extend_two<kShift, kShift, true, kStore>(
        paths.diagonal, sweep.settings.p1, block, {state.costs(), state.sums(), sums});
    if (!kStore) {
      pick_winners<kWay == Way::kBackward, kTail>(
          sweep, step, block, {state.costs(), sums}, winners);
    }
  }
  end_paths<kShift>(paths, disparities);
  if (!kStore) {
    judge(sweep, step, winners);
  }
}

/// Whether some lane looks beyond the other image, or is in the gap between two strips.
bool is_tail(const SkewLayout& layout, int step) {
  const int first = layout.width_px - layout.disparities + 1;  // the first such column
  const int from = step - 2 * (layout.lanes - 1);              // columns from ... step, cyclic
  if (from <= 0) {
    return true;
  }
  const int column = from % layout.period;
  return column >= first || column + step - from >= first;
}

template <Way kWay, Goal kGoal>
void sweep_steps(const Sweep& sweep, int first, int last) {
  for (int i = first; i < last; ++i) {
    const int step = kWay == Way::kForward ? i : first + last - 1 - i;
    if (is_tail(sweep.in.layout, step)) {
      advance<kWay, kGoal, true>(sweep, step);
    } else {
      advance<kWay, kGoal, false>(sweep, step);
    }
  }
  hwy::FlushStream();
}

void forward_store(const Sweep& sweep, int first, int last) {
  sweep_steps<Way::kForward, Goal::kStore>(sweep, first, last);
}

void backward_store(const Sweep& sweep, int first, int last) {
  sweep_steps<Way::kBackward, Goal::kStore>(sweep, first, last);
}

void forward_finish(const Sweep& sweep, int first, int last) {
  sweep_steps<Way::kForward, Goal::kFinish>(sweep, first, last);
}

void backward_finish(const Sweep& sweep, int first, int last) {
  sweep_steps<Way::kBackward, Goal::kFinish>(sweep, first, last);
}

}  // namespace skyhalo::sgm::HWY_NAMESPACE

HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace skyhalo::sgm {

HWY_EXPORT(lanes_of_target);
HWY_EXPORT(forward_store);
HWY_EXPORT(backward_store);
HWY_EXPORT(forward_finish);
HWY_EXPORT(backward_finish);

int vector_lanes() noexcept {
  return HWY_DYNAMIC_DISPATCH(lanes_of_target)();
}

void store_forward(const Sweep& sweep, int first, int last) noexcept {
  HWY_DYNAMIC_DISPATCH(forward_store)(sweep, first, last);
}

void store_backward(const Sweep& sweep, int first, int last) noexcept {
  HWY_DYNAMIC_DISPATCH(backward_store)(sweep, first, last);
}

void finish_forward(const Sweep& sweep, int first, int last) noexcept {
  HWY_DYNAMIC_DISPATCH(forward_finish)(sweep, first, last);
}

void finish_backward(const Sweep& sweep, int first, int last) noexcept {
  HWY_DYNAMIC_DISPATCH(backward_finish)(sweep, first, last);
}

namespace {

std::size_t product(std::ptrdiff_t a, std::ptrdiff_t b) {
  return static_cast<std::size_t>(a) * static_cast<std::size_t>(b);
}

}  // namespace

SweepState::SweepState(const SkewLayout& layout)
    : disparities_(layout.disparities),
      slot_((layout.disparities + 1) * static_cast<std::ptrdiff_t>(layout.lanes) + kPad),
      least_stride_(layout.lanes + kPad),
      lanes_(layout.lanes),
      rows_(2 * kPad + product(kSlots, slot_)),
      least_(2 * kPad + product(kSlots, least_stride_)),
      edges_(1 + product(layout.period, 3 * edge_size())),
      costs_(product(kBlockDisparities, layout.lanes)),
      sums_(product(kBlockDisparities, layout.lanes)),
      carry_(product(4 * 5 + 10, layout.lanes)) {
  clear();
}

void SweepState::clear() noexcept {
  rows_.clear();
  least_.clear();
  edges_.clear();
  const std::ptrdiff_t last_row = disparities_ * lanes_;
  for (int slot = 0; slot < kSlots; ++slot) {
    std::memset(rows(slot) + last_row, kMostCost, static_cast<std::size_t>(lanes_));
  }
  for (std::size_t at = 1; at < edges_.size(); at += static_cast<std::size_t>(edge_size())) {
    edges_.data()[at + static_cast<std::size_t>(disparities_)] = kMostCost;
  }
}

}  // namespace skyhalo::sgm
#endif

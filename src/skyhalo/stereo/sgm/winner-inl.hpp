// The winner of a step's lanes, compiled once for each instruction set.
#if defined(SKYHALO_SGM_WINNER_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef SKYHALO_SGM_WINNER_INL_HPP
#undef SKYHALO_SGM_WINNER_INL_HPP
#else
#define SKYHALO_SGM_WINNER_INL_HPP
#endif

#include <hwy/cache_control.h>
#include <hwy/highway.h>

#include "skyhalo/stereo/sgm/aggregation.hpp"
#include "skyhalo/stereo/sgm/paths-inl.hpp"
#include "skyhalo/stereo/sgm/rounded_mean-inl.hpp"

HWY_BEFORE_NAMESPACE();

namespace skyhalo::sgm::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Bytes = hn::ScalableTag<std::uint8_t>;
using Lane8 = hn::Vec<Bytes>;

/// The vectors of the winners in their carry: of all disparities so far, and of all but the last,
/// the least sum; the last sum; the least that is not beside the winner; the sums below and above
/// the winner; the winner itself; whether the last was none; how many runs of disparities look
/// alike, and whether the last does.
enum : int {
  kBest = 0,
  kBestButOne,
  kLast,
  kSecond,
  kBelowBest,
  kAboveBest,
  kWinner,
  kLastLost,
  kRuns,
  kLastAlike,
  kWinnerVectors
};

/// Before the first disparity.
HWY_INLINE void begin_winners(const Carry& carry) {
  const Bytes bytes;
  for (int which = 0; which < kWinnerVectors; ++which) {
    carry.store(which, hn::Set(bytes, 255));
  }
  carry.store(kRuns, hn::Zero(bytes));
  carry.store(kLastAlike, hn::Zero(bytes));
}

/// Offers a sum to the left image's pixels, which stand in the same lane d steps on. The smallest
/// disparity of the least sum stays: they come in rising order (`kRising`) or in falling order.
template <bool kRising>
HWY_INLINE void offer_to_left(Lane8 sum,
                              Lane8 disparity,
                              std::uint8_t* cost,
                              std::uint8_t* winner) {
  const Bytes bytes;
  const auto before = hn::Load(bytes, cost);
  const auto least = hn::Min(before, sum);
  hn::Store(least, bytes, cost);
  const auto winner_before = hn::Load(bytes, winner);
  hn::Store(kRising ? hn::IfThenElse(hn::Eq(least, before), winner_before, disparity)
                    : hn::IfThenElse(hn::Eq(least, sum), disparity, winner_before),
            bytes,
            winner);
}

/// Rows of lanes of a block of disparities.
struct StepRows {
  const std::uint8_t* costs;
  const std::uint8_t* sums;
};

/// Winner takes all, for both images at once. `sums` holds four paths of one sweep, `half_sum` the
/// other four; S is the mean of the two, rounded up. `costs` tell where else a pixel looks alike.
template <bool kRising, bool kTail>
// NOLINTNEXTLINE(readability-function-size): vectors of unknown size cannot leave in a struct
HWY_INLINE void pick_winners(const Sweep& sweep,
                             std::ptrdiff_t step,
                             const Block& block,
                             const StepRows& rows,
                             const Carry& carry) {
  const Bytes bytes;
  const auto lanes = static_cast<std::ptrdiff_t>(hn::Lanes(bytes));
  const std::ptrdiff_t volume_step = sweep.in.layout.disparities * lanes;
  const std::ptrdiff_t last_step = sweep.in.layout.steps - 1;
  const std::ptrdiff_t next =
      kRising ? std::max(step - 1, std::ptrdiff_t{0}) : std::min(step + 1, last_step);
  const std::uint8_t* const half_sum = sweep.out.half_sum + step * volume_step;
  // The other sweep's sums are far away by now: those of the next step are asked for early.
  const std::uint8_t* const next_half_sum = sweep.out.half_sum + next * volume_step;
  const auto inside = hn::Load(bytes, sweep.in.inside + step * lanes);
  const auto limit = hn::Load(bytes, sweep.in.limit + step * lanes);
  const auto most = hn::Set(bytes, 255);
  auto best = carry.load(kBest);
  auto best_but_one = carry.load(kBestButOne);
  auto last = carry.load(kLast);
  auto second = carry.load(kSecond);
  auto below = carry.load(kBelowBest);
  auto above = carry.load(kAboveBest);
  auto winner = carry.load(kWinner);
  auto last_lost = hn::Eq(carry.load(kLastLost), most);
  auto runs = carry.load(kRuns);
  auto last_alike = hn::Eq(carry.load(kLastAlike), most);
  const auto alike_cost = hn::Set(bytes, kAlikeCost);
  for (std::ptrdiff_t d = block.first; d < block.last; ++d) {
    hwy::Prefetch(next_half_sum + d * lanes);
    const auto sum = rounded_mean(hn::Load(bytes, rows.sums + (d - block.first) * lanes),
                                  hn::Load(bytes, half_sum + d * lanes));
    const auto disparity = hn::Set(bytes, static_cast<std::uint8_t>(d));
    const auto new_best = hn::Min(best, sum);
    const auto lost = hn::Eq(new_best, best);
    second = hn::IfThenElse(last_lost, hn::Min(second, sum), second);
    second = hn::IfThenElse(lost, second, best_but_one);
    above = hn::IfThenElse(last_lost, above, sum);
    below = hn::IfThenElse(lost, below, last);
    winner = hn::IfThenElse(lost, winner, disparity);
    best_but_one = best;
    best = new_best;
    last = sum;
    last_lost = lost;
    const auto cost = hn::Load(bytes, rows.costs + (d - block.first) * lanes);
    const auto alike = hn::Eq(hn::Min(cost, alike_cost), cost);
    runs = hn::Sub(runs, hn::VecFromMask(bytes, hn::AndNot(last_alike, alike)));
    last_alike = alike;
    auto offered = sum;
    if (kTail) {
      const auto seen = hn::Eq(hn::Max(disparity, limit), limit);
      offered = hn::IfThenElse(seen, hn::Or(sum, hn::Not(inside)), most);
    }
    offer_to_left<kRising>(offered,
                           disparity,
                           sweep.left.cost + (step + d) * lanes,
                           sweep.left.disparity + (step + d) * lanes);
  }
  carry.store(kBest, best);
  carry.store(kBestButOne, best_but_one);
  carry.store(kLast, last);
  carry.store(kSecond, second);
  carry.store(kBelowBest, below);
  carry.store(kAboveBest, above);
  carry.store(kWinner, winner);
  carry.store(kLastLost, hn::VecFromMask(bytes, last_lost));
  carry.store(kRuns, runs);
  carry.store(kLastAlike, hn::VecFromMask(bytes, last_alike));
}

}  // namespace skyhalo::sgm::HWY_NAMESPACE

HWY_AFTER_NAMESPACE();

#endif

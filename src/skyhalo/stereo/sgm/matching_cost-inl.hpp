// The matching cost, compiled once for each instruction set.
#if defined(SKYHALO_SGM_MATCHING_COST_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef SKYHALO_SGM_MATCHING_COST_INL_HPP
#undef SKYHALO_SGM_MATCHING_COST_INL_HPP
#else
#define SKYHALO_SGM_MATCHING_COST_INL_HPP
#endif

#include <hwy/highway.h>

#include "skyhalo/stereo/sgm/aggregation.hpp"
#include "skyhalo/stereo/sgm/rounded_mean-inl.hpp"

HWY_BEFORE_NAMESPACE();

namespace skyhalo::sgm::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Bytes = hn::ScalableTag<std::uint8_t>;
using Lane8 = hn::Vec<Bytes>;

/// Costs of the lanes of one step for the disparities of a block: half the number of census bits
/// that differ, rounded up, 0...12. `kTail`: some lane looks beyond the other image, where the cost
/// is `kOutsideCost`, or is outside its own, where it is 0.
template <bool kTail>
HWY_INLINE void cost_rows(const SweepInput& in,
                          std::ptrdiff_t step,
                          const Block& block,
                          std::uint8_t* HWY_RESTRICT to) {
  const Bytes bytes;
  const auto lanes = static_cast<std::ptrdiff_t>(hn::Lanes(bytes));
  const std::uint8_t* const right = in.right_census + step * 3 * lanes;
  const std::uint8_t* left = in.left_census + (step + block.first) * 3 * lanes;
  const auto near = hn::Load(bytes, right);
  const auto middle = hn::Load(bytes, right + lanes);
  const auto far = hn::Load(bytes, right + 2 * lanes);
  const auto inside = hn::Load(bytes, in.inside + step * lanes);
  const auto limit = hn::Load(bytes, in.limit + step * lanes);
  const auto outside_cost = hn::Set(bytes, kOutsideCost);
  for (std::ptrdiff_t d = block.first; d < block.last; ++d) {
    const auto differing =
        hn::Add(hn::Add(hn::PopulationCount(hn::Xor(near, hn::Load(bytes, left))),
                        hn::PopulationCount(hn::Xor(middle, hn::Load(bytes, left + lanes)))),
                hn::PopulationCount(hn::Xor(far, hn::Load(bytes, left + 2 * lanes))));
    auto cost = rounded_mean(differing, hn::Zero(bytes));
    if (kTail) {
      const auto disparity = hn::Set(bytes, static_cast<std::uint8_t>(d));
      const auto seen = hn::Eq(hn::Max(disparity, limit), limit);
      cost = hn::And(hn::IfThenElse(seen, cost, outside_cost), inside);
    }
    hn::Store(cost, bytes, to);
    left += 3 * lanes;
    to += lanes;
  }
}

}  // namespace skyhalo::sgm::HWY_NAMESPACE

HWY_AFTER_NAMESPACE();

#endif

// One step of the paths, compiled once for each instruction set.
#if defined(SKYHALO_SGM_PATHS_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef SKYHALO_SGM_PATHS_INL_HPP
#undef SKYHALO_SGM_PATHS_INL_HPP
#else
#define SKYHALO_SGM_PATHS_INL_HPP
#endif

#include <hwy/highway.h>

#include "skyhalo/stereo/sgm/aggregation.hpp"

HWY_BEFORE_NAMESPACE();

namespace skyhalo::sgm::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Bytes = hn::ScalableTag<std::uint8_t>;
using Lane8 = hn::Vec<Bytes>;

/// The memory of one path: its costs at the predecessors, which those of this step replace. They
/// are stored `shift` lanes further, so that each lane then finds its predecessor in its own place.
/// The lane that falls off the edge is handed out, and another strip's is taken in.
struct PathRows {
  std::uint8_t* costs;
  std::uint8_t* least;
  const std::uint8_t* edge_in;
  std::uint8_t* edge_out;
};

/// Stores a row of costs and swaps the lane at the edge. Disparities come in rising order.
template <int kShift>
HWY_INLINE void store_row(Lane8 costs, const PathRows& path, std::ptrdiff_t d) {
  const Bytes bytes;
  const auto lanes = static_cast<std::ptrdiff_t>(hn::Lanes(bytes));
  if (kShift == 0) {
    hn::Store(costs, bytes, path.costs + d * lanes);
  } else if (kShift > 0) {
    std::uint8_t* const row = path.costs + d * lanes;
    hn::StoreU(costs, bytes, row + 1);
    path.edge_out[d] = row[lanes];
    row[lanes] = path.edge_in[d + 1];
  } else {
    std::uint8_t* const row = path.costs + d * lanes;
    hn::StoreU(costs, bytes, row - 1);
    path.edge_out[d] = row[-1];
    row[-1] = path.edge_in[d - 1];
  }
}

/// What `store_row` leaves to do after the last row.
template <int kShift>
HWY_INLINE void store_least(Lane8 least, const PathRows& path, std::ptrdiff_t disparities) {
  const Bytes bytes;
  const auto lanes = static_cast<std::ptrdiff_t>(hn::Lanes(bytes));
  if (kShift == 0) {
    hn::Store(least, bytes, path.least);
  } else if (kShift > 0) {
    hn::StoreU(least, bytes, path.least + 1);
    path.edge_out[disparities + 1] = path.least[lanes];
    path.least[0] = path.edge_in[disparities + 1];
    path.costs[0] = path.edge_in[0];
  } else {
    hn::StoreU(least, bytes, path.least - 1);
    path.edge_out[disparities + 1] = path.least[-1];
    path.least[lanes - 1] = path.edge_in[disparities + 1];
    path.costs[disparities * lanes - 1] = path.edge_in[disparities - 1];
  }
}

/// L_r of Hirschmueller 2008, eq. 13: `jump` is the least predecessor plus P2.
HWY_INLINE Lane8 extended(Lane8 cost, Lane8 here, Lane8 beside, Lane8 jump, Lane8 least) {
  return hn::Add(cost, hn::Sub(hn::Min(hn::Min(here, jump), beside), least));
}

/// What goes on from one block of disparities to the next, a vector each.
template <class V>
struct CarryOf {
  std::uint8_t* memory;

  HWY_INLINE V load(int which) const {
    const Bytes bytes;
    return hn::Load(bytes, memory + which * static_cast<std::ptrdiff_t>(hn::Lanes(bytes)));
  }

  HWY_INLINE void store(int which, V values) const {
    const Bytes bytes;
    hn::Store(values, bytes, memory + which * static_cast<std::ptrdiff_t>(hn::Lanes(bytes)));
  }
};

using Carry = CarryOf<Lane8>;

/// The vectors of one path in its carry: where it may jump to, the least of the predecessors and of
/// this step so far, and the predecessors at the last disparity and at the next, whose row in
/// memory has a new lane at the edge by then.
enum : int { kJump = 0, kLeast = 1, kNewLeast = 2, kBelow = 3, kHere = 4, kPathVectors = 5 };

/// Begins a step of a path.
HWY_INLINE void begin_path(const PathRows& path, Lane8 p2, const Carry& carry) {
  const Bytes bytes;
  const auto least = hn::Load(bytes, path.least);
  carry.store(kJump, hn::Add(least, p2));
  carry.store(kLeast, least);
  carry.store(kNewLeast, hn::Set(bytes, kMostCost));
  carry.store(kBelow, hn::Set(bytes, kMostCost));
  carry.store(kHere, hn::Load(bytes, path.costs));
}

/// Two paths that go on together.
struct TwoPaths {
  PathRows a;
  PathRows b;
  Carry carry_a;
  Carry carry_b;
};

/// Where a block's costs come from, and where its sums over the paths go: rows of lanes.
struct BlockRows {
  const std::uint8_t* cost;
  const std::uint8_t* partial;
  std::uint8_t* sums;
};

/// Extends two paths by one step, for a block of disparities, and writes the sum of their costs,
/// plus `partial` if there is one.
template <int kShiftA, int kShiftB, bool kPartial, bool kStream>
HWY_INLINE void extend_two(const TwoPaths& paths,
                           std::uint8_t small_penalty,
                           const Block& block,
                           const BlockRows& rows) {
  const Bytes bytes;
  const auto lanes = static_cast<std::ptrdiff_t>(hn::Lanes(bytes));
  const auto p1 = hn::Set(bytes, small_penalty);
  const auto jump_a = paths.carry_a.load(kJump);
  const auto jump_b = paths.carry_b.load(kJump);
  const auto least_a = paths.carry_a.load(kLeast);
  const auto least_b = paths.carry_b.load(kLeast);
  auto new_least_a = paths.carry_a.load(kNewLeast);
  auto new_least_b = paths.carry_b.load(kNewLeast);
  auto below_a = paths.carry_a.load(kBelow);
  auto below_b = paths.carry_b.load(kBelow);
  auto here_a = paths.carry_a.load(kHere);
  auto here_b = paths.carry_b.load(kHere);
  std::ptrdiff_t row = 0;
  for (std::ptrdiff_t d = block.first; d < block.last; ++d, row += lanes) {
    const auto c = hn::Load(bytes, rows.cost + row);
    const auto above_a = hn::Load(bytes, paths.a.costs + (d + 1) * lanes);
    const auto above_b = hn::Load(bytes, paths.b.costs + (d + 1) * lanes);
    const auto beside_a = hn::Add(hn::Min(below_a, above_a), p1);
    const auto beside_b = hn::Add(hn::Min(below_b, above_b), p1);
    const auto a = extended(c, here_a, beside_a, jump_a, least_a);
    const auto b = extended(c, here_b, beside_b, jump_b, least_b);
    new_least_a = hn::Min(new_least_a, a);
    new_least_b = hn::Min(new_least_b, b);
    store_row<kShiftA>(a, paths.a, d);
    store_row<kShiftB>(b, paths.b, d);
    auto sum = hn::Add(a, b);
    if (kPartial) {
      sum = hn::Add(sum, hn::Load(bytes, rows.partial + row));
    }
    if (kStream) {
      hn::Stream(sum, bytes, rows.sums + row);
    } else {
      hn::Store(sum, bytes, rows.sums + row);
    }
    below_a = here_a;
    below_b = here_b;
    here_a = above_a;
    here_b = above_b;
  }
  paths.carry_a.store(kNewLeast, new_least_a);
  paths.carry_b.store(kNewLeast, new_least_b);
  paths.carry_a.store(kBelow, below_a);
  paths.carry_b.store(kBelow, below_b);
  paths.carry_a.store(kHere, here_a);
  paths.carry_b.store(kHere, here_b);
}

/// P2 between two neighbours on a path: less where the image has an edge, 0 outside the image.
HWY_INLINE Lane8 large_penalty(Lane8 at,
                               Lane8 before,
                               Lane8 inside,
                               const SweepSettings& settings) {
  const Bytes bytes;
  const auto step = hn::Sub(hn::Max(at, before), hn::Min(at, before));
  const auto half = hn::ShiftRight<1>(step);
  const auto quarter = hn::ShiftRight<2>(step);
  const auto less = hn::SaturatedAdd(step, hn::SaturatedAdd(half, quarter));
  const auto penalty = hn::SaturatedSub(hn::Set(bytes, settings.p2_max), less);
  return hn::And(hn::Max(hn::Set(bytes, settings.p2_min), penalty), inside);
}

}  // namespace skyhalo::sgm::HWY_NAMESPACE

HWY_AFTER_NAMESPACE();

#endif

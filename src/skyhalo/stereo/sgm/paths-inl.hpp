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

/// Extends two paths by one step and writes the sum of their costs, plus `partial` if there is one.
template <int kShiftA, int kShiftB, bool kPartial, bool kStream>
HWY_INLINE void extend_two(const PathRows& path_a,
                           Lane8 p2_a,
                           const PathRows& path_b,
                           Lane8 p2_b,
                           const SweepSettings& settings,
                           std::ptrdiff_t disparities,
                           const std::uint8_t* HWY_RESTRICT cost,
                           const std::uint8_t* partial,
                           std::uint8_t* sums) {
  const Bytes bytes;
  const auto lanes = static_cast<std::ptrdiff_t>(hn::Lanes(bytes));
  const auto p1 = hn::Set(bytes, settings.p1);
  const auto most = hn::Set(bytes, 200);
  const auto least_a = hn::Load(bytes, path_a.least);
  const auto least_b = hn::Load(bytes, path_b.least);
  const auto jump_a = hn::Add(least_a, p2_a);
  const auto jump_b = hn::Add(least_b, p2_b);
  auto below_a = most;  // at d - 1
  auto below_b = most;
  auto here_a = hn::Load(bytes, path_a.costs);
  auto here_b = hn::Load(bytes, path_b.costs);
  auto new_least_a = most;
  auto new_least_b = most;
  for (std::ptrdiff_t d = 0; d < disparities; ++d) {
    const auto c = hn::Load(bytes, cost + d * lanes);
    const auto above_a = hn::Load(bytes, path_a.costs + (d + 1) * lanes);
    const auto above_b = hn::Load(bytes, path_b.costs + (d + 1) * lanes);
    const auto beside_a = hn::Add(hn::Min(below_a, above_a), p1);
    const auto beside_b = hn::Add(hn::Min(below_b, above_b), p1);
    const auto a = extended(c, here_a, beside_a, jump_a, least_a);
    const auto b = extended(c, here_b, beside_b, jump_b, least_b);
    new_least_a = hn::Min(new_least_a, a);
    new_least_b = hn::Min(new_least_b, b);
    store_row<kShiftA>(a, path_a, d);
    store_row<kShiftB>(b, path_b, d);
    auto sum = hn::Add(a, b);
    if (kPartial) {
      sum = hn::Add(sum, hn::Load(bytes, partial + d * lanes));
    }
    if (kStream) {
      hn::Stream(sum, bytes, sums + d * lanes);
    } else {
      hn::Store(sum, bytes, sums + d * lanes);
    }
    below_a = here_a;
    below_b = here_b;
    here_a = above_a;
    here_b = above_b;
  }
  store_least<kShiftA>(new_least_a, path_a, disparities);
  store_least<kShiftB>(new_least_b, path_b, disparities);
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

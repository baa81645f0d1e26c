#include "skyhalo/sphere/keep_nearest.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "skyhalo/sphere/keep_nearest.cpp"
#include <hwy/foreach_target.h>
// It must come after what includes this file again for each target.
#include <hwy/highway.h>

#include <algorithm>
#include <limits>

HWY_BEFORE_NAMESPACE();

namespace skyhalo::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Writes which of `count` ranges lie below the bound of their cell, in order; returns how many.
int find_below(const std::int32_t* cells,
               const float* ranges_m,
               int count,
               const float* bounds_m,
               std::int32_t* which) {
  const hn::ScalableTag<float> d;
  const hn::RebindToSigned<decltype(d)> di;
  int found = 0;
  for (int i = 0; i < count; i += static_cast<int>(hn::Lanes(d))) {
    const auto bound = hn::GatherIndex(d, bounds_m, hn::LoadU(di, cells + i));
    const auto below = hn::Lt(hn::LoadU(d, ranges_m + i), bound);
    if (!hn::AllFalse(d, below)) {
      found += static_cast<int>(
          hn::CompressStore(hn::Iota(di, i), hn::RebindMask(di, below), di, which + found));
    }
  }
  return found;
}

/// Puts a range in its place: each place takes the larger of its left neighbour and what of itself
/// and the new one is smaller.
HWY_INLINE void insert(float range_m, NearestRanges& kept) {
#if HWY_TARGET == HWY_SCALAR
  for (std::size_t place = kMaxNearest - 1; place > 0; --place) {
    kept.range_m[place] = std::max(kept.range_m[place - 1], std::min(kept.range_m[place], range_m));
  }
  kept.range_m[0] = std::min(kept.range_m[0], range_m);
#else
  const hn::FixedTag<float, 4> d;
  const auto none = hn::Set(d, -std::numeric_limits<float>::infinity());
  const auto range = hn::Set(d, range_m);
  float* const ranges_m = kept.range_m.data();
  const auto low = hn::Load(d, ranges_m);
  const auto high = hn::Load(d, ranges_m + 4);
  const auto left_of_low = hn::CombineShiftRightBytes<12>(d, low, none);
  const auto left_of_high = hn::CombineShiftRightBytes<12>(d, high, low);
  hn::Store(hn::Max(left_of_low, hn::Min(low, range)), d, ranges_m);
  hn::Store(hn::Max(left_of_high, hn::Min(high, range)), d, ranges_m + 4);
#endif
}

void keep_nearest_of_row(const CellRow& row, int rank, NearestRanges* kept, float* bounds_m) {
  constexpr int kChunk = 2 * kRowPadding;
  // Written before it is read. NOLINTNEXTLINE(*-member-init)
  std::array<std::int32_t, kChunk + kRowPadding> nearer;
  for (int begin = 0; begin < row.count; begin += kChunk) {
    const int found = find_below(row.cells + begin,
                                 row.ranges_m + begin,
                                 std::min(kChunk, row.count - begin),
                                 bounds_m,
                                 nearer.data());
    for (int i = 0; i < found; ++i) {
      const int at = begin + nearer[static_cast<std::size_t>(i)];
      const std::int32_t cell = row.cells[at];
      insert(row.ranges_m[at], kept[cell]);
      bounds_m[cell] = kept[cell].range_m[static_cast<std::size_t>(rank) - 1];
    }
  }
}

}  // namespace skyhalo::HWY_NAMESPACE

HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace skyhalo {

HWY_EXPORT(keep_nearest_of_row);

void keep_nearest(const CellRow& row, int rank, NearestRanges* kept, float* bounds_m) noexcept {
  HWY_DYNAMIC_DISPATCH(keep_nearest_of_row)(row, rank, kept, bounds_m);
}

}  // namespace skyhalo
#endif

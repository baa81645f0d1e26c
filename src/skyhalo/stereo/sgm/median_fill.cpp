#include "skyhalo/stereo/sgm/median_fill.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "skyhalo/stereo/sgm/median_fill.cpp"
#include <hwy/foreach_target.h>
// It must come after what includes this file again for each target.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();

namespace skyhalo::sgm::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Shorts = hn::ScalableTag<std::int16_t>;
using Short = hn::Vec<Shorts>;

constexpr std::int16_t kMoreThanAll = 32767;

HWY_INLINE Short median_of_five(Short a, Short b, Short c, Short d, Short e) {
  // The smallest and the largest of four cannot be the median of five.
  const auto larger_min = hn::Max(hn::Min(a, b), hn::Min(c, d));
  const auto smaller_max = hn::Min(hn::Max(a, b), hn::Max(c, d));
  const auto low = hn::Min(larger_min, smaller_max);
  const auto high = hn::Max(larger_min, smaller_max);
  return hn::Max(low, hn::Min(high, e));
}

void along_row(const Plane<std::int16_t>& disparity_64, int v, RowMedians& rows) {
  const Shorts shorts;
  const std::int16_t* const from = disparity_64.row(v);
  // -1 with the sign cleared is more than all: done where u + v is odd.
  const auto even_lane = hn::Eq(hn::And(hn::Iota(shorts, 0), hn::Set(shorts, 1)), hn::Zero(shorts));
  const auto all_bits = hn::Set(shorts, -1);
  const auto no_sign = hn::Set(shorts, kMoreThanAll);
  const auto even_first = hn::IfThenElse(even_lane, all_bits, no_sign);
  const auto odd_first = hn::IfThenElse(even_lane, no_sign, all_bits);
  for (int u = 0; u < disparity_64.width(); u += static_cast<int>(hn::Lanes(shorts))) {
    const bool even = ((u + v) & 1) == 0;
    const auto same = even ? even_first : odd_first;
    const auto other = even ? odd_first : even_first;
    const auto a = hn::LoadU(shorts, from + u - 2);
    const auto b = hn::LoadU(shorts, from + u - 1);
    const auto c = hn::LoadU(shorts, from + u);
    const auto d = hn::LoadU(shorts, from + u + 1);
    const auto e = hn::LoadU(shorts, from + u + 2);
    const auto median = median_of_five(
        hn::And(a, same), hn::And(b, other), hn::And(c, same), hn::And(d, other), hn::And(e, same));
    hn::StoreU(median, shorts, rows.median.row(v) + u);
    const auto invalid =  // -1 each
        hn::Add(hn::Add(hn::Add(hn::ShiftRight<15>(a), hn::ShiftRight<15>(b)),
                        hn::Add(hn::ShiftRight<15>(c), hn::ShiftRight<15>(d))),
                hn::ShiftRight<15>(e));
    hn::StoreU(hn::Add(hn::Set(shorts, 5), invalid), shorts, rows.valid.row(v) + u);
  }
}

HWY_INLINE Short row_at(const Plane<std::int16_t>& plane, int v, int u) {
  return hn::LoadU(Shorts(), plane.row(v) + u);
}

void down_column(const Plane<std::int16_t>& disparity_64,
                 const RowMedians& rows,
                 int v,
                 int fill_min,
                 Plane<std::int16_t>& filled) {
  const Shorts shorts;
  const auto none = hn::Set(shorts, -1);
  const auto enough = hn::Set(shorts, static_cast<std::int16_t>(fill_min - 1));
  for (int u = 0; u < disparity_64.width(); u += static_cast<int>(hn::Lanes(shorts))) {
    const auto median = median_of_five(row_at(rows.median, v - 2, u),
                                       row_at(rows.median, v - 1, u),
                                       row_at(rows.median, v, u),
                                       row_at(rows.median, v + 1, u),
                                       row_at(rows.median, v + 2, u));
    const auto valid =
        hn::Add(hn::Add(hn::Add(row_at(rows.valid, v - 2, u), row_at(rows.valid, v - 1, u)),
                        hn::Add(row_at(rows.valid, v, u), row_at(rows.valid, v + 1, u))),
                row_at(rows.valid, v + 2, u));
    const auto known = hn::Or(hn::Gt(row_at(disparity_64, v, u), none), hn::Gt(valid, enough));
    const auto found = hn::And(known, hn::Lt(median, hn::Set(shorts, kMoreThanAll)));
    hn::StoreU(hn::IfThenElse(found, median, none), shorts, filled.row(v) + u);
  }
  filled.fill_right_margin(v, -1);
}

}  // namespace skyhalo::sgm::HWY_NAMESPACE

HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace skyhalo::sgm {

HWY_EXPORT(along_row);
HWY_EXPORT(down_column);

void median_along_row(const Plane<std::int16_t>& disparity_64, int v, RowMedians& rows) noexcept {
  HWY_DYNAMIC_DISPATCH(along_row)(disparity_64, v, rows);
}

void median_down_column(const Plane<std::int16_t>& disparity_64,
                        const RowMedians& rows,
                        int v,
                        int fill_min,
                        Plane<std::int16_t>& filled) noexcept {
  HWY_DYNAMIC_DISPATCH(down_column)(disparity_64, rows, v, fill_min, filled);
}

}  // namespace skyhalo::sgm
#endif

#include "skyhalo/stereo/sgm/repetition.hpp"

#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "skyhalo/stereo/sgm/repetition.cpp"
#include <hwy/foreach_target.h>
// It must come after what includes this file again for each target.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();

namespace skyhalo::sgm::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

constexpr int kRadius = Plane<std::uint8_t>::kMargin;

void counts_row(const Plane<std::uint8_t>& repeated, int v, Plane<std::uint8_t>& counts) {
  const hn::ScalableTag<std::uint8_t> bytes;
  for (int u = 0; u < repeated.width(); u += static_cast<int>(hn::Lanes(bytes))) {
    const std::uint8_t* const row = repeated.row(v) + u;
    auto count = hn::LoadU(bytes, row);
    for (int du = 1; du <= kRadius; ++du) {
      count = hn::Add(count, hn::Add(hn::LoadU(bytes, row - du), hn::LoadU(bytes, row + du)));
    }
    hn::StoreU(count, bytes, counts.row(v) + u);
  }
}

void confident_row(const Plane<std::uint8_t>& counts,
                   const Plane<std::uint8_t>& textured,
                   int v,
                   int repetition_px,
                   Plane<std::uint8_t>& confident) {
  const hn::ScalableTag<std::uint8_t> bytes;
  const auto too_many = hn::Set(bytes, static_cast<std::uint8_t>(repetition_px));
  for (int u = 0; u < counts.width(); u += static_cast<int>(hn::Lanes(bytes))) {
    auto count = hn::Zero(bytes);
    for (int dv = -kRadius; dv <= kRadius; ++dv) {
      const int row = std::clamp(v + dv, 0, counts.height() - 1);
      count = hn::Add(count, hn::LoadU(bytes, counts.row(row) + u));
    }
    const auto ambiguous = hn::Eq(hn::Max(count, too_many), count);
    const auto has_texture = hn::LoadU(bytes, textured.row(v) + u);
    hn::StoreU(hn::IfThenZeroElse(ambiguous, has_texture), bytes, confident.row(v) + u);
  }
}

void kept_row(const Plane<std::uint8_t>& confident, int v, Plane<std::int16_t>& disparity_64) {
  const hn::ScalableTag<std::int16_t> shorts;
  const hn::Rebind<std::uint8_t, decltype(shorts)> bytes;
  std::int16_t* const row = disparity_64.row(v);
  for (int u = 0; u < disparity_64.width(); u += static_cast<int>(hn::Lanes(shorts))) {
    const auto sure = hn::PromoteTo(shorts, hn::LoadU(bytes, confident.row(v) + u));
    const auto unsure = hn::Eq(sure, hn::Zero(shorts));
    const auto here = hn::LoadU(shorts, row + u);
    hn::StoreU(hn::IfThenElse(unsure, hn::Set(shorts, -1), here), shorts, row + u);
  }
  disparity_64.fill_right_margin(v, -1);
}

}  // namespace skyhalo::sgm::HWY_NAMESPACE

HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace skyhalo::sgm {

HWY_EXPORT(counts_row);
HWY_EXPORT(confident_row);
HWY_EXPORT(kept_row);

void count_repeated(const Plane<std::uint8_t>& repeated, int v, Plane<std::uint8_t>& counts) {
  HWY_DYNAMIC_DISPATCH(counts_row)(repeated, v, counts);
}

void mark_confident(const Plane<std::uint8_t>& counts,
                    const Plane<std::uint8_t>& textured,
                    int v,
                    int repetition_px,
                    Plane<std::uint8_t>& confident) {
  HWY_DYNAMIC_DISPATCH(confident_row)(counts, textured, v, repetition_px, confident);
}

void keep_confident(const Plane<std::uint8_t>& confident,
                    int v,
                    Plane<std::int16_t>& disparity_64) noexcept {
  HWY_DYNAMIC_DISPATCH(kept_row)(confident, v, disparity_64);
}

}  // namespace skyhalo::sgm
#endif

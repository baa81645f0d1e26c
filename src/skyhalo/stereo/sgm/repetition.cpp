#include "skyhalo/stereo/sgm/repetition.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "skyhalo/stereo/sgm/repetition.cpp"
#include <hwy/foreach_target.h>
// It must come after what includes this file again for each target.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();

namespace skyhalo::sgm::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

void confident_row(const Plane<std::uint8_t>& repeated,
                   const Plane<std::uint8_t>& textured,
                   int v,
                   int repetition_px,
                   Plane<std::uint8_t>& confident) {
  const hn::ScalableTag<std::uint8_t> bytes;
  constexpr int kRadius = Plane<std::uint8_t>::kMargin;
  const auto too_many = hn::Set(bytes, static_cast<std::uint8_t>(repetition_px));
  for (int u = 0; u < repeated.width(); u += static_cast<int>(hn::Lanes(bytes))) {
    auto count = hn::Zero(bytes);
    for (int dv = -kRadius; dv <= kRadius; ++dv) {
      const std::uint8_t* const row = repeated.row(v + dv) + u;
      for (int du = -kRadius; du <= kRadius; ++du) {
        count = hn::Add(count, hn::LoadU(bytes, row + du));
      }
    }
    const auto ambiguous = hn::Eq(hn::Max(count, too_many), count);
    const auto has_texture = hn::LoadU(bytes, textured.row(v) + u);
    hn::StoreU(hn::IfThenZeroElse(ambiguous, has_texture), bytes, confident.row(v) + u);
  }
}

}  // namespace skyhalo::sgm::HWY_NAMESPACE

HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace skyhalo::sgm {

HWY_EXPORT(confident_row);

void mark_confident(const Plane<std::uint8_t>& repeated,
                    const Plane<std::uint8_t>& textured,
                    int v,
                    int repetition_px,
                    Plane<std::uint8_t>& confident) {
  HWY_DYNAMIC_DISPATCH(confident_row)(repeated, textured, v, repetition_px, confident);
}

void keep_confident(const std::uint8_t* confident, int width, std::int16_t* disparity_64) noexcept {
  for (int u = 0; u < width; ++u) {
    disparity_64[u] = confident[u] != 0 ? disparity_64[u] : std::int16_t{-1};
  }
}

}  // namespace skyhalo::sgm
#endif

#include "skyhalo/stereo/sgm/texture.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "skyhalo/stereo/sgm/texture.cpp"
#include <hwy/foreach_target.h>
// It must come after what includes this file again for each target.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();

namespace skyhalo::sgm::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

void texture_row(const Plane<std::uint8_t>& image,
                 int v,
                 int texture_min,
                 Plane<std::uint8_t>& textured) {
  const hn::ScalableTag<std::uint8_t> bytes;
  constexpr int kRadius = Plane<std::uint8_t>::kMargin;
  const auto threshold = hn::Set(bytes, static_cast<std::uint8_t>(texture_min));
  std::uint8_t* const to = textured.row(v);
  for (int u = 0; u < image.width(); u += static_cast<int>(hn::Lanes(bytes))) {
    auto darkest = hn::LoadU(bytes, image.row(v) + u);
    auto brightest = darkest;
    // Most pixels have texture nearby: the first row that shows it is enough.
    for (int dv = 0; dv <= kRadius; ++dv) {
      for (const int row : {v - dv, v + dv}) {
        for (int du = -kRadius; du <= kRadius; ++du) {
          const auto level = hn::LoadU(bytes, image.row(row) + u + du);
          darkest = hn::Min(darkest, level);
          brightest = hn::Max(brightest, level);
        }
      }
      const auto range = hn::Sub(brightest, darkest);
      if (hn::AllTrue(bytes, hn::Eq(hn::Max(range, threshold), range))) {
        break;
      }
    }
    const auto range = hn::Sub(brightest, darkest);
    const auto enough = hn::Eq(hn::Max(range, threshold), range);
    hn::StoreU(hn::IfThenElseZero(enough, hn::Set(bytes, 1)), bytes, to + u);
  }
}

}  // namespace skyhalo::sgm::HWY_NAMESPACE

HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace skyhalo::sgm {

HWY_EXPORT(texture_row);

void mark_texture(const Plane<std::uint8_t>& image,
                  int v,
                  int texture_min,
                  Plane<std::uint8_t>& textured) {
  HWY_DYNAMIC_DISPATCH(texture_row)(image, v, texture_min, textured);
}

}  // namespace skyhalo::sgm
#endif

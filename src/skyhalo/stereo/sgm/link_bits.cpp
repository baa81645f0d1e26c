#include "skyhalo/stereo/sgm/link_bits.hpp"

#include <algorithm>
#include <cstring>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "skyhalo/stereo/sgm/link_bits.cpp"
#include <hwy/foreach_target.h>
// It must come after what includes this file again for each target.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();

namespace skyhalo::sgm::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Shorts = hn::ScalableTag<std::int16_t>;
using Short = hn::Vec<Shorts>;

HWY_INLINE hn::Mask<Shorts> linked(Short here, Short there, Short allowed) {
  const Shorts shorts;
  const auto difference = hn::Sub(hn::Max(here, there), hn::Min(here, there));
  const auto both = hn::Gt(hn::Min(here, there), hn::Set(shorts, -1));
  return hn::AndNot(hn::Gt(difference, allowed), both);
}

/// Puts the bits of a vector at pixel u; a word is complete once its last pixel came.
HWY_INLINE void put_bits(hn::Mask<Shorts> mask, int u, std::uint64_t* words) {
  const Shorts shorts;
  std::uint8_t bytes[HWY_MAX_BYTES / 16 + 8] = {};  // NOLINT(*-avoid-c-arrays)
  hn::StoreMaskBits(shorts, mask, bytes);
  const std::size_t lanes = hn::Lanes(shorts);
  if (lanes <= 64) {
    std::uint64_t bits = 0;
    std::memcpy(&bits, bytes, 8);
    words[u / 64] |= bits << static_cast<unsigned>(u % 64);
  } else {
    std::memcpy(words + u / 64, bytes, lanes / 8);
  }
}

void links_row(const Plane<std::int16_t>& disparity_64, int v, int step_64, const LinkBits& bits) {
  const Shorts shorts;
  const std::int16_t* const at = disparity_64.row(v);
  const std::int16_t* const above = disparity_64.row(v - 1);
  const auto allowed = hn::Set(shorts, static_cast<std::int16_t>(std::min(step_64, 32767)));
  const int width = disparity_64.width();
  const int words = (width + 63) / 64;
  std::fill(bits.valid, bits.valid + words, 0);
  std::fill(bits.across, bits.across + words, 0);
  std::fill(bits.down, bits.down + words, 0);
  for (int u = 0; u < width; u += static_cast<int>(hn::Lanes(shorts))) {
    const auto here = hn::LoadU(shorts, at + u);
    put_bits(hn::Gt(here, hn::Set(shorts, -1)), u, bits.valid);
    put_bits(linked(here, hn::LoadU(shorts, at + u - 1), allowed), u, bits.across);
    put_bits(linked(here, hn::LoadU(shorts, above + u), allowed), u, bits.down);
  }
  if (width % 64 != 0) {
    const std::uint64_t in_row = (std::uint64_t{1} << static_cast<unsigned>(width % 64)) - 1;
    bits.valid[words - 1] &= in_row;
    bits.across[words - 1] &= in_row;
    bits.down[words - 1] &= in_row;
  }
}

}  // namespace skyhalo::sgm::HWY_NAMESPACE

HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace skyhalo::sgm {

HWY_EXPORT(links_row);

void find_links(const Plane<std::int16_t>& disparity_64,
                int v,
                int step_64,
                const LinkBits& bits) noexcept {
  HWY_DYNAMIC_DISPATCH(links_row)(disparity_64, v, step_64, bits);
}

}  // namespace skyhalo::sgm
#endif

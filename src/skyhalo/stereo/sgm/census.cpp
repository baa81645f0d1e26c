#include "skyhalo/stereo/sgm/census.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "skyhalo/stereo/sgm/census.cpp"
#include <hwy/foreach_target.h>
// It must come after what includes this file again for each target.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();

namespace skyhalo::sgm::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Bytes = hn::ScalableTag<std::uint8_t>;

/// `bits` with `bit` set where the neighbour is darker than the centre.
template <class V>
HWY_INLINE V with_bit(V bits, V neighbour, V centre, V bit) {
  const auto not_darker = hn::Eq(hn::Max(neighbour, centre), neighbour);
  return hn::Or(bits, hn::IfThenZeroElse(not_darker, bit));
}

void ring_row(const Plane<std::uint8_t>& image, int v, int radius_px, std::uint8_t* out) {
  const Bytes bytes;
  const std::uint8_t* const above = image.row(v - radius_px);
  const std::uint8_t* const at = image.row(v);
  const std::uint8_t* const below = image.row(v + radius_px);
  for (int u = 0; u < image.width(); u += static_cast<int>(hn::Lanes(bytes))) {
    const auto centre = hn::LoadU(bytes, at + u);
    auto bits = hn::Zero(bytes);
    const auto add = [&](const std::uint8_t* neighbours, int shift_px, int bit) HWY_ATTR {
      bits = with_bit(bits,
                      hn::LoadU(bytes, neighbours + u + shift_px),
                      centre,
                      hn::Set(bytes, static_cast<std::uint8_t>(1U << static_cast<unsigned>(bit))));
    };
    add(above, -radius_px, 0);
    add(above, 0, 1);
    add(above, radius_px, 2);
    add(at, -radius_px, 3);
    add(at, radius_px, 4);
    add(below, -radius_px, 5);
    add(below, 0, 6);
    add(below, radius_px, 7);
    hn::StoreU(bits, bytes, out + u);
  }
}

void rings_row(const CensusImages& images, int v, const CensusRow& out) {
  ring_row(images.raw, v, 1, out.near);
  ring_row(images.cross, v, 2, out.middle);
  ring_row(images.box, v, 4, out.far);
}

}  // namespace skyhalo::sgm::HWY_NAMESPACE

HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace skyhalo::sgm {

HWY_EXPORT(rings_row);

void census_row(const CensusImages& images, int v, const CensusRow& out) {
  HWY_DYNAMIC_DISPATCH(rings_row)(images, v, out);
}

}  // namespace skyhalo::sgm
#endif

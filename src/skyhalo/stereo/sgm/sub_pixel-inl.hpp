// What becomes of a step's winners, compiled once for each instruction set.
#if defined(SKYHALO_SGM_SUB_PIXEL_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef SKYHALO_SGM_SUB_PIXEL_INL_HPP
#undef SKYHALO_SGM_SUB_PIXEL_INL_HPP
#else
#define SKYHALO_SGM_SUB_PIXEL_INL_HPP
#endif

#include <hwy/highway.h>

#include "skyhalo/stereo/sgm/aggregation.hpp"

HWY_BEFORE_NAMESPACE();

namespace skyhalo::sgm::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Floats = hn::ScalableTag<float>;
using Ints = hn::RebindToSigned<Floats>;

/// As many bytes as there are floats in a vector, as integers.
HWY_INLINE hn::Vec<Ints> widened(const std::uint8_t* bytes) {
  const Ints ints;
  return hn::PromoteTo(ints, hn::LoadU(hn::Rebind<std::uint8_t, Ints>(), bytes));
}

/// Where the V through three neighbouring sums has its bottom, in 1/64 px from the middle one,
/// -32...32: its arms are equally steep, the higher neighbour gives the slope. Sums of census costs
/// have that shape rather than a parabola's. None of the three is less than the middle one.
HWY_INLINE hn::Vec<Ints> v_bottom(hn::Vec<Ints> below, hn::Vec<Ints> best, hn::Vec<Ints> above) {
  const Ints ints;
  const Floats floats;
  const auto slope = hn::ShiftLeft<5>(hn::Sub(below, above));
  const auto height = hn::Sub(hn::Max(below, above), best);
  const auto divisor = hn::Max(height, hn::Set(ints, 1));
  // IEEE division and rounding to even: the same on every x86 and aarch64.
  return hn::NearestInt(hn::Div(hn::ConvertTo(floats, slope), hn::ConvertTo(floats, divisor)));
}

/// Whether the best sum beats all that are not beside it by the asked share of them.
HWY_INLINE hn::Mask<Ints> is_unique(hn::Vec<Ints> best, hn::Vec<Ints> second, int percent) {
  const Ints ints;
  return hn::Lt(hn::Mul(best, hn::Set(ints, 100)), hn::Mul(second, hn::Set(ints, 100 - percent)));
}

}  // namespace skyhalo::sgm::HWY_NAMESPACE

HWY_AFTER_NAMESPACE();

#endif

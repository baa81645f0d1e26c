// The mean of two bytes, compiled once for each instruction set.
#if defined(SKYHALO_SGM_ROUNDED_MEAN_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef SKYHALO_SGM_ROUNDED_MEAN_INL_HPP
#undef SKYHALO_SGM_ROUNDED_MEAN_INL_HPP
#else
#define SKYHALO_SGM_ROUNDED_MEAN_INL_HPP
#endif

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();

namespace skyhalo::sgm::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// (a + b + 1) / 2 of each lane, as if the sum had room.
template <class V>
HWY_INLINE V rounded_mean(V a, V b) {
#if HWY_TARGET == HWY_SVE || HWY_TARGET == HWY_SVE_256
  // Highway's own loses the carry there.
  return hn::Sub(hn::Or(a, b), hn::ShiftRight<1>(hn::Xor(a, b)));
#else
  return hn::AverageRound(a, b);
#endif
}

}  // namespace skyhalo::sgm::HWY_NAMESPACE

HWY_AFTER_NAMESPACE();

#endif

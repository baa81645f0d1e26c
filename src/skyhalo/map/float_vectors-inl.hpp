// Vectors of numbers as the kernels of maps use them. Compiled again for each instruction set:
// include it after Highway's foreach_target.h.
#if defined(SKYHALO_FLOAT_VECTORS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef SKYHALO_FLOAT_VECTORS_INL
#undef SKYHALO_FLOAT_VECTORS_INL
#else
#define SKYHALO_FLOAT_VECTORS_INL
#endif

#include <hwy/highway.h>

#include <Eigen/Core>

HWY_BEFORE_NAMESPACE();

namespace skyhalo::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Floats = hn::ScalableTag<float>;
using Integers = hn::RebindToSigned<Floats>;
using Vector = hn::Vec<Floats>;
using Whole = hn::Vec<Integers>;
using Truth = hn::Mask<Floats>;

HWY_INLINE Vector set(float value) {
  return hn::Set(Floats(), value);
}

/// One component, in the map's frame, of a vector of the body's.
HWY_INLINE Vector rotated(const Eigen::Matrix3f& R, int axis, Vector x, Vector y, Vector z) {
  const Vector xy = hn::MulAdd(set(R(axis, 1)), y, hn::Mul(set(R(axis, 0)), x));
  return hn::MulAdd(set(R(axis, 2)), z, xy);
}

}  // namespace skyhalo::HWY_NAMESPACE

HWY_AFTER_NAMESPACE();

#endif

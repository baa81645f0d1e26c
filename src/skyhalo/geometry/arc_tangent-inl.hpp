// The angle of a vector, for kernels. Compiled again for each instruction set: include it after
// Highway's foreach_target.h.
#if defined(SKYHALO_ARC_TANGENT_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef SKYHALO_ARC_TANGENT_INL
#undef SKYHALO_ARC_TANGENT_INL
#else
#define SKYHALO_ARC_TANGENT_INL
#endif

#include <hwy/highway.h>

#include <limits>
#include <numbers>

HWY_BEFORE_NAMESPACE();

namespace skyhalo::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using FloatVector = hn::Vec<hn::ScalableTag<float>>;

/// `c0 + c1 x + c2 x^2 ...`
template <class... Coefficients>
HWY_INLINE FloatVector polynomial(FloatVector x, float first, Coefficients... others) {
  const hn::ScalableTag<float> d;
  if constexpr (sizeof...(others) == 0) {
    return hn::Set(d, first);
  } else {
    return hn::MulAdd(polynomial(x, others...), x, hn::Set(d, first));
  }
}

/// `1/x` within 3e-7, for x > 0 that is not tiny; without the processor's divider, which is slow.
HWY_INLINE FloatVector reciprocal(FloatVector x) {
  const hn::ScalableTag<float> d;
  const FloatVector two = hn::Set(d, 2.0F);
  const FloatVector first = hn::ApproximateReciprocal(x);
  const FloatVector second = hn::Mul(first, hn::NegMulAdd(x, first, two));
#if HWY_ARCH_ARM
  return hn::Mul(second, hn::NegMulAdd(x, second, two));  // begins with 8 bits
#else
  return second;
#endif
}

/// `sqrt(x)` within 3e-7 of it, for x >= 0.
HWY_INLINE FloatVector square_root(FloatVector x) {
  const hn::ScalableTag<float> d;
  const FloatVector kept = hn::Max(x, hn::Set(d, 1e-30F));
  const FloatVector half = hn::Mul(hn::Set(d, 0.5F), kept);
  const FloatVector three_halves = hn::Set(d, 1.5F);
  FloatVector root = hn::ApproximateReciprocalSqrt(kept);
  root = hn::Mul(root, hn::NegMulAdd(hn::Mul(half, root), root, three_halves));
#if HWY_ARCH_ARM
  root = hn::Mul(root, hn::NegMulAdd(hn::Mul(half, root), root, three_halves));
#endif
  return hn::Mul(x, root);
}

/// Angle of (x, y) in [-pi, pi] by the ratio of the shorter to the longer of both; fitted to
/// `atan(x)/x` in x^2 over [0, 1].
HWY_INLINE FloatVector arc_tangent(FloatVector y, FloatVector x, FloatVector ratio) {
  const hn::ScalableTag<float> d;
  const FloatVector first = hn::Mul(ratio,
                                    polynomial(hn::Mul(ratio, ratio),
                                               0.999999986F,
                                               -0.333330938F,
                                               0.199930511F,
                                               -0.142071093F,
                                               0.106545801F,
                                               -0.0753346524F,
                                               0.0430368448F,
                                               -0.0162814388F,
                                               0.00290315663F));
  const FloatVector quarter =
      hn::IfThenElse(hn::Gt(hn::Abs(y), hn::Abs(x)),
                     hn::Sub(hn::Set(d, 0.5F * std::numbers::pi_v<float>), first),
                     first);
  const FloatVector half = hn::IfThenElse(
      hn::Lt(x, hn::Zero(d)), hn::Sub(hn::Set(d, std::numbers::pi_v<float>), quarter), quarter);
  return hn::CopySign(half, y);
}

/// Angle of (x, y) in [-pi, pi], within 3e-7 rad; of (0, 0) it is 0.
HWY_INLINE FloatVector arc_tangent(FloatVector y, FloatVector x) {
  const hn::ScalableTag<float> d;
  const FloatVector across = hn::Abs(y);
  const FloatVector along = hn::Abs(x);
  const FloatVector longer =
      hn::Max(hn::Max(across, along), hn::Set(d, std::numeric_limits<float>::min()));
  return arc_tangent(y, x, hn::Div(hn::Min(across, along), longer));
}

/// The same within 6e-7 rad, and faster.
HWY_INLINE FloatVector fast_arc_tangent(FloatVector y, FloatVector x) {
  const hn::ScalableTag<float> d;
  const FloatVector across = hn::Abs(y);
  const FloatVector along = hn::Abs(x);
  const FloatVector longer = hn::Max(hn::Max(across, along), hn::Set(d, 1e-30F));
  return arc_tangent(y, x, hn::Mul(hn::Min(across, along), reciprocal(longer)));
}

}  // namespace skyhalo::HWY_NAMESPACE

HWY_AFTER_NAMESPACE();

#endif

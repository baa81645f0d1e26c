#include "skyhalo/stereo/sgm/depth_edge.hpp"

#include <algorithm>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "skyhalo/stereo/sgm/depth_edge.cpp"
#include <hwy/foreach_target.h>
// It must come after what includes this file again for each target.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();

namespace skyhalo::sgm::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Floats = hn::ScalableTag<float>;
using Ints = hn::RebindToSigned<Floats>;
using Shorts = hn::Rebind<std::int16_t, Floats>;
using Short = hn::Vec<Shorts>;

/// The difference to a neighbour; 0 if that has no disparity (-1).
HWY_INLINE Short step_to(const std::int16_t* neighbour, Short here) {
  const Shorts shorts;
  const auto there = hn::LoadU(shorts, neighbour);
  const auto difference = hn::Sub(hn::Max(there, here), hn::Min(there, here));
  return hn::IfThenZeroElse(hn::Lt(there, hn::Zero(shorts)), difference);
}

void edges_row(const Plane<std::int16_t>& disparity_64, int v, int step_64, float* disparity_px) {
  const Floats floats;
  const Ints ints;
  const Shorts shorts;
  const std::int16_t* const at = disparity_64.row(v);
  const std::int16_t* const above = disparity_64.row(v - 1);
  const std::int16_t* const below = disparity_64.row(v + 1);
  const int most = step_64 > 0 ? std::min(step_64, 32767) : 32767;
  const auto allowed = hn::Set(shorts, static_cast<std::int16_t>(most));
  const auto none = hn::Set(floats, std::numeric_limits<float>::quiet_NaN());
  const int width = disparity_64.width();
  for (int u = 0; u < width; u += static_cast<int>(hn::Lanes(floats))) {
    const auto here = hn::LoadU(shorts, at + u);
    const auto across = hn::Max(step_to(at + u - 1, here), step_to(at + u + 1, here));
    const auto down = hn::Max(step_to(above + u, here), step_to(below + u, here));
    const auto edge = hn::Gt(hn::Max(across, down), allowed);
    const auto kept = hn::PromoteTo(ints, hn::IfThenElse(edge, hn::Set(shorts, -1), here));
    const auto room =
        hn::Sub(hn::Set(ints, 64 * (width - 1 - u)), hn::ShiftLeft<6>(hn::Iota(ints, 0)));
    const auto good = hn::AndNot(hn::Gt(kept, room), hn::Gt(kept, hn::Set(ints, -1)));
    const auto px = hn::Mul(hn::ConvertTo(floats, kept), hn::Set(floats, 1.0F / 64.0F));
    hn::StoreU(hn::IfThenElse(hn::RebindMask(floats, good), px, none), floats, disparity_px + u);
  }
}

}  // namespace skyhalo::sgm::HWY_NAMESPACE

HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace skyhalo::sgm {

HWY_EXPORT(edges_row);

void drop_depth_edges(const Plane<std::int16_t>& disparity_64,
                      int v,
                      int step_64,
                      float* disparity_px) noexcept {
  HWY_DYNAMIC_DISPATCH(edges_row)(disparity_64, v, step_64, disparity_px);
}

}  // namespace skyhalo::sgm
#endif

// The cells that the rays of a scan end in. Compiled again for each instruction set: include it
// after Highway's foreach_target.h.
#if defined(SKYHALO_MARK_ENDS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef SKYHALO_MARK_ENDS_INL
#undef SKYHALO_MARK_ENDS_INL
#else
#define SKYHALO_MARK_ENDS_INL
#endif

#include <hwy/highway.h>

#include <array>
#include <vector>

#include "skyhalo/map/float_vectors-inl.hpp"
#include "skyhalo/map/scan_patches.hpp"

HWY_BEFORE_NAMESPACE();

namespace skyhalo::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Where ends are along one axis of a region, from its first cell on; and whether it holds them.
HWY_INLINE Whole ends_along(const std::int32_t* ends, int to_region) {
  const Integers di;
  return hn::Add(hn::LoadU(di, ends), hn::Set(di, to_region));
}

HWY_INLINE hn::Mask<Integers> holds(Whole place, int size) {
  const Integers di;
  return hn::AndNot(hn::Lt(place, hn::Zero(di)), hn::Lt(place, hn::Set(di, size)));
}

/// Whether the ray of each direction ends in the same cell as that of another one, `before` places
/// before it, and says no more there: then it needs no mark of its own.
HWY_INLINE hn::Mask<Integers> is_said(const RayEnds& ends, std::size_t at, std::size_t before) {
  const Integers di;
  const auto same = [&](const std::vector<std::int32_t>& values) HWY_ATTR {
    return hn::Eq(hn::LoadU(di, values.data() + at), hn::LoadU(di, values.data() + at - before));
  };
  const auto more =
      hn::Gt(hn::LoadU(di, ends.peak.data() + at), hn::LoadU(di, ends.peak.data() + at - before));
  return hn::AndNot(more, hn::And(same(ends.x), hn::And(same(ends.y), same(ends.z))));
}

void mark_ends(const ScanPatches& patches,
               const Eigen::Vector3i& from,
               const CellBox& region,
               EndMarks& marks) {
  const Integers di;
  const RayEnds& ends = patches.ends;
  const auto cols = static_cast<std::size_t>(patches.cols);
  const std::size_t end = cols + static_cast<std::size_t>(patches.rows) * cols;
  const Eigen::Vector3i to_region = from - region.min;
  const Eigen::Vector3i size = region.size();
  const Eigen::Vector3i to_bricks = region.min - first_cell(marks.region().min);
  const Eigen::Vector3i bricks = marks.region().size();
  HWY_ALIGN std::array<std::int32_t, hn::MaxLanes(di)> slots{};
  HWY_ALIGN std::array<std::int32_t, hn::MaxLanes(di)> said{};  // place and increment
  for (std::size_t i = cols; i < end; i += hn::Lanes(di)) {
    const Whole x = ends_along(ends.x.data() + i, to_region.x());
    const Whole y = ends_along(ends.y.data() + i, to_region.y());
    const Whole z = ends_along(ends.z.data() + i, to_region.z());
    const Whole peak = hn::LoadU(di, ends.peak.data() + i);
    const auto inside =
        hn::And(holds(x, size.x()), hn::And(holds(y, size.y()), holds(z, size.z())));
    const auto is_new = hn::Not(hn::Or(is_said(ends, i, 1), is_said(ends, i, cols)));
    const auto says = hn::And(hn::Gt(peak, hn::Zero(di)), hn::FirstN(di, end - i));
    const auto counts = hn::And(hn::And(inside, is_new), says);
    const Whole cell_x = hn::Add(x, hn::Set(di, to_bricks.x()));
    const Whole cell_y = hn::Add(y, hn::Set(di, to_bricks.y()));
    const Whole cell_z = hn::Add(z, hn::Set(di, to_bricks.z()));
    const Whole slot_y = hn::Add(hn::Mul(hn::ShiftRight<3>(cell_x), hn::Set(di, bricks.y())),
                                 hn::ShiftRight<3>(cell_y));
    const Whole slot = hn::Add(hn::Mul(slot_y, hn::Set(di, bricks.z())), hn::ShiftRight<3>(cell_z));
    const Whole mask = hn::Set(di, 7);
    const Whole place =
        hn::Or(hn::ShiftLeft<6>(hn::And(cell_x, mask)),
               hn::Or(hn::ShiftLeft<3>(hn::And(cell_y, mask)), hn::And(cell_z, mask)));
    // Not by `CompressStore`, which some processors with AVX-512 take hundreds of cycles for.
    hn::Store(hn::Compress(slot, counts), di, slots.data());
    hn::Store(hn::Compress(hn::Or(hn::ShiftLeft<16>(place), peak), counts), di, said.data());
    const std::size_t kept = hn::CountTrue(di, counts);
    for (std::size_t k = 0; k < kept; ++k) {
      marks.mark(slots[k],
                 static_cast<std::int16_t>(said[k] >> 16),
                 static_cast<Increment>(said[k] & 0xFFFF));
    }
  }
}

}  // namespace skyhalo::HWY_NAMESPACE

HWY_AFTER_NAMESPACE();

#endif

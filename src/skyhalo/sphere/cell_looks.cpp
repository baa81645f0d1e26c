#include "skyhalo/sphere/cell_looks.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "skyhalo/sphere/cell_looks.cpp"
#include <hwy/foreach_target.h>
// It must come after what includes this file again for each target.
#include <hwy/highway.h>

#include <algorithm>

HWY_BEFORE_NAMESPACE();

namespace skyhalo::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

void add_runs(const float* seen_m, std::span<const LookRun> runs, std::span<CellLooks> looks) {
  const hn::ScalableTag<float> d;
  const auto lanes = static_cast<int>(hn::Lanes(d));
  const auto zero = hn::Zero(d);
  const auto infinite = hn::Set(d, std::numeric_limits<float>::infinity());
  for (const LookRun& run : runs) {
    auto nearest = infinite;
    int valid = 0;
    for (int u = run.begin; u < run.end; u += lanes) {
      // The buffer goes on beyond the run.
      const auto seen = hn::LoadU(d, seen_m + u);
      const auto inside = hn::FirstN(d, static_cast<std::size_t>(run.end - u));
      const auto counts = hn::And(hn::Ge(seen, zero), inside);
      valid += static_cast<int>(hn::CountTrue(d, counts));
      nearest = hn::Min(nearest, hn::IfThenElse(counts, seen, infinite));
    }
    CellLooks& cell = looks[static_cast<std::size_t>(run.cell)];
    cell.valid += valid;
    cell.invalid += run.end - run.begin - valid;
    cell.nearest_m = std::min(cell.nearest_m, hn::GetLane(hn::MinOfLanes(d, nearest)));
  }
}

}  // namespace skyhalo::HWY_NAMESPACE

HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace skyhalo {

HWY_EXPORT(add_runs);

void add_row(const float* seen_m,
             std::span<const LookRun> runs,
             std::span<CellLooks> looks) noexcept {
  HWY_DYNAMIC_DISPATCH(add_runs)(seen_m, runs, looks);
}

}  // namespace skyhalo
#endif

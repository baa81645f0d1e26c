// What cells get, by the patches of their directions. Compiled again for each instruction set:
// include it after Highway's foreach_target.h.
#if defined(SKYHALO_LOOK_UP_CELLS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef SKYHALO_LOOK_UP_CELLS_INL
#undef SKYHALO_LOOK_UP_CELLS_INL
#else
#define SKYHALO_LOOK_UP_CELLS_INL
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <array>

#include "skyhalo/map/float_vectors-inl.hpp"
#include "skyhalo/map/locate_cells-inl.hpp"
#include "skyhalo/map/sweep_brick.hpp"

HWY_BEFORE_NAMESPACE();

namespace skyhalo::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// One number of the records of four that begin at `first`.
HWY_INLINE Vector gathered(const float* first, Whole record) {
  return hn::GatherIndex(Floats(), first, hn::ShiftLeft<2>(record));
}

HWY_INLINE Whole gathered(const std::int32_t* first, Whole record) {
  return hn::GatherIndex(Integers(), first, hn::ShiftLeft<2>(record));
}

static_assert(sizeof(PatchPlace) == 16 && sizeof(PatchModel) == 16);

/// Cells of an eighth, in whole vectors.
struct Part {
  std::size_t first = 0;
  std::size_t count = 0;
};

/// How far cells are behind their patches (in front: below 0); `row`, `col`: from the directions'
/// middles.
HWY_INLINE Vector behind_patch(Vector range_m, Vector row, Vector col, Vector z_m, Whole tilts) {
  const Floats d;
  const Vector tilt_phi = hn::ConvertTo(d, hn::ShiftRight<16>(tilts));
  const Vector tilt_theta = hn::ConvertTo(d, hn::ShiftRight<16>(hn::ShiftLeft<16>(tilts)));
  const Vector change = hn::MulAdd(tilt_phi, col, hn::Mul(tilt_theta, row));
  const Vector tilted = hn::MulAdd(change, set(1.0F / 65536.0F), set(1.0F));
  return hn::Sub(range_m, hn::Mul(z_m, reciprocal(tilted)));
}

/// Columns of the increment table from the measurement's own one to the cells'. `half_m`: half the
/// patches' thickness; `before`, `behind`: columns per metre.
HWY_INLINE Whole column_of(Vector behind_m, Vector half_m, Vector before, Vector behind) {
  const Floats d;
  const Vector size_m = hn::Max(hn::Sub(hn::Abs(behind_m), half_m), hn::Zero(d));
  const auto is_before = hn::Lt(behind_m, hn::Zero(d));
  const Vector per_m = hn::IfThenElse(is_before, before, behind);
  const Vector steps = hn::Min(hn::Mul(size_m, per_m), set(IncrementTable::kCentre));
  return hn::NearestInt(hn::IfThenElse(is_before, hn::Neg(steps), steps));
}

HWY_INLINE void store_increments(Whole increments, std::size_t i, Places& places) {
  const hn::Rebind<std::int16_t, Floats> small;
  hn::StoreU(hn::DemoteTo(small, increments), small, places.increment.data() + i);
}

/// Takes increments from their places in the table, for the cells that ask; where a direction has
/// no range, the place could be anywhere.
HWY_INLINE Whole from_table(const IncrementTable& table,
                            hn::Mask<Integers> asks,
                            Whole place,
                            Whole otherwise) {
  const Integers di;
  const Whole said = hn::GatherIndex(di, table.increments(), hn::IfThenElseZero(asks, place));
  return hn::IfThenElse(asks, said, otherwise);
}

/// Looks one vector of cells up, each in its direction's records.
HWY_INLINE void look_up(const SweepInput& input, std::size_t i, Places& places) {
  const Floats d;
  const Integers di;
  const PatchPlace& place = input.patches.places[0];
  const PatchModel& model = input.patches.models[0];
  const Whole at =
      hn::Add(hn::Mul(hn::LoadU(di, places.row_index.data() + i), hn::Set(di, input.patches.cols)),
              hn::LoadU(di, places.col_index.data() + i));
  const Vector range_m = hn::LoadU(d, places.range_m.data() + i);
  const auto crossed = hn::Lt(range_m, gathered(&place.near_m, at));
  const auto decided = hn::Or(crossed, hn::Ge(range_m, gathered(&place.far_m, at)));
  Whole increment =
      hn::IfThenElseZero(hn::RebindMask(di, crossed), hn::Set(di, input.table.crossed()));
  if (!hn::AllTrue(d, decided)) {
    const Vector behind_m = behind_patch(range_m,
                                         hn::LoadU(d, places.row.data() + i),
                                         hn::LoadU(d, places.col.data() + i),
                                         gathered(&place.z_m, at),
                                         gathered(&place.tilts, at));
    const Whole in_table = hn::Add(gathered(&model.in_table, at),
                                   column_of(behind_m,
                                             gathered(&model.half_m, at),
                                             gathered(&model.steps_before, at),
                                             gathered(&model.steps_behind, at)));
    increment = from_table(input.table, hn::RebindMask(di, hn::Not(decided)), in_table, increment);
  }
  store_increments(increment, i, places);
}

/// Finds the first direction of each row of a window.
HWY_INLINE void find_rows(const ScanPatches& patches, Window& window) {
  for (std::size_t k = 0; k < window.first.size(); ++k) {
    const int below = std::min(window.row + static_cast<int>(k), patches.rows - 1);
    window.first[k] = static_cast<std::size_t>(below) * static_cast<std::size_t>(patches.cols) +
                      static_cast<std::size_t>(window.col);
  }
}

/// Finds the window of a part's directions. Returns whether they are all in it.
HWY_INLINE bool find_window(const ScanPatches& patches,
                            const Part& part,
                            const Places& places,
                            Window& window) {
  const Integers di;
  Whole row = hn::LoadU(di, places.row_index.data() + part.first);
  Whole col = hn::LoadU(di, places.col_index.data() + part.first);
  Whole row_end = row;
  Whole col_end = col;
  for (std::size_t i = hn::Lanes(di); i < part.count; i += hn::Lanes(di)) {
    const Whole next_row = hn::LoadU(di, places.row_index.data() + part.first + i);
    const Whole next_col = hn::LoadU(di, places.col_index.data() + part.first + i);
    row = hn::Min(row, next_row);
    col = hn::Min(col, next_col);
    row_end = hn::Max(row_end, next_row);
    col_end = hn::Max(col_end, next_col);
  }
  const Whole first_row = hn::MinOfLanes(di, row);
  const Whole first_col = hn::MinOfLanes(di, col);
  window.row = hn::GetLane(first_row);
  window.col = hn::GetLane(first_col);
  find_rows(patches, window);
  const Whole most = hn::Max(hn::Sub(row_end, first_row), hn::Sub(col_end, first_col));
  return hn::AllTrue(di, hn::Lt(most, hn::Set(di, kWindowEdge)));
}

/// One number of a window's records of four: of four rows, column by column.
template <int kNumber>
HWY_INLINE Vector of_window(const float* records, const Window& window) {
  const Floats d;
#if HWY_TARGET == HWY_SCALAR
  return hn::LoadU(d, records + 4 * window.first[0] + kNumber);  // never asked: see `locate_eighth`
#else
  const Vector row0 = hn::LoadU(d, records + 4 * window.first[0]);
  const Vector row1 = hn::LoadU(d, records + 4 * window.first[1]);
  const Vector row2 = hn::LoadU(d, records + 4 * window.first[2]);
  const Vector row3 = hn::LoadU(d, records + 4 * window.first[3]);
  if constexpr (kNumber < 2) {
    const Vector even = hn::InterleaveLower(d, row0, row2);
    const Vector odd = hn::InterleaveLower(d, row1, row3);
    return kNumber == 0 ? hn::InterleaveLower(d, even, odd) : hn::InterleaveUpper(d, even, odd);
  } else {
    const Vector even = hn::InterleaveUpper(d, row0, row2);
    const Vector odd = hn::InterleaveUpper(d, row1, row3);
    return kNumber == 2 ? hn::InterleaveLower(d, even, odd) : hn::InterleaveUpper(d, even, odd);
  }
#endif
}

/// Looks a part's cells up in the records of one window, which fit into vectors: much faster than
/// one by one.
HWY_INLINE void look_up_in(const SweepInput& input,
                           const Window& window,
                           const Part& part,
                           Places& places) {
  const Floats d;
  const Integers di;
  const float* const place = &input.patches.places[0].near_m;
  const float* const model = &input.patches.models[0].half_m;
  const Vector near_m = of_window<0>(place, window);
  const Vector far_m = of_window<1>(place, window);
  const Vector z_m = of_window<2>(place, window);
  const Vector tilts = of_window<3>(place, window);
  const Vector half_m = of_window<0>(model, window);
  const Vector before = of_window<1>(model, window);
  const Vector behind = of_window<2>(model, window);
  const Vector in_table = of_window<3>(model, window);
  const Whole corner = hn::Set(di, 4 * window.col + window.row);
  for (std::size_t i = part.first; i < part.first + part.count; i += hn::Lanes(d)) {
    const Whole lane = hn::Sub(hn::Add(hn::ShiftLeft<2>(hn::LoadU(di, places.col_index.data() + i)),
                                       hn::LoadU(di, places.row_index.data() + i)),
                               corner);
    const auto at = hn::IndicesFromVec(d, lane);
    const Vector range_m = hn::LoadU(d, places.range_m.data() + i);
    const auto crossed = hn::Lt(range_m, hn::TableLookupLanes(near_m, at));
    const auto decided = hn::Or(crossed, hn::Ge(range_m, hn::TableLookupLanes(far_m, at)));
    Whole increment =
        hn::IfThenElseZero(hn::RebindMask(di, crossed), hn::Set(di, input.table.crossed()));
    if (!hn::AllTrue(d, decided)) {
      const Vector behind_m = behind_patch(range_m,
                                           hn::LoadU(d, places.row.data() + i),
                                           hn::LoadU(d, places.col.data() + i),
                                           hn::TableLookupLanes(z_m, at),
                                           hn::BitCast(di, hn::TableLookupLanes(tilts, at)));
      const Whole in_all = hn::Add(hn::BitCast(di, hn::TableLookupLanes(in_table, at)),
                                   column_of(behind_m,
                                             hn::TableLookupLanes(half_m, at),
                                             hn::TableLookupLanes(before, at),
                                             hn::TableLookupLanes(behind, at)));
      increment = from_table(input.table, hn::RebindMask(di, hn::Not(decided)), in_all, increment);
    }
    store_increments(increment, i, places);
  }
}

}  // namespace skyhalo::HWY_NAMESPACE

HWY_AFTER_NAMESPACE();

#endif

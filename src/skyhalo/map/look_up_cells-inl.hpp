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

#if HWY_TARGET != HWY_SCALAR
/// One number of records of four, by four vectors of whole records: of the first records of all
/// four vectors, then of the second ones.
template <int kNumber>
HWY_INLINE Vector transposed(Vector row0, Vector row1, Vector row2, Vector row3) {
  const Floats d;
  if constexpr (kNumber < 2) {
    const Vector even = hn::InterleaveLower(d, row0, row2);
    const Vector odd = hn::InterleaveLower(d, row1, row3);
    return kNumber == 0 ? hn::InterleaveLower(d, even, odd) : hn::InterleaveUpper(d, even, odd);
  } else {
    const Vector even = hn::InterleaveUpper(d, row0, row2);
    const Vector odd = hn::InterleaveUpper(d, row1, row3);
    return kNumber == 2 ? hn::InterleaveLower(d, even, odd) : hn::InterleaveUpper(d, even, odd);
  }
}
#endif

#if HWY_HAVE_SCALABLE || HWY_TARGET == HWY_SCALAR
/// One number of each of some records of four.
template <int kNumber>
HWY_INLINE Vector of_records(const float* records, const std::int32_t* which) {
  const Whole at = hn::ShiftLeft<2>(hn::LoadU(Integers(), which));
  return hn::GatherIndex(Floats(), records + kNumber, at);
}
#else
/// Every fourth of some records, one behind the other.
template <class D>
HWY_INLINE hn::Vec<D> every_fourth(D d, const float* records, const std::int32_t* which) {
  if constexpr (hn::MaxLanes(D()) > 4) {
    const hn::Half<D> half;
    return hn::Combine(d,
                       every_fourth(half, records, which + hn::MaxLanes(half)),
                       every_fourth(half, records, which));
  } else {
    return hn::LoadU(d, records + std::ptrdiff_t{4} * *which);
  }
}

/// One number of each of some records of four. Asked for all four, the records are loaded as a
/// whole and once, which takes a part of the time of gathering number by number.
template <int kNumber>
HWY_INLINE Vector of_records(const float* records, const std::int32_t* which) {
  const Floats d;
  return transposed<kNumber>(every_fourth(d, records, which),
                             every_fourth(d, records, which + 1),
                             every_fourth(d, records, which + 2),
                             every_fourth(d, records, which + 3));
}
#endif

static_assert(sizeof(PatchPlace) == 16 && sizeof(PatchModel) == 16);

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
  const float* const place = &input.patches.places[0].near_m;
  const float* const model = &input.patches.models[0].half_m;
  HWY_ALIGN std::array<std::int32_t, hn::MaxLanes(di)> which;  // NOLINT(*-member-init)
  const Whole first_of_row =
      hn::Mul(hn::LoadU(di, places.row_index.data() + i), hn::Set(di, input.patches.cols));
  hn::Store(hn::Add(first_of_row, hn::LoadU(di, places.col_index.data() + i)), di, which.data());
  const Vector near_m = of_records<0>(place, which.data());
  const Vector far_m = of_records<1>(place, which.data());
  const Vector z_m = of_records<2>(place, which.data());
  const Vector tilts = of_records<3>(place, which.data());
  const Vector range_m = hn::LoadU(d, places.range_m.data() + i);
  const auto crossed = hn::Lt(range_m, near_m);
  const auto decided = hn::Or(crossed, hn::Ge(range_m, far_m));
  Whole increment =
      hn::IfThenElseZero(hn::RebindMask(di, crossed), hn::Set(di, input.table.crossed()));
  if (!hn::AllTrue(d, decided)) {
    const Vector behind_m = behind_patch(range_m,
                                         hn::LoadU(d, places.row.data() + i),
                                         hn::LoadU(d, places.col.data() + i),
                                         z_m,
                                         hn::BitCast(di, tilts));
    const Whole in_table = hn::Add(hn::BitCast(di, of_records<3>(model, which.data())),
                                   column_of(behind_m,
                                             of_records<0>(model, which.data()),
                                             of_records<1>(model, which.data()),
                                             of_records<2>(model, which.data())));
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

/// Finds the window of the directions of an eighth's cells, if there is one that holds them all.
HWY_INLINE void find_window(const ScanPatches& patches, Places& places) {
  const Integers di;
  Whole row = hn::LoadU(di, places.row_index.data());
  Whole col = hn::LoadU(di, places.col_index.data());
  Whole row_end = row;
  Whole col_end = col;
  for (std::size_t i = hn::Lanes(di); i < kEighthCells; i += hn::Lanes(di)) {
    const Whole next_row = hn::LoadU(di, places.row_index.data() + i);
    const Whole next_col = hn::LoadU(di, places.col_index.data() + i);
    row = hn::Min(row, next_row);
    col = hn::Min(col, next_col);
    row_end = hn::Max(row_end, next_row);
    col_end = hn::Max(col_end, next_col);
  }
  const Whole first_row = hn::MinOfLanes(di, row);
  const Whole first_col = hn::MinOfLanes(di, col);
  const Whole most = hn::Max(hn::Sub(row_end, first_row), hn::Sub(col_end, first_col));
  places.in_window = hn::AllTrue(di, hn::Lt(most, hn::Set(di, kWindowEdge)));
  places.window.row = hn::GetLane(first_row);
  places.window.col = hn::GetLane(first_col);
  find_rows(patches, places.window);
}

/// One number of a window's records of four: of four rows, column by column.
template <int kNumber>
HWY_INLINE Vector of_window(const float* records, const Window& window) {
  const Floats d;
#if HWY_TARGET == HWY_SCALAR
  return hn::LoadU(d, records + 4 * window.first[0] + kNumber);  // never asked: see `locate_eighth`
#else
  return transposed<kNumber>(hn::LoadU(d, records + 4 * window.first[0]),
                             hn::LoadU(d, records + 4 * window.first[1]),
                             hn::LoadU(d, records + 4 * window.first[2]),
                             hn::LoadU(d, records + 4 * window.first[3]));
#endif
}

/// Looks an eighth's cells up in the records of their window, which fit into vectors: faster than
/// each in its own.
HWY_INLINE void look_up_in_window(const SweepInput& input, Places& places) {
  const Floats d;
  const Integers di;
  const float* const place = &input.patches.places[0].near_m;
  const float* const model = &input.patches.models[0].half_m;
  const Window& window = places.window;
  const Vector near_m = of_window<0>(place, window);
  const Vector far_m = of_window<1>(place, window);
  const Vector z_m = of_window<2>(place, window);
  const Vector tilts = of_window<3>(place, window);
  const Vector half_m = of_window<0>(model, window);
  const Vector before = of_window<1>(model, window);
  const Vector behind = of_window<2>(model, window);
  const Vector in_table = of_window<3>(model, window);
  const Whole corner = hn::Set(di, 4 * window.col + window.row);
  for (std::size_t i = 0; i < kEighthCells; i += hn::Lanes(d)) {
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

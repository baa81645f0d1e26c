#include "skyhalo/map/update_cells.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "skyhalo/map/update_cells.cpp"
#include <hwy/foreach_target.h>
// It must come after what includes this file again for each target.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();

namespace skyhalo::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Row = hn::CappedTag<LogOdds, kBrickEdge>;
using Vector = hn::Vec<Row>;

/// Cells of a brick that lies in one piece.
using Cells = hn::CappedTag<LogOdds, kBrickCells>;

template <class D, class V = hn::Vec<D>>
HWY_INLINE V updated_cells(D d, V cells, V increments, V limit) {
  const V unknown = hn::Set(d, kUnknown);
  const V before = hn::IfThenZeroElse(hn::Eq(cells, unknown), cells);
  const V sum = hn::SaturatedAdd(before, increments);
  const V kept = hn::Max(hn::Min(sum, limit), hn::Neg(limit));
  return hn::IfThenElse(hn::Eq(increments, hn::Zero(d)), cells, kept);
}

/// Adds increments to cells that follow each other, of which the first is at `place` of its brick:
/// one vector. Returns what has changed.
template <class D, class Increments>
HWY_INLINE hn::Vec<D> add_to_cells(
    D d, LogOdds* cells, int place, const Increments& increments, hn::Vec<D> limits) {
  const hn::Vec<D> before = hn::LoadU(d, cells);
  const hn::Vec<D> after = updated_cells(d, before, increments.load(d, place), limits);
  hn::StoreU(after, d, cells);
  return hn::Xor(before, after);
}

/// Adds increments to a part of a row, by vectors of at most half its length and cell by cell.
template <class Increments>
HWY_INLINE bool add_to_part(const LogOddsRow& row, const Increments& increments, int limit) {
  const hn::CappedTag<LogOdds, kBrickEdge / 2> d;
  const auto lanes = static_cast<int>(hn::Lanes(d));
  bool changed = false;
  int i = 0;
  for (; i + lanes <= row.count; i += lanes) {
    const auto changes = add_to_cells(
        d, row.cells + i, row.place + i, increments, hn::Set(d, static_cast<LogOdds>(limit)));
    changed = changed || !hn::AllTrue(d, hn::Eq(changes, hn::Zero(d)));
  }
  for (; i < row.count; ++i) {
    const Increment increment = increments.one(row.place + i);
    if (increment != 0) {
      const LogOdds after = updated(row.cells[i], increment, limit);
      changed = changed || after != row.cells[i];
      row.cells[i] = after;
    }
  }
  return changed;
}

/// Adds what `increments` give; a row that is not whole goes by parts.
template <class Increments>
HWY_INLINE bool add_to_rows(std::span<const LogOddsRow> rows,
                            const Increments& increments,
                            int limit) {
  const Row d;
  const auto lanes = static_cast<int>(hn::Lanes(d));
  const Vector limits = hn::Set(d, static_cast<LogOdds>(limit));
  Vector changes = hn::Zero(d);
  bool changed = false;
  for (const LogOddsRow& row : rows) {
    if (row.count < kBrickEdge) {
      changed = add_to_part(row, increments, limit) || changed;
      continue;
    }
    for (int i = 0; i < kBrickEdge; i += lanes) {
      changes = hn::Or(changes, add_to_cells(d, row.cells + i, row.place + i, increments, limits));
    }
  }
  return changed || !hn::AllTrue(d, hn::Eq(changes, hn::Zero(d)));
}

/// The cells of a block from a place of its brick on.
HWY_INLINE LogOdds* cells_at(const LogOddsBlock& block, int place) {
  return block.cells + (place >> (2 * kBrickBits)) * block.x_step +
         ((place >> kBrickBits) & (kBrickEdge - 1)) * block.y_step + (place & (kBrickEdge - 1));
}

#if HWY_HAVE_SCALABLE || HWY_TARGET == HWY_SCALAR
using Rows = Row;

HWY_INLINE Vector load_rows(Row d, const LogOddsBlock& block, int place) {
  return hn::LoadU(d, cells_at(block, place));
}

HWY_INLINE void store_rows(Vector row, Row d, const LogOddsBlock& block, int place) {
  hn::StoreU(row, d, cells_at(block, place));
}
#else
/// Some rows of a brick, one behind the other, up to as many as there are in a slice.
using Rows = hn::CappedTag<LogOdds, std::size_t{kBrickEdge} * kBrickEdge>;

/// Loads the rows of a block that begin at a place of its brick.
template <class D>
HWY_INLINE hn::Vec<D> load_rows(D d, const LogOddsBlock& block, int place) {
  if constexpr (hn::MaxLanes(D()) > kBrickEdge) {
    const hn::Half<D> half;
    const int next = place + static_cast<int>(hn::MaxLanes(half));
    return hn::Combine(d, load_rows(half, block, next), load_rows(half, block, place));
  } else {
    return hn::LoadU(d, cells_at(block, place));
  }
}

/// Stores them again.
template <class D>
HWY_INLINE void store_rows(hn::Vec<D> rows, D d, const LogOddsBlock& block, int place) {
  if constexpr (hn::MaxLanes(D()) > kBrickEdge) {
    const hn::Half<D> half;
    const int next = place + static_cast<int>(hn::MaxLanes(half));
    store_rows(hn::LowerHalf(half, rows), half, block, place);
    store_rows(hn::UpperHalf(half, rows), half, block, next);
  } else {
    hn::StoreU(rows, d, cells_at(block, place));
  }
}
#endif

/// A whole brick.
template <class Increments>
HWY_INLINE bool add_to_block(const LogOddsBlock& block, const Increments& increments, int limit) {
  if (block.y_step == kBrickEdge && block.x_step == std::ptrdiff_t{kBrickEdge} * kBrickEdge) {
    const Cells d;
    const auto limits = hn::Set(d, static_cast<LogOdds>(limit));
    auto changes = hn::Zero(d);
    for (int i = 0; i < kBrickCells; i += static_cast<int>(hn::Lanes(d))) {
      changes = hn::Or(changes, add_to_cells(d, block.cells + i, i, increments, limits));
    }
    return !hn::AllTrue(d, hn::Eq(changes, hn::Zero(d)));
  }
  const Rows d;
  const auto limits = hn::Set(d, static_cast<LogOdds>(limit));
  auto changes = hn::Zero(d);
  const auto lanes = static_cast<int>(hn::Lanes(d));
  for (int i = 0; i < kBrickCells; i += lanes) {
    const auto before = load_rows(d, block, i);
    const auto after = updated_cells(d, before, increments.load(d, i), limits);
    changes = hn::Or(changes, hn::Xor(before, after));
    store_rows(after, d, block, i);
  }
  return !hn::AllTrue(d, hn::Eq(changes, hn::Zero(d)));
}

struct EachIncrement {
  const LogOdds* increments;

  template <class D>
  [[nodiscard]] HWY_INLINE hn::Vec<D> load(D d, int place) const {
    return hn::LoadU(d, increments + place);
  }

  [[nodiscard]] HWY_INLINE Increment one(int place) const { return increments[place]; }
};

struct OneIncrement {
  Increment increment;

  template <class D>
  [[nodiscard]] HWY_INLINE hn::Vec<D> load(D d, int /*place*/) const {
    return hn::Set(d, increment);
  }

  [[nodiscard]] HWY_INLINE Increment one(int /*place*/) const { return increment; }
};

bool add_each(std::span<const LogOddsRow> rows, const LogOdds* increments, int limit) {
  return add_to_rows(rows, EachIncrement{increments}, limit);
}

bool add_one(std::span<const LogOddsRow> rows, Increment increment, int limit) {
  return add_to_rows(rows, OneIncrement{increment}, limit);
}

bool add_each_to_block(const LogOddsBlock& block, const LogOdds* increments, int limit) {
  return add_to_block(block, EachIncrement{increments}, limit);
}

bool add_one_to_block(const LogOddsBlock& block, Increment increment, int limit) {
  return add_to_block(block, OneIncrement{increment}, limit);
}

}  // namespace skyhalo::HWY_NAMESPACE

HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace skyhalo {

HWY_EXPORT(add_each);
HWY_EXPORT(add_one);
HWY_EXPORT(add_each_to_block);
HWY_EXPORT(add_one_to_block);

bool add_increments(std::span<const LogOddsRow> rows,
                    const BrickCells& increments,
                    int limit) noexcept {
  return HWY_DYNAMIC_DISPATCH(add_each)(rows, increments.cells.data(), limit);
}

bool add_increment(std::span<const LogOddsRow> rows, Increment increment, int limit) noexcept {
  return HWY_DYNAMIC_DISPATCH(add_one)(rows, increment, limit);
}

bool add_increments(const LogOddsBlock& block, const BrickCells& increments, int limit) noexcept {
  return HWY_DYNAMIC_DISPATCH(add_each_to_block)(block, increments.cells.data(), limit);
}

bool add_increment(const LogOddsBlock& block, Increment increment, int limit) noexcept {
  return HWY_DYNAMIC_DISPATCH(add_one_to_block)(block, increment, limit);
}

}  // namespace skyhalo
#endif

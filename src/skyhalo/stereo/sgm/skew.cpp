#include "skyhalo/stereo/sgm/skew.hpp"

#include <utility>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "skyhalo/stereo/sgm/skew.cpp"
#include <hwy/foreach_target.h>
// It must come after what includes this file again for each target.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();

namespace skyhalo::sgm::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// A tile of 16 x 16 bytes: row i of the one is column i of the other.
struct Tile {
  const std::uint8_t* from;
  std::ptrdiff_t from_stride;
  std::uint8_t* to;
  std::ptrdiff_t to_stride;
};

#if HWY_TARGET == HWY_SCALAR

/// As many lanes as are there.
constexpr int kTileLanes = 1;

HWY_INLINE void transpose_lanes(const Tile& tile, bool lanes_are_rows) {
  for (std::ptrdiff_t i = 0; i < 16; ++i) {
    if (lanes_are_rows) {
      tile.to[i * tile.to_stride] = tile.from[i];
    } else {
      tile.to[i] = tile.from[i * tile.from_stride];
    }
  }
}

#else

constexpr int kTileLanes = 16;

using Half = hn::FixedTag<std::uint8_t, 16>;

#if HWY_HAVE_SCALABLE

/// Interleaves rows i and i + 8 of sixteen. Four times this is the transpose.
HWY_INLINE void interleave_halves(const std::uint8_t* HWY_RESTRICT from,
                                  std::ptrdiff_t from_stride,
                                  std::uint8_t* HWY_RESTRICT to,
                                  std::ptrdiff_t to_stride) {
  const Half bytes;
  for (std::ptrdiff_t i = 0; i < 8; ++i) {
    const auto upper = hn::LoadU(bytes, from + i * from_stride);
    const auto lower = hn::LoadU(bytes, from + (i + 8) * from_stride);
    hn::StoreU(hn::InterleaveLower(bytes, upper, lower), bytes, to + 2 * i * to_stride);
    hn::StoreU(hn::InterleaveUpper(bytes, upper, lower), bytes, to + (2 * i + 1) * to_stride);
  }
}

HWY_INLINE void transpose_lanes(const Tile& tile, bool /*lanes_are_rows*/) {
  HWY_ALIGN std::uint8_t once[256];   // NOLINT(*-avoid-c-arrays): a tile for the vector unit
  HWY_ALIGN std::uint8_t twice[256];  // NOLINT(*-avoid-c-arrays)
  interleave_halves(tile.from, tile.from_stride, once, 16);
  interleave_halves(once, 16, twice, 16);
  interleave_halves(twice, 16, once, 16);
  interleave_halves(once, 16, tile.to, tile.to_stride);
}

#else

/// Sixteen rows of a tile in registers: what works on them is unrolled by its index list.
using TileRows = hn::Vec<Half>[16];  // NOLINT(*-avoid-c-arrays)

/// Interleaves rows i and i + 8 of sixteen. Four times this is the transpose.
template <std::size_t... kIndex>
HWY_INLINE void interleave(const TileRows& from,
                           TileRows& to,
                           std::index_sequence<kIndex...> /*of halves*/) {
  const Half bytes;
  ((to[2 * kIndex] = hn::InterleaveLower(bytes, from[kIndex], from[kIndex + 8]),
    to[2 * kIndex + 1] = hn::InterleaveUpper(bytes, from[kIndex], from[kIndex + 8])),
   ...);
}

template <std::size_t... kIndex>
HWY_INLINE void transpose_rows(const Tile& tile, std::index_sequence<kIndex...> /*of rows*/) {
  const Half bytes;
  const auto halves = std::make_index_sequence<8>();
  TileRows rows;
  TileRows other;
  ((rows[kIndex] =
        hn::LoadU(bytes, tile.from + static_cast<std::ptrdiff_t>(kIndex) * tile.from_stride)),
   ...);
  interleave(rows, other, halves);
  interleave(other, rows, halves);
  interleave(rows, other, halves);
  interleave(other, rows, halves);
  (hn::StoreU(rows[kIndex], bytes, tile.to + static_cast<std::ptrdiff_t>(kIndex) * tile.to_stride),
   ...);
}

HWY_INLINE void transpose_lanes(const Tile& tile, bool /*lanes_are_rows*/) {
  transpose_rows(tile, std::make_index_sequence<16>());
}

#endif

#endif

void skew_steps(const LaneRows& rows, int lanes, int step, const LaneSteps& steps) {
  for (int lane = 0; lane < lanes; lane += kTileLanes) {
    transpose_lanes({rows.first + lane * rows.stride + (step - 2 * lane),
                     rows.stride - 2,
                     steps.first + step * steps.stride + lane,
                     steps.stride},
                    true);
  }
}

void unskew_steps(const LaneSteps& steps, int lanes, int step, const LaneRows& rows) {
  for (int lane = 0; lane < lanes; lane += kTileLanes) {
    transpose_lanes({steps.first + step * steps.stride + lane,
                     steps.stride,
                     rows.first + lane * rows.stride + (step - 2 * lane),
                     rows.stride - 2},
                    false);
  }
}

}  // namespace skyhalo::sgm::HWY_NAMESPACE

HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace skyhalo::sgm {

HWY_EXPORT(skew_steps);
HWY_EXPORT(unskew_steps);

void skew(const LaneRows& rows, int lanes, int step, const LaneSteps& steps) noexcept {
  HWY_DYNAMIC_DISPATCH(skew_steps)(rows, lanes, step, steps);
}

void unskew(const LaneSteps& steps, int lanes, int step, const LaneRows& rows) noexcept {
  HWY_DYNAMIC_DISPATCH(unskew_steps)(steps, lanes, step, rows);
}

}  // namespace skyhalo::sgm
#endif

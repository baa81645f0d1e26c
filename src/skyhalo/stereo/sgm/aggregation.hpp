#pragma once

#include <cstddef>
#include <cstdint>

#include "skyhalo/stereo/sgm/aligned_buffer.hpp"
#include "skyhalo/stereo/sgm/layout.hpp"

namespace skyhalo::sgm {

/// The penalties of Hirschmueller 2008 and what judges the winner. See `SgmConfig`.
struct SweepSettings {
  std::uint8_t p1 = 0;
  std::uint8_t p2_min = 0;
  std::uint8_t p2_max = 0;
  std::uint8_t uniqueness_percent = 0;
};

/// What both sweeps read, in the skewed order of `SkewLayout`.
struct SweepInput {
  SkewLayout layout;
  const std::uint8_t* right_census = nullptr;  ///< [steps][3][lanes]
  const std::uint8_t* left_census = nullptr;   ///< [steps + disparities][3][lanes]
  const std::uint8_t* guide = nullptr;  ///< [steps][guide_stride]: lanes from the row above's on
  std::ptrdiff_t guide_stride = 0;
  const std::uint8_t* limit = nullptr;   ///< [steps][lanes]: the last d within the other image
  const std::uint8_t* inside = nullptr;  ///< [steps][lanes]: 255 for pixels of the image, else 0
};

/// The best match of each pixel of the left image among those of one sweep.
struct LeftWinners {
  std::uint8_t* cost = nullptr;       ///< [steps + disparities][lanes], 255 before the sweep
  std::uint8_t* disparity = nullptr;  ///< likewise
};

/// What both sweeps write.
struct SweepOutput {
  std::uint8_t* half_sum = nullptr;   ///< [steps][disparities][lanes]: the sum of four paths
  std::uint8_t* disparity = nullptr;  ///< [steps][lanes]: the winner
  std::uint8_t* offset = nullptr;     ///< [steps][lanes]: its offset in 1/64 px, or `kNoOffset`
  std::uint8_t* repeated = nullptr;   ///< [steps][lanes]: 1 where it looks alike elsewhere, else 0
};

/// The offset of a pixel without disparity; as a signed byte it is -128.
inline constexpr std::uint8_t kNoOffset = 0x80;

/// Costs up to this say that two pixels look alike; a pixel that has so many runs of disparities
/// where it does looks repeated.
inline constexpr std::uint8_t kAlikeCost = 1;
inline constexpr std::uint8_t kRepeatedRuns = 3;

/// More than any path's cost, and still a byte when P1 is added.
inline constexpr std::uint8_t kMostCost = 200;

/// Disparities that go through all stages of a step together, so that what one stage leaves is
/// still in the nearest cache for the next.
inline constexpr int kBlockDisparities = 32;

/// Disparities [first, last).
struct Block {
  std::ptrdiff_t first = 0;
  std::ptrdiff_t last = 0;
};

/// Costs outside the other image, where nothing can be compared: what unlike pixels have.
inline constexpr std::uint8_t kOutsideCost = 6;

/// The path costs that a sweep has reached, and what the lanes at the strips' edges hand over.
class SweepState {
 public:
  SweepState() = default;
  explicit SweepState(const SkewLayout& layout);

  /// Back to the start of a sweep.
  void clear() noexcept;

  /// Path k's slot of two, three or one steps ago: rows of lanes by disparity, then `kMostCost`.
  [[nodiscard]] std::uint8_t* rows(int slot) noexcept { return rows_.data() + kPad + slot * slot_; }

  /// The least cost of each lane of that slot.
  [[nodiscard]] std::uint8_t* least(int slot) noexcept {
    return least_.data() + kPad + slot * least_stride_;
  }

  /// What lane and row at a strip's edge left in that column, for one of three paths: costs by
  /// disparity, then `kMostCost`, then their least.
  [[nodiscard]] std::uint8_t* edge(int column, int path) noexcept {
    return edges_.data() + 1 + (static_cast<std::ptrdiff_t>(column) * 3 + path) * edge_size();
  }

  /// Rows of lanes for the block of disparities at work.
  [[nodiscard]] std::uint8_t* costs() noexcept { return costs_.data(); }

  [[nodiscard]] std::uint8_t* sums() noexcept { return sums_.data(); }

  /// Vectors that go on from block to block: five for each path, ten for the winners.
  [[nodiscard]] std::uint8_t* carry() noexcept { return carry_.data(); }

 private:
  static constexpr std::ptrdiff_t kPad = AlignedBuffer<std::uint8_t>::kAlignment;
  static constexpr int kSlots = 7;

  [[nodiscard]] std::ptrdiff_t edge_size() const noexcept { return disparities_ + 2; }

  std::ptrdiff_t disparities_ = 0;
  std::ptrdiff_t slot_ = 0;
  std::ptrdiff_t least_stride_ = 0;
  int lanes_ = 0;
  AlignedBuffer<std::uint8_t> rows_;
  AlignedBuffer<std::uint8_t> least_;
  AlignedBuffer<std::uint8_t> edges_;
  AlignedBuffer<std::uint8_t> costs_;
  AlignedBuffer<std::uint8_t> sums_;
  AlignedBuffer<std::uint8_t> carry_;
};

/// Everything that a sweep works on.
struct Sweep {
  SweepInput in;
  SweepOutput out;
  LeftWinners left;
  SweepSettings settings;
  SweepState* state = nullptr;
};

/// Lanes of the vectors of this machine's instruction set.
int vector_lanes() noexcept;

// Costs summed along four paths each (Hirschmueller 2008, section 2.3): the forward sweep comes
// from the left, from above and from both diagonals above, through steps [first, last) upwards; the
// backward sweep comes the opposite ways, downwards. `store` keeps the sums of four in `half_sum`;
// `finish` adds them to what the other sweep stored there, and picks the winners.
void store_forward(const Sweep& sweep, int first, int last) noexcept;
void store_backward(const Sweep& sweep, int first, int last) noexcept;
void finish_forward(const Sweep& sweep, int first, int last) noexcept;
void finish_backward(const Sweep& sweep, int first, int last) noexcept;

}  // namespace skyhalo::sgm

#pragma once

#include <cstdint>
#include <limits>
#include <new>
#include <vector>

#include "skyhalo/map/brick.hpp"

namespace skyhalo {

/// What the ends of rays say of their cells, brick by brick; few per brick. Keeps its memory from
/// scan to scan.
class EndMarks {
 public:
  /// Forgets all marks and takes up to `most` of another region of bricks.
  void begin(const CellBox& bricks, std::size_t most) {
    for (std::size_t i = 0; i < marked_count_; ++i) {
      slots_[static_cast<std::size_t>(marked_[i])] = {};
    }
    marked_count_ = 0;
    count_ = 0;
    if (marks_.size() < most) {
      marks_.resize(most);
      marked_.resize(most);
    }
    region_ = bricks;
    const std::int64_t count = bricks.cell_count();
    if (count > std::numeric_limits<std::int32_t>::max()) {
      throw std::bad_alloc();
    }
    if (slots_.size() < static_cast<std::size_t>(count)) {
      slots_.resize(static_cast<std::size_t>(count));
    }
  }

  /// Room for regions of this many bricks.
  void reserve(std::size_t bricks) { slots_.reserve(bricks); }

  [[nodiscard]] const CellBox& region() const noexcept { return region_; }

  /// Marks the cell at a place of a brick. `slot`: of the brick, `place`: of the cell, see
  /// `place_in_brick`.
  void mark(std::int32_t slot, std::int16_t place, Increment increment) {
    Slot& marked = slots_[static_cast<std::size_t>(slot)];
    if (marked.newest == kNone) {
      marked_[marked_count_++] = slot;
    }
    marks_[count_] = {marked.newest, place, increment};
    marked.newest = static_cast<std::int32_t>(count_++);
    marked.eighths |= 1U << eighth_at(static_cast<std::size_t>(place));
  }

  /// The slot of a brick of the region: z fastest, then y, then x.
  [[nodiscard]] std::int32_t slot_of(const Eigen::Vector3i& brick) const noexcept {
    const Eigen::Vector3i place = brick - region_.min;
    const Eigen::Vector3i size = region_.size();
    return (place.x() * size.y() + place.y()) * size.z() + place.z();
  }

  [[nodiscard]] bool has(const Eigen::Vector3i& brick) const noexcept {
    return slots_[static_cast<std::size_t>(slot_of(brick))].newest != kNone;
  }

  /// The eighths of a brick that hold marks: a bit each, see `eighth_at`.
  [[nodiscard]] std::uint32_t eighths(const Eigen::Vector3i& brick) const noexcept {
    return slots_[static_cast<std::size_t>(slot_of(brick))].eighths;
  }

  /// Takes a brick's marks into its increments where they are the `stronger`. Returns whether there
  /// are any.
  bool merge(const Eigen::Vector3i& brick, BrickCells& increments) const noexcept {
    const std::int32_t newest = slots_[static_cast<std::size_t>(slot_of(brick))].newest;
    for (std::int32_t at = newest; at != kNone;) {
      const Mark& mark = marks_[static_cast<std::size_t>(at)];
      Increment& merged = increments.cells[static_cast<std::size_t>(mark.place)];
      merged = stronger(merged, mark.increment);
      at = mark.next;
    }
    return newest != kNone;
  }

 private:
  static constexpr std::int32_t kNone = -1;

  struct Mark {
    std::int32_t next = kNone;  // older one of the same brick
    std::int16_t place = 0;
    Increment increment = 0;
  };

  struct Slot {
    std::int32_t newest = kNone;
    std::uint32_t eighths = 0;
  };

  CellBox region_;
  std::vector<Slot> slots_;           // of the region's bricks
  std::vector<std::int32_t> marked_;  // those with marks
  std::vector<Mark> marks_;
  std::size_t count_ = 0;
  std::size_t marked_count_ = 0;
};

}  // namespace skyhalo

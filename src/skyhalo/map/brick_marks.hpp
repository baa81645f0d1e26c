#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "skyhalo/map/brick.hpp"

namespace skyhalo {

/// Increments of one scan, collected before they change a map: the `stronger` of all that is said
/// of a cell. Bricks of a region, found by a table of it; keeps its memory from scan to scan.
class BrickMarks {
 public:
  /// Forgets all marks and takes those of another region of cells.
  void begin(const CellBox& cells) {
    for (const Eigen::Vector3i& brick : bricks_) {
      slots_[slot_of(brick)] = kNone;
    }
    bricks_.clear();
    region_ = bricks_touching(cells);
    const auto count = static_cast<std::size_t>(region_.cell_count());
    if (slots_.size() < count) {
      slots_.resize(count, kNone);
    }
  }

  /// Room for the marks of this many bricks in regions of as many.
  void reserve(std::size_t bricks) {
    slots_.reserve(bricks);
    bricks_.reserve(bricks);
    cells_.reserve(bricks);
  }

  /// Marks a cell of the region.
  void mark(const Eigen::Vector3i& cell, Increment increment) {
    std::int32_t& slot = slots_[slot_of(brick_of(cell))];
    if (slot == kNone) {
      slot = add(brick_of(cell));
    }
    Increment& marked = cells_[static_cast<std::size_t>(slot)].cells[place_in_brick(cell)];
    marked = stronger(marked, increment);
  }

  /// The marks of a brick of the region; null without any.
  [[nodiscard]] const BrickCells* find(const Eigen::Vector3i& brick) const noexcept {
    const std::int32_t slot = slots_[slot_of(brick)];
    return slot == kNone ? nullptr : &cells_[static_cast<std::size_t>(slot)];
  }

  /// The bricks with marks, in the order of their first ones.
  [[nodiscard]] std::span<const Eigen::Vector3i> bricks() const noexcept { return bricks_; }

 private:
  static constexpr std::int32_t kNone = -1;

  [[nodiscard]] std::size_t slot_of(const Eigen::Vector3i& brick) const noexcept {
    const Eigen::Vector3i place = brick - region_.min;
    const Eigen::Vector3i size = region_.size();
    return (static_cast<std::size_t>(place.x()) * static_cast<std::size_t>(size.y()) +
            static_cast<std::size_t>(place.y())) *
               static_cast<std::size_t>(size.z()) +
           static_cast<std::size_t>(place.z());
  }

  std::int32_t add(const Eigen::Vector3i& brick) {
    if (cells_.size() == bricks_.size()) {
      cells_.emplace_back();
    }
    cells_[bricks_.size()].cells.fill(0);
    bricks_.push_back(brick);
    return static_cast<std::int32_t>(bricks_.size() - 1);
  }

  CellBox region_;
  std::vector<std::int32_t> slots_;
  std::vector<Eigen::Vector3i> bricks_;
  std::vector<BrickCells> cells_;
};

}  // namespace skyhalo

#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "skyhalo/map/brick.hpp"
#include "skyhalo/map/decay.hpp"
#include "skyhalo/map/update_cells.hpp"

namespace skyhalo {

/// The cells of a box of a lattice in one piece of memory, addressed as a ring along each axis: the
/// box can move, and only the cells that enter are touched. What the dense and the local map have
/// in common.
class CellWindow {
 public:
  [[nodiscard]] const VoxelLattice& lattice() const noexcept { return lattice_; }

  /// The cells that there are.
  [[nodiscard]] const CellBox& bounds() const noexcept { return bounds_; }

  /// One cell; unknown outside the bounds.
  [[nodiscard]] LogOdds at(const Eigen::Vector3i& cell) const noexcept {
    return bounds_.holds(cell) ? cells_[place_of(cell)] : kUnknown;
  }

  /// Sets a cell that lies within the bounds.
  void set(const Eigen::Vector3i& cell, LogOdds value) noexcept;

  /// Copies a brick's cells, in the order of `BrickCells`; unknown outside the bounds.
  void copy_brick(const Eigen::Vector3i& brick, BrickCells& cells) const noexcept;

  /// Makes this map, a copy of another as it once was, the same as the other again; takes only the
  /// bricks that have changed since. Does not allocate.
  void catch_up(const CellWindow& other) noexcept;

  /// Memory of the cells (bytes).
  [[nodiscard]] std::size_t memory_bytes() const noexcept {
    return cells_.size() * sizeof(LogOdds);
  }

  // --- changes by scans, as of every map (see `ScanIntegrator`)

  /// Counts the changes: each scan, shift and decay is one tick.
  [[nodiscard]] std::uint64_t tick() const noexcept { return tick_; }

  void begin_change() noexcept { ++tick_; }

  /// Nothing to make room for: all cells are there.
  void prepare(const Eigen::Vector3i& /*brick*/, bool /*whole*/) noexcept {}

  /// Adds a scan's increments to a brick; values stay within +-limit, cells outside the bounds are
  /// left out. Different bricks may be changed by different threads.
  void change(const Eigen::Vector3i& brick, const BrickCells& increments, int limit) noexcept;
  void change_whole(const Eigen::Vector3i& brick, Increment increment, int limit) noexcept;

  /// Brings all cells nearer to unknown; a tick of its own.
  void decay(const DecayStep& step) noexcept;

  /// The tick of a brick's last change; 0 for one outside the bounds, and for one not changed yet.
  [[nodiscard]] std::uint64_t changed_at(const Eigen::Vector3i& brick) const noexcept;

 protected:
  /// All cells of `bounds` unknown. `room`: cells that memory has along each axis, at least as many
  /// as the bounds.
  CellWindow(const VoxelLattice& lattice, const CellBox& bounds, const Eigen::Vector3i& room);

  /// Moves the box; cells that enter it are unknown. Touches no other cell.
  void move_to(const CellBox& bounds) noexcept;

  [[nodiscard]] std::span<const LogOdds> stored() const noexcept { return cells_; }

  [[nodiscard]] std::span<LogOdds> stored() noexcept { return cells_; }

 private:
  [[nodiscard]] std::size_t wrapped(int cell, int axis) const noexcept;
  [[nodiscard]] std::size_t place_of(const Eigen::Vector3i& cell) const noexcept;
  [[nodiscard]] std::size_t stamp_of(const Eigen::Vector3i& brick) const noexcept;
  void forget(const CellBox& cells) noexcept;
  void mark(const CellBox& bricks) noexcept;

  [[nodiscard]] std::optional<LogOddsBlock> block_of(const Eigen::Vector3i& brick) noexcept;
  template <class Add>
  void change_cells(const Eigen::Vector3i& brick, const Add& add) noexcept;

  /// Calls `visit(first cell's place in memory, its place in the brick, how many)` for each row of
  /// a brick that lies within the bounds.
  template <class Visit>
  void for_each_row(const Eigen::Vector3i& brick, Visit&& visit) const noexcept;

  VoxelLattice lattice_;
  CellBox bounds_;
  Eigen::Vector3i room_;
  Eigen::Vector3i ring_start_;  // a multiple of the room, at most a room before the bounds
  Eigen::Vector3i brick_room_;
  std::vector<LogOdds> cells_;
  std::vector<std::uint64_t> changed_at_;  // by brick, a ring too
  std::uint64_t tick_ = 0;
};

}  // namespace skyhalo

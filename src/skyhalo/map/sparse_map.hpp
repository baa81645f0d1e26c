#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "skyhalo/map/brick.hpp"
#include "skyhalo/map/decay.hpp"

namespace skyhalo {

/// A map without bounds: bricks of 8 x 8 x 8 cells, found by a hash of their place. A brick whose
/// cells are all equal, such as seen free space, is one number. Not for use by two threads at once
/// while one of them changes it.
class SparseMap {
 public:
  /// Nothing known. `lattice.voxel_m` > 0.
  explicit SparseMap(const VoxelLattice& lattice);
  SparseMap(const SparseMap& other);
  SparseMap& operator=(const SparseMap& other);
  SparseMap(SparseMap&&) noexcept = default;
  SparseMap& operator=(SparseMap&&) noexcept = default;
  ~SparseMap() = default;

  [[nodiscard]] const VoxelLattice& lattice() const noexcept { return lattice_; }

  /// All cells that can be numbered.
  [[nodiscard]] CellBox bounds() const noexcept { return whole_lattice(); }

  /// The cells of all bricks that are held; empty when none is.
  [[nodiscard]] CellBox known_bounds() const noexcept;

  /// One cell; unknown where no brick is held.
  [[nodiscard]] LogOdds at(const Eigen::Vector3i& cell) const noexcept;

  void set(const Eigen::Vector3i& cell, LogOdds value);

  // --- bricks

  [[nodiscard]] std::size_t brick_count() const noexcept { return bricks_.size(); }

  /// The places of all bricks held, sorted by x, then y, then z.
  [[nodiscard]] std::vector<Eigen::Vector3i> bricks() const;

  [[nodiscard]] bool holds_brick(const Eigen::Vector3i& brick) const noexcept;

  /// The value that all cells of a brick share, if they are stored as one; unknown for a brick that
  /// is not held.
  [[nodiscard]] std::optional<LogOdds> uniform(const Eigen::Vector3i& brick) const noexcept;

  /// Copies a brick's cells, in the order of `BrickCells`.
  void copy_brick(const Eigen::Vector3i& brick, BrickCells& cells) const noexcept;

  /// Replaces a brick; one of equal cells is stored as one number, one without a known cell not at
  /// all.
  void set_brick(const Eigen::Vector3i& brick, const BrickCells& cells);
  void set_uniform(const Eigen::Vector3i& brick, LogOdds value);

  /// Forgets a brick.
  void erase_brick(const Eigen::Vector3i& brick) noexcept;

  void clear() noexcept;

  /// Makes this map, a copy of another as it once was, the same as the other again; takes only the
  /// bricks that have changed since, or all once the other has forgotten some.
  void catch_up(const SparseMap& other);

  /// What the bricks held need (bytes).
  [[nodiscard]] std::size_t held_bytes() const noexcept;

  /// The same for so many bricks, `mixed` of them with cells of their own.
  [[nodiscard]] static std::size_t held_bytes(std::size_t bricks, std::size_t mixed) noexcept;

  /// Memory that is taken (bytes); what forgotten bricks had stays, for others.
  [[nodiscard]] std::size_t memory_bytes() const noexcept;

  // --- changes by scans, as of every map (see `ScanIntegrator`)

  /// Counts the changes: each scan, decay and change from outside is at least one tick.
  [[nodiscard]] std::uint64_t tick() const noexcept { return tick_; }

  void begin_change() noexcept { ++tick_; }

  /// Makes room for a brick's cells, or for its number alone, before `change` or `change_whole`.
  void prepare(const Eigen::Vector3i& brick, bool whole);

  /// Adds a scan's increments to a brick that was prepared; values stay within +-limit. Different
  /// bricks may be changed by different threads.
  void change(const Eigen::Vector3i& brick, const BrickCells& increments, int limit) noexcept;
  void change_whole(const Eigen::Vector3i& brick, Increment increment, int limit) noexcept;

  /// Brings all cells nearer to unknown, a tick of its own; bricks of which nothing is known any
  /// more are forgotten.
  void decay(const DecayStep& step);

  /// The tick of a brick's last change; 0 for one that is not held.
  [[nodiscard]] std::uint64_t changed_at(const Eigen::Vector3i& brick) const noexcept;

  /// The tick at which a brick was last forgotten.
  [[nodiscard]] std::uint64_t forgot_at() const noexcept { return forgot_at_; }

 private:
  struct Brick {
    Eigen::Vector3i place = Eigen::Vector3i::Zero();
    std::int32_t cells = -1;  // in `pages_`, or -1: all have the value `uniform`
    LogOdds uniform = kUnknown;
    std::uint64_t changed_at = 0;
  };

  static constexpr std::int32_t kEmpty = -1;
  static constexpr std::size_t kPageBricks = 64;
  using Page = std::unique_ptr<std::array<BrickCells, kPageBricks>>;

  [[nodiscard]] std::size_t slot_of(const Eigen::Vector3i& brick) const noexcept;
  [[nodiscard]] const Brick* find(const Eigen::Vector3i& brick) const noexcept;
  [[nodiscard]] Brick* find(const Eigen::Vector3i& brick) noexcept;
  Brick& obtain(const Eigen::Vector3i& brick);
  void give_cells(Brick& brick);
  void take_cells(Brick& brick) noexcept;
  void remove(std::size_t slot) noexcept;
  void grow();

  [[nodiscard]] BrickCells& cells(std::int32_t index) noexcept;
  [[nodiscard]] const BrickCells& cells(std::int32_t index) const noexcept;

  VoxelLattice lattice_;
  std::vector<std::int32_t> slots_;  // hash table, a power of two long: index of a brick, or kEmpty
  std::vector<Brick> bricks_;        // densely, in order of arrival
  std::vector<Page> pages_;          // cells of bricks that are not uniform
  std::vector<std::int32_t> unused_cells_;
  std::uint64_t tick_ = 0;
  std::uint64_t forgot_at_ = 0;
};

}  // namespace skyhalo

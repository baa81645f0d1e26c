#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "skyhalo/geometry/pose.hpp"
#include "skyhalo/map/end_marks.hpp"
#include "skyhalo/map/patch_pyramid.hpp"
#include "skyhalo/map/sweep_brick.hpp"

namespace skyhalo {

/// A brick that a scan says something of.
struct SweepJob {
  Eigen::Vector3i brick;
  bool whole;  ///< all its cells are crossed
};

/// What a scan says of the cells of a map by the grid sweep: every cell looks up its direction, and
/// cubes of space that are crossed as a whole, or not seen at all, are found coarse to fine. Keeps
/// its memory from scan to scan.
class ScanSweep {
 public:
  /// Bricks are worked out in batches of so many.
  static constexpr std::size_t kBatch = 256;

  /// `cell_size_term`: see `IntegrationConfig`.
  explicit ScanSweep(bool cell_size_term);

  /// Room for scans of maps that have no more bricks than this.
  void reserve(std::size_t bricks);

  /// Finds the bricks of `bounds` that a scan says something of. The pose must be one that
  /// `can_enter`; the table is read until all is worked out. Throws `std::bad_alloc` when there are
  /// too many.
  void begin(const RangeScan& scan,
             const IncrementTable& table,
             const Pose& T_map_body,
             const VoxelLattice& lattice,
             const CellBox& bounds);

  /// Those bricks.
  [[nodiscard]] std::span<const SweepJob> jobs() const noexcept { return jobs_; }

  /// Works out what some jobs get, of one batch and up to `kGroup`; several threads may.
  static constexpr std::size_t kGroup = 8;
  void compute(std::size_t begin, std::size_t end) noexcept;

  /// Whether anything is said of a job's brick; of the batch that was worked out last.
  [[nodiscard]] bool says(std::size_t job) const noexcept { return says_[job % kBatch] != 0; }

  /// What its cells get, if it is not crossed as a whole; of the same batch.
  [[nodiscard]] const BrickCells& increments(std::size_t job) const noexcept {
    return computed_[job % kBatch];
  }

 private:
  void find_jobs();
  void split(const CellBox& cubes, int edge);
  void judge(std::span<const Eigen::Vector3i> cubes, int edge);
  [[nodiscard]] Eigen::Vector3f seen_from_body(const Eigen::Vector3d& point_m) const noexcept;

  // By size, as the offsets have room for vectors.
  BrickOffsets offsets_;
  Pose T_map_body_ = Pose::Identity();
  const IncrementTable* table_ = nullptr;  // of the scan at hand
  std::vector<SweepJob> jobs_;
  std::vector<BrickCells> computed_;  // of the batch at hand
  std::vector<std::uint8_t> says_;    // whether its bricks change
  VoxelLattice lattice_;
  EndMarks ends_;
  ScanPatches patches_;
  PatchPyramid pyramid_;
  CellBox bricks_;  // that may change
  bool cell_size_term_;
};

}  // namespace skyhalo

#pragma once

#include <optional>
#include <span>
#include <vector>

#include "skyhalo/sphere/cell_points.hpp"
#include "skyhalo/sphere/depth_rule.hpp"
#include "skyhalo/sphere/grid_geometry.hpp"
#include "skyhalo/sphere/pair_view.hpp"

namespace skyhalo {

/// One pair's view as nearest distances by direction (thesis 5.3). Each cell knows the points in it
/// (running sums, never a list) and the pixels that looked its way. Adding is deterministic: the
/// same points in the same order give the same bits.
class SphericalGrid {
 public:
  /// Throws `Error` (input) when the rule is outside its domain.
  explicit SphericalGrid(const GridGeometry& geometry, const DepthRule& rule = {});

  [[nodiscard]] const GridGeometry& geometry() const noexcept { return geometry_; }

  [[nodiscard]] const DepthRule& rule() const noexcept { return rule_; }

  /// Forgets all points and looks; keeps the memory.
  void clear() noexcept;

  /// Adds a point (m, body). One that is outside the bounds, at the origin or not finite is
  /// ignored.
  void add(const Eigen::Vector3d& p_body_m) noexcept;

  /// Adds what `points`, cells of the same grid and rule, hold in these cells, and how pixels
  /// looked. Different cells may be merged by different threads.
  void merge(const CellPoints& points, std::span<const CellLooks> looks, CellSpan cells) noexcept;

  /// Works out `depths_m` and `free_to_m` of what was added, after which a stitch can take them;
  /// the view tells how far the looks reach. `accumulate` ends with it.
  void settle(PairView& view) noexcept;

  /// Statistics of a cell; none for a cell without points.
  [[nodiscard]] std::optional<CellStatistics> statistics(GridCell cell) const noexcept;

  /// Depth of a cell (m along the ray) by the grid's rule (thesis eq. 5.4), never below the
  /// smallest measurable range. None without points, or with too few for the rule.
  [[nodiscard]] std::optional<double> depth_m(GridCell cell) const noexcept;

  /// The pixels that looked into a cell's direction.
  [[nodiscard]] const CellLooks& looks(GridCell cell) const noexcept {
    return looks_[static_cast<std::size_t>(geometry_.offset_of(cell))];
  }

  /// Of each cell, row-major, as of the last `settle`: its depth (m; NaN for none), and the range
  /// (m, from the body origin) up to which it was seen to be free (0 where it was not seen), at
  /// most the depth.
  [[nodiscard]] std::span<const float> depths_m() const noexcept { return depths_m_; }

  [[nodiscard]] std::span<const float> free_to_m() const noexcept { return free_to_m_; }

  /// Number of cells that have points.
  [[nodiscard]] int occupied_cell_count() const noexcept;

 private:
  GridGeometry geometry_;
  DepthRule rule_;
  CellPoints points_;
  std::vector<CellLooks> looks_;
  std::vector<float> depths_m_;
  std::vector<float> free_to_m_;
};

}  // namespace skyhalo

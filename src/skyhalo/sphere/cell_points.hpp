#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "skyhalo/sphere/depth_rule.hpp"
#include "skyhalo/sphere/keep_nearest.hpp"

namespace skyhalo {

/// What the points of one cell amount to; distances from the body origin.
struct CellStatistics {
  int count = 0;
  double mean_m = 0.0;   ///< mu
  double sigma_m = 0.0;  ///< population standard deviation
  double min_m = 0.0;
};

/// Cells [begin, end) by their place in memory.
struct CellSpan {
  int begin;
  int end;
};

/// What the cells of a grid remember of the points in them: running sums, and besides only what the
/// depth rule needs (the few smallest ranges, or how many lie in each class of ranges). No cell
/// keeps its points. Cells are addressed by their place in memory; ranges are finite and above 0.
class CellPoints {
 public:
  CellPoints(int cell_count, const DepthRule& rule);

  /// Forgets all points; keeps the memory.
  void clear() noexcept;

  /// Adds a point.
  void add(int cell, double range_m) noexcept;

  /// Adds a row of points: the cell of each, or the number of cells for none, and its range (m).
  /// The order in which it does so is fixed, but not the row's. Both arrays can be read up to the
  /// next multiple of `kRowPadding`, where the cells are none.
  void add(std::span<const std::int32_t> cells, std::span<const float> ranges_m) noexcept;

  /// Adds the points of `other`, of equal size and rule, in these cells. Sums grow by the other's
  /// sums: the order of merging is part of the result's last bits.
  void merge(const CellPoints& other, CellSpan cells) noexcept;

  [[nodiscard]] int count(int cell) const noexcept {
    return sums_[static_cast<std::size_t>(cell)].count;
  }

  /// Statistics of a cell; none for a cell without points.
  [[nodiscard]] std::optional<CellStatistics> statistics(int cell) const noexcept;

  /// Depth of a cell (m along the ray) by the rule; NaN where there is none.
  [[nodiscard]] double depth_m(int cell) const noexcept;

 private:
  struct Sums {
    double sum_m = 0.0;
    double sum_m2 = 0.0;
    double min_m = std::numeric_limits<double>::infinity();
    int count = 0;
  };

  // Classes of a sixteenth of an octave, from 1/16 m to 256 m; the outermost hold what lies beyond.
  static constexpr int kClassesPerOctave = 16;  // 2^4: the first bits of a mantissa
  static constexpr int kFirstOctave = -4;
  static constexpr int kClasses = 12 * kClassesPerOctave;

  static int class_of(float range_m) noexcept;
  static double class_begin_m(int range_class) noexcept;

  void sum_up(std::size_t cell, double range_m) noexcept;
  void remember(std::size_t cell, double range_m) noexcept;
  void insert(std::size_t cell, float range_m) noexcept;
  [[nodiscard]] double nearest_m(std::size_t cell) const noexcept;
  [[nodiscard]] double quantile_m(std::size_t cell) const noexcept;

  DepthRule rule_;
  std::vector<Sums> sums_;  // and one more, for points that are in no cell
  // Empty unless the rule asks: the smallest ranges, rising, and the last of them that counts.
  std::vector<NearestRanges> nearest_m_;
  std::vector<float> farthest_kept_m_;
  std::vector<std::array<std::int32_t, kClasses>> in_class_;  // empty unless the rule asks
};

}  // namespace skyhalo

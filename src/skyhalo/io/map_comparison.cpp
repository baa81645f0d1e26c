#include "skyhalo/io/map_comparison.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iterator>
#include <vector>

#include "skyhalo/io/map_lattice.hpp"

namespace skyhalo {
namespace {

/// Sums for Pearson's correlation. Log odds are whole numbers: what is summed up of a brick is
/// exact.
struct Moments {
  double count = 0.0;
  double a = 0.0;
  double b = 0.0;
  double aa = 0.0;
  double bb = 0.0;
  double ab = 0.0;

  void add(LogOdds x, LogOdds y, double times) noexcept {
    count += times;
    a += times * x;
    b += times * y;
    aa += times * x * x;
    bb += times * y * y;
    ab += times * x * y;
  }

  [[nodiscard]] std::optional<double> correlation() const noexcept {
    const double variance_a = count * aa - a * a;
    const double variance_b = count * bb - b * b;
    if (!(variance_a > 0.0 && variance_b > 0.0)) {
      return std::nullopt;
    }
    const double r = (count * ab - a * b) / std::sqrt(variance_a) / std::sqrt(variance_b);
    return std::clamp(r, -1.0, 1.0);
  }
};

class Comparer {
 public:
  Comparer(const SparseMap& a, const SparseMap& b, const OccupancyRule& rule)
      : a_(a), b_(b), rule_(rule) {}

  MapComparison run() {
    for (const Eigen::Vector3i& brick : places()) {
      const std::optional<LogOdds> x = a_.uniform(brick);
      const std::optional<LogOdds> y = b_.uniform(brick);
      if (x && y) {
        add(first_cell(brick), *x, *y, kBrickCells);
        continue;
      }
      a_.copy_brick(brick, a_cells_);
      b_.copy_brick(brick, b_cells_);
      for (std::size_t i = 0; i < a_cells_.cells.size(); ++i) {
        add(cell_in_brick(brick, i), a_cells_.cells[i], b_cells_.cells[i], 1);
      }
    }
    finish();
    return result_;
  }

 private:
  /// The bricks of both, sorted.
  [[nodiscard]] std::vector<Eigen::Vector3i> places() const {
    const std::vector<Eigen::Vector3i> a = a_.bricks();
    const std::vector<Eigen::Vector3i> b = b_.bricks();
    std::vector<Eigen::Vector3i> both;
    both.reserve(std::max(a.size(), b.size()));
    std::set_union(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(both), before);
    return both;
  }

  /// `count` cells, of which this is the first.
  void add(const Eigen::Vector3i& cell, LogOdds x, LogOdds y, int count) {
    if (x == kUnknown && y == kUnknown) {
      return;
    }
    result_.cells[static_cast<std::size_t>(rule_(x))][static_cast<std::size_t>(rule_(y))] +=
        static_cast<std::uint64_t>(count);
    if (x == kUnknown || y == kUnknown) {
      return;
    }
    result_.known_in_both += static_cast<std::uint64_t>(count);
    moments_.add(x, y, count);
    const int difference = std::abs(x - y);
    if (!result_.largest_difference || difference > result_.largest_difference->units) {
      result_.largest_difference = {difference, a_.lattice().center_m(cell)};
    }
  }

  void finish() {
    constexpr auto kOccupied = static_cast<std::size_t>(Occupancy::kOccupied);
    const std::uint64_t both = result_.cells[kOccupied][kOccupied];
    std::uint64_t any = 0;
    for (std::size_t i = 0; i <= kOccupied; ++i) {
      any += result_.cells[kOccupied][i] + (i < kOccupied ? result_.cells[i][kOccupied] : 0);
    }
    if (any > 0) {
      result_.occupied_intersection_over_union =
          static_cast<double>(both) / static_cast<double>(any);
    }
    result_.correlation = moments_.correlation();
  }

  const SparseMap& a_;
  const SparseMap& b_;
  OccupancyRule rule_;
  MapComparison result_;
  Moments moments_;
  BrickCells a_cells_{};
  BrickCells b_cells_{};
};

}  // namespace

MapComparison compare_maps(const SparseMap& a, const SparseMap& b, const OccupancyRule& rule) {
  const Eigen::Vector3i offset = offset_to_same_cells(a.lattice(), b.lattice());
  if (offset.isZero()) {
    return Comparer(a, b, rule).run();
  }
  return Comparer(a, moved_to(b, a.lattice(), offset), rule).run();
}

}  // namespace skyhalo

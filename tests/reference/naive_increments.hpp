#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <limits>
#include <vector>

#include "naive_scan.hpp"

namespace skyhalo::reference {

/// Settings of the integration.
struct NaiveScanSettings {
  NaiveSensorModel model;
  bool cell_size_term = true;  ///< of the sweep
};

/// What a whole scan says of each cell of a box: the increment that counts, and whether it hangs
/// on a comparison too close to expect the same outcome of single precision.
class NaiveIncrements {
 public:
  static constexpr int kMostDoubt = 25;

  explicit NaiveIncrements(const NaiveBox& box)
      : box_(box),
        most_(box.cell_count(), std::numeric_limits<int>::min()),
        least_(box.cell_count(), std::numeric_limits<int>::max()),
        vague_(box.cell_count(), false),
        close_(box.cell_count(), false) {}

  const NaiveBox& box() const { return box_; }

  /// An increment that speaks against a thing counts with a share in [0, 1]. `doubt`: by how much
  /// a table may be wrong of it; one that may have the other sign is vague.
  void add(const Eigen::Vector3i& cell, int increment, double share, int doubt) {
    if (!box_.holds(cell)) {
      return;
    }
    const std::size_t index = box_.index(cell);
    const int shared = increment < 0 ? static_cast<int>(std::lround(increment * share)) : increment;
    most_[index] = std::max(most_[index], shared);
    least_[index] = std::min(least_[index], shared);
    vague_[index] = vague_[index] || std::abs(increment) <= doubt;
  }

  void mark_close(const Eigen::Vector3i& cell) {
    if (box_.holds(cell)) {
      close_[box_.index(cell)] = true;
    }
  }

  /// True where anything is said, be it an increment of 0.
  bool says(std::size_t index) const { return least_[index] <= most_[index]; }

  /// What counts: the largest if any is above 0, else the lowest; 0 if there is none.
  int increment(std::size_t index) const {
    if (!says(index)) {
      return 0;
    }
    return most_[index] > 0 ? most_[index] : least_[index];
  }

  /// True where a comparison was close, or where the sign of a vague increment decides which of
  /// several counts.
  bool near_border(std::size_t index) const {
    return close_[index] ||
           (vague_[index] && most_[index] <= kMostDoubt && least_[index] < most_[index]);
  }

 private:
  NaiveBox box_;
  std::vector<int> most_;
  std::vector<int> least_;
  std::vector<bool> vague_;
  std::vector<bool> close_;
};

}  // namespace skyhalo::reference

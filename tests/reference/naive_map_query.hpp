#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

namespace skyhalo::reference {

/// A cell of some map: its index, the cube that it covers, and what it holds.
struct NaiveCell {
  Eigen::Vector3i index;
  Eigen::Vector3d min_m;
  double voxel_m = 1.0;
  int log_odds = 0;
  bool known = false;
};

/// What cells are together.
enum class NaiveAnswer { kNotKnown, kFree, kOccupied };

inline NaiveAnswer naive_answer(const NaiveCell& cell, int occupied_above, int free_below) {
  if (cell.known && cell.log_odds > occupied_above) {
    return NaiveAnswer::kOccupied;
  }
  return cell.known && cell.log_odds < free_below ? NaiveAnswer::kFree : NaiveAnswer::kNotKnown;
}

/// Occupied if any is, else unknown if any is (or there are none), else free.
inline NaiveAnswer naive_together(const std::vector<NaiveAnswer>& answers) {
  const auto count = [&](NaiveAnswer what) {
    return std::count(answers.begin(), answers.end(), what);
  };
  if (count(NaiveAnswer::kOccupied) > 0) {
    return NaiveAnswer::kOccupied;
  }
  return answers.empty() || count(NaiveAnswer::kNotKnown) > 0 ? NaiveAnswer::kNotKnown
                                                              : NaiveAnswer::kFree;
}

/// The stretch [enter, leave] of t for which from + t * along lies in a cell's cube; none when it
/// misses it.
struct NaiveStretch {
  double enter = -std::numeric_limits<double>::infinity();
  double leave = std::numeric_limits<double>::infinity();
};

inline std::optional<NaiveStretch> naive_stretch(const NaiveCell& cell,
                                                 const Eigen::Vector3d& from_m,
                                                 const Eigen::Vector3d& along) {
  NaiveStretch stretch;
  for (int axis = 0; axis < 3; ++axis) {
    const double low = cell.min_m[axis] - from_m[axis];
    const double high = low + cell.voxel_m;
    if (along[axis] == 0.0) {
      if (low > 0.0 || high <= 0.0) {
        return std::nullopt;
      }
      continue;
    }
    stretch.enter = std::max(stretch.enter, std::min(low / along[axis], high / along[axis]));
    stretch.leave = std::min(stretch.leave, std::max(low / along[axis], high / along[axis]));
  }
  return stretch.leave > stretch.enter ? std::optional(stretch) : std::nullopt;
}

inline double naive_distance_m(const NaiveCell& cell, const Eigen::Vector3d& point_m) {
  double sum = 0.0;
  for (int axis = 0; axis < 3; ++axis) {
    const double low = cell.min_m[axis];
    const double high = low + cell.voxel_m;
    const double nearest =
        point_m[axis] < low ? low : (point_m[axis] > high ? high : point_m[axis]);
    sum += (point_m[axis] - nearest) * (point_m[axis] - nearest);
  }
  return std::sqrt(sum);
}

/// The distance from a segment to a cell's cube: that of a point of a segment to a convex body is
/// convex along the segment, so its least value is found by thirds.
inline double naive_segment_distance_m(const NaiveCell& cell,
                                       const Eigen::Vector3d& from_m,
                                       const Eigen::Vector3d& to_m) {
  double low = 0.0;
  double high = 1.0;
  const auto distance_m = [&](double t) {
    return naive_distance_m(cell, from_m + t * (to_m - from_m));
  };
  for (int step = 0; step < 80; ++step) {
    const double a = low + (high - low) / 3.0;
    const double b = high - (high - low) / 3.0;
    (distance_m(a) < distance_m(b) ? high : low) = distance_m(a) < distance_m(b) ? b : a;
  }
  return std::min({distance_m(low), distance_m(0.0), distance_m(1.0)});
}

}  // namespace skyhalo::reference

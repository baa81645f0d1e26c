#pragma once

#include <array>
#include <map>
#include <random>

#include "skyhalo/map/sparse_map.hpp"

namespace skyhalo::testing {

/// Of the log odds (units).
inline constexpr int kLimit = 5000;

using Place = std::array<int, 3>;

inline Place place_of(const Eigen::Vector3i& cell) {
  return {cell.x(), cell.y(), cell.z()};
}

inline SparseMap empty_map() {
  return SparseMap({.origin_m = {0.5, -1.0, 2.0}, .voxel_m = 0.25});
}

/// Some bricks, on both sides of the origin and far away.
inline Eigen::Vector3i random_brick(std::mt19937& random) {
  const auto one = [&] { return static_cast<int>(random() % 4U) - 2; };
  const Eigen::Vector3i brick(one(), one(), one());
  return random() % 8U == 0 ? Eigen::Vector3i(brick * 500000) : brick;
}

inline Eigen::Vector3i random_cell(std::mt19937& random) {
  return cell_in_brick(random_brick(random), random() % kBrickCells);
}

inline LogOdds random_value(std::mt19937& random) {
  return random() % 5U == 0 ? kUnknown
                            : static_cast<LogOdds>(static_cast<int>(random() % 10001U) - 5000);
}

/// Mostly mixed cells, now and then equal ones.
inline BrickCells random_cells(std::mt19937& random) {
  BrickCells cells{};
  cells.cells.fill(random_value(random));
  if (random() % 4U != 0) {
    for (LogOdds& cell : cells.cells) {
      cell = random_value(random);
    }
  }
  return cells;
}

inline BrickCells random_increments(std::mt19937& random) {
  BrickCells increments{};
  for (Increment& increment : increments.cells) {
    increment = random() % 2U == 0
                    ? Increment{0}
                    : static_cast<Increment>(static_cast<int>(random() % 3001U) - 1500);
  }
  return increments;
}

/// The known cells one by one.
class MapOfCells {
 public:
  [[nodiscard]] LogOdds at(const Eigen::Vector3i& cell) const {
    const auto found = cells_.find(place_of(cell));
    return found == cells_.end() ? kUnknown : found->second;
  }

  void set(const Eigen::Vector3i& cell, LogOdds value) {
    if (value == kUnknown) {
      cells_.erase(place_of(cell));
    } else {
      cells_[place_of(cell)] = value;
    }
  }

  /// Replaces a brick's cells by what `value(place in the brick)` gives.
  template <class Value>
  void set_each(const Eigen::Vector3i& brick, Value&& value) {
    for (std::size_t place = 0; place < kBrickCells; ++place) {
      set(cell_in_brick(brick, place), value(place));
    }
  }

  void decay(const DecayStep& step) {
    std::map<Place, LogOdds> left;
    for (const auto& [place, value] : cells_) {
      if (decayed(value, step) != kUnknown) {
        left[place] = decayed(value, step);
      }
    }
    cells_ = left;
  }

  void clear() { cells_.clear(); }

  [[nodiscard]] const std::map<Place, LogOdds>& cells() const { return cells_; }

 private:
  std::map<Place, LogOdds> cells_;
};

/// What a scan, or a change from outside, does, to both.
inline void change_both(SparseMap& map, MapOfCells& naive, std::mt19937& random) {
  const Eigen::Vector3i brick = random_brick(random);
  const Eigen::Vector3i cell = random_cell(random);
  switch (random() % 8U) {
    case 0: {
      const LogOdds value = random_value(random);
      map.set(cell, value);
      naive.set(cell, value);
      break;
    }
    case 1: {
      const BrickCells cells = random_cells(random);
      map.set_brick(brick, cells);
      naive.set_each(brick, [&](std::size_t place) { return cells.cells[place]; });
      break;
    }
    case 2: {
      const LogOdds value = random_value(random);
      map.set_uniform(brick, value);
      naive.set_each(brick, [&](std::size_t) { return value; });
      break;
    }
    case 3:
      map.erase_brick(brick);
      naive.set_each(brick, [](std::size_t) { return kUnknown; });
      break;
    case 4: {
      const DecayStep step{.keep_occupied = 55000, .keep_free = 45000, .unknown_below = 600};
      map.begin_change();
      map.decay(step);
      naive.decay(step);
      break;
    }
    case 5: {
      const auto increment = static_cast<Increment>(static_cast<int>(random() % 2001U) - 1000);
      map.begin_change();
      map.prepare(brick, true);
      map.change_whole(brick, increment, kLimit);
      naive.set_each(brick, [&](std::size_t place) {
        const LogOdds before = naive.at(cell_in_brick(brick, place));
        return increment == 0 ? before : updated(before, increment, kLimit);
      });
      break;
    }
    default: {
      const BrickCells increments = random_increments(random);
      map.begin_change();
      map.prepare(brick, false);
      map.change(brick, increments, kLimit);
      naive.set_each(brick, [&](std::size_t place) {
        const LogOdds before = naive.at(cell_in_brick(brick, place));
        const Increment increment = increments.cells[place];
        return increment == 0 ? before : updated(before, increment, kLimit);
      });
    }
  }
}

}  // namespace skyhalo::testing

#pragma once

#include <Eigen/Core>
#include <random>

#include "skyhalo/io/map_tiles.hpp"
#include "skyhalo/map/sparse_map.hpp"

namespace skyhalo::testing {

/// Cells of 0.25 m: tiles of 16 m, bricks of 2 m.
inline VoxelLattice tiles_lattice() {
  return {.origin_m = {0.5, -0.25, 1.0}, .voxel_m = 0.25};
}

/// A drone that wanders over some tiles, always the same way from the same seed, and what it sees.
class Wanderer {
 public:
  /// What it sees changes cells by `least` to `most` units.
  Wanderer(unsigned seed, int least, int most) : random_(seed), increment_(least, most) {}

  [[nodiscard]] const Eigen::Vector3d& position_m() const { return position_m_; }

  /// Flies on by up to 6 m along each axis, home when it has strayed.
  void fly() {
    std::uniform_real_distribution<double> step_m(-6.0, 6.0);
    position_m_ += Eigen::Vector3d(step_m(random_), step_m(random_), 0.3 * step_m(random_));
    position_m_ -=
        position_m_.norm() > 60.0 ? Eigen::Vector3d(0.2 * position_m_) : Eigen::Vector3d::Zero();
  }

  /// A scan: bricks up to this far away (m, along each axis) change, the same of both maps.
  void see(double reach_m, SparseMap& one, SparseMap& other) {
    one.begin_change();
    other.begin_change();
    std::uniform_real_distribution<double> aside_m(-reach_m, reach_m);
    for (int i = 0; i < 4; ++i) {
      const Eigen::Vector3d point_m =
          position_m_ + Eigen::Vector3d(aside_m(random_), aside_m(random_), aside_m(random_));
      const Eigen::Vector3i brick = brick_of(one.lattice().cell_of(point_m));
      const bool whole = random_() % 3U == 0;
      const auto most = static_cast<Increment>(increment_.max());
      BrickCells increments{};
      for (Increment& increment : increments.cells) {
        increment =
            random_() % 8U == 0 ? static_cast<Increment>(increment_(random_)) : Increment{0};
      }
      for (SparseMap* const map : {&one, &other}) {
        map->prepare(brick, whole);
        if (whole) {
          map->change_whole(brick, most, kLimit);
        } else {
          map->change(brick, increments, kLimit);
        }
      }
    }
  }

  static constexpr int kLimit = 5000;

 private:
  std::mt19937 random_;
  std::uniform_int_distribution<int> increment_;
  Eigen::Vector3d position_m_ = Eigen::Vector3d::Zero();
};

/// A limit for which one mixed brick is too much; tiles stay as far as 10 m around.
inline MapTilesConfig no_budget() {
  return {.budget_bytes = 64, .reach_m = 10.0, .limit_units = Wanderer::kLimit};
}

}  // namespace skyhalo::testing

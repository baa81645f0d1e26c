#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cstddef>
#include <vector>

#include "naive_scan_rays.hpp"
#include "naive_scan_sweep.hpp"

namespace skyhalo::reference {

enum class NaiveMethod { kRays, kSweep };

/// What one scan, taken at T_map_body, says of each cell of a box.
inline NaiveIncrements naive_scan_integration(NaiveMethod method,
                                              const NaiveScan& scan,
                                              const Eigen::Isometry3d& T_map_body,
                                              const NaiveScanSettings& settings,
                                              const NaiveBox& box) {
  return method == NaiveMethod::kRays ? naive_ray_integration(scan, T_map_body, settings, box)
                                      : naive_sweep_integration(scan, T_map_body, settings, box);
}

/// The log odds of a box after several scans.
class NaiveScanMap {
 public:
  NaiveScanMap(const NaiveBox& box, int limit_units)
      : limit_units_(limit_units),
        units_(box.cell_count(), 0),
        known_(box.cell_count(), false),
        near_border_(box.cell_count(), false) {}

  void add(const NaiveIncrements& increments) {
    for (std::size_t i = 0; i < units_.size(); ++i) {
      const int increment = increments.increment(i);
      units_[i] = std::clamp(units_[i] + increment, -limit_units_, limit_units_);
      known_[i] = known_[i] || increment != 0;
      near_border_[i] = near_border_[i] || increments.near_border(i);
    }
  }

  int units(std::size_t index) const { return units_[index]; }

  bool known(std::size_t index) const { return known_[index]; }

  /// Of any of the scans.
  bool near_border(std::size_t index) const { return near_border_[index]; }

 private:
  int limit_units_;
  std::vector<int> units_;
  std::vector<bool> known_;
  std::vector<bool> near_border_;
};

}  // namespace skyhalo::reference

#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

#include "naive_sensor_model.hpp"

namespace skyhalo::reference {

/// Log odds are held as integers of this many units per natural log odds.
inline constexpr double kUnitsPerLogOdds = 1000.0;

/// Probabilities are kept this far from 0 and 1 before their log odds are taken.
inline constexpr double kProbabilityMargin = 1e-6;

/// Axis-aligned voxels in the map frame: the lowest corner, the edge length, voxels per axis.
struct NaiveVoxelGrid {
  std::array<double, 3> min_m = {0.0, 0.0, 0.0};
  double voxel_m = 1.0;
  std::array<int, 3> size = {0, 0, 0};
};

/// Dense log-odds map; both lists hold nx * ny * nz entries, index = (x * ny + y) * nz + z.
struct NaiveMap {
  NaiveVoxelGrid grid;
  std::vector<int> log_odds_units;
  std::vector<bool> observed;
};

/// One measurement in the map frame: origin, unit direction, measured range and its uncertainty.
struct NaiveRay {
  std::array<double, 3> origin_m = {0.0, 0.0, 0.0};
  std::array<double, 3> direction = {1.0, 0.0, 0.0};
  double z_m = 0.0;
  double delta_z_m = 0.0;
};

/// The part [enter, leave] of a half-line, in metres from its origin.
struct NaiveChord {
  double enter_m = 0.0;
  double leave_m = std::numeric_limits<double>::infinity();
};

/// A map of the given grid with log odds 0 and nothing observed.
inline NaiveMap naive_empty_map(const NaiveVoxelGrid& grid) {
  const std::size_t count = static_cast<std::size_t>(grid.size[0]) *
                            static_cast<std::size_t>(grid.size[1]) *
                            static_cast<std::size_t>(grid.size[2]);
  NaiveMap map;
  map.grid = grid;
  map.log_odds_units.assign(count, 0);
  map.observed.assign(count, false);
  return map;
}

/// Position of voxel (x, y, z) in the lists of a map, x-major: (x * ny + y) * nz + z.
inline std::size_t naive_voxel_index(const NaiveVoxelGrid& grid, const std::array<int, 3>& voxel) {
  const std::size_t x = static_cast<std::size_t>(voxel[0]);
  const std::size_t y = static_cast<std::size_t>(voxel[1]);
  const std::size_t z = static_cast<std::size_t>(voxel[2]);
  const std::size_t ny = static_cast<std::size_t>(grid.size[1]);
  const std::size_t nz = static_cast<std::size_t>(grid.size[2]);
  return (x * ny + y) * nz + z;
}

/// Slab test of the half-line origin + s * direction, s >= 0, against one voxel of the map frame;
/// metres. Nothing unless a length > 0 lies inside. A direction component of 0 takes the voxel as
/// half-open [low, high) on that axis, so a ray inside a shared face belongs to one voxel only.
inline std::optional<NaiveChord> naive_chord(const NaiveVoxelGrid& grid,
                                             const std::array<int, 3>& voxel,
                                             const NaiveRay& ray) {
  NaiveChord chord;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double low_m = grid.min_m[axis] + voxel[axis] * grid.voxel_m;
    const double high_m = grid.min_m[axis] + (voxel[axis] + 1) * grid.voxel_m;
    const double origin_m = ray.origin_m[axis];
    if (ray.direction[axis] == 0.0) {
      if (origin_m < low_m || origin_m >= high_m) {
        return std::nullopt;
      }
      continue;
    }
    const double to_low_m = (low_m - origin_m) / ray.direction[axis];
    const double to_high_m = (high_m - origin_m) / ray.direction[axis];
    chord.enter_m = std::max(chord.enter_m, std::min(to_low_m, to_high_m));
    chord.leave_m = std::min(chord.leave_m, std::max(to_low_m, to_high_m));
  }
  if (chord.leave_m - chord.enter_m > 0.0) {
    return chord;
  }
  return std::nullopt;
}

/// Share of a voxel that a chord crosses: its length in voxel edges, at most 1.
inline double naive_crossed_share(const NaiveChord& chord, double voxel_m) {
  return std::min(1.0, (chord.leave_m - chord.enter_m) / voxel_m);
}

/// Log odds log(p / (1 - p)) in integer units of 0.001, p first clamped to
/// [1e-6, 1 - 1e-6] (the increment of thesis eq. 6.2 with p0 = 0.5). Evidence for free space counts
/// only with the share of the voxel that was crossed: a ray that merely clips a corner says little
/// about the voxel being free, while an end point inside it says that it is occupied.
inline int naive_log_odds_units(double probability, double crossed_share = 1.0) {
  const double p = std::clamp(probability, kProbabilityMargin, 1.0 - kProbabilityMargin);
  const double log_odds = std::log(p / (1.0 - p));
  const double weight = log_odds < 0.0 ? crossed_share : 1.0;
  return static_cast<int>(std::lround(kUnitsPerLogOdds * weight * log_odds));
}

/// True if origin, direction, range and uncertainty are finite, the range (metres) is > 0 and the
/// uncertainty (metres) is >= 0.
inline bool naive_is_usable(const NaiveRay& ray) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (!std::isfinite(ray.origin_m[axis]) || !std::isfinite(ray.direction[axis])) {
      return false;
    }
  }
  return std::isfinite(ray.z_m) && ray.z_m > 0.0 && std::isfinite(ray.delta_z_m) &&
         ray.delta_z_m >= 0.0;
}

/// Applies one measurement to every voxel that its half-line crosses (thesis eq. 6.2, 6.4). A
/// voxel's distance is the point of its chord nearest to the measurement; free space is weighted
/// with the share of the voxel that was crossed. Up to the measurement every voxel is updated and
/// becomes observed, even if its increment is 0; beyond it only where the increment is not 0. Log
/// odds are held within +-clamp_log_odds (natural log odds, no unit). A ray that is not usable
/// changes nothing.
inline void naive_integrate(NaiveMap& map,
                            const NaiveRay& ray,
                            const NaiveSensorModel& model,
                            double clamp_log_odds) {
  if (!naive_is_usable(ray)) {
    return;
  }
  const int limit_units = static_cast<int>(std::lround(kUnitsPerLogOdds * clamp_log_odds));
  const int voxel_count = map.grid.size[0] * map.grid.size[1] * map.grid.size[2];
  for (int count = 0; count < voxel_count; ++count) {
    const int x = count / (map.grid.size[1] * map.grid.size[2]);
    const int y = (count / map.grid.size[2]) % map.grid.size[1];
    const int z = count % map.grid.size[2];
    const std::optional<NaiveChord> chord = naive_chord(map.grid, {x, y, z}, ray);
    if (!chord.has_value()) {
      continue;
    }
    const double m_m = std::clamp(ray.z_m, chord->enter_m, chord->leave_m);
    const double probability = naive_probability(model, m_m, ray.z_m, ray.delta_z_m);
    const double crossed_share = naive_crossed_share(*chord, map.grid.voxel_m);
    const int increment_units = naive_log_odds_units(probability, crossed_share);
    if (chord->enter_m > ray.z_m && increment_units == 0) {
      continue;
    }
    const std::size_t index = naive_voxel_index(map.grid, {x, y, z});
    map.log_odds_units[index] =
        std::clamp(map.log_odds_units[index] + increment_units, -limit_units, limit_units);
    map.observed[index] = true;
  }
}

/// Occupancy probability of a voxel from its log odds in units of 0.001 (thesis eq. 6.3).
inline double naive_occupancy_probability(int log_odds_units) {
  const double log_odds = log_odds_units / kUnitsPerLogOdds;
  return 1.0 - 1.0 / (1.0 + std::exp(log_odds));
}

}  // namespace skyhalo::reference

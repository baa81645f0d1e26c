#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

#include "naive_sensor_model.hpp"

namespace skyhalo::reference {

/// What was seen in each direction of the whole sphere: rows x 2 rows cells of pi / rows, row by
/// row. Row r covers theta (from straight up) from r steps on, column c covers phi (from forward to
/// the left) from c steps after -pi on. A depth is a z_m that is a number above 0, and has a
/// delta_z_m above 0; without one, free_to_m above 0 is a direction seen free.
struct NaiveScan {
  int rows = 0;
  std::vector<double> z_m;
  std::vector<double> delta_z_m;
  std::vector<double> free_to_m;

  int cols() const { return 2 * rows; }

  double step_rad() const { return std::numbers::pi / rows; }

  std::size_t index(int row, int col) const { return static_cast<std::size_t>(row * cols() + col); }

  bool has_depth(std::size_t cell) const { return z_m[cell] > 0.0 && std::isfinite(z_m[cell]); }

  bool is_free(std::size_t cell) const { return !has_depth(cell) && free_to_m[cell] > 0.0; }

  /// Angles of a cell's centre (rad).
  double theta_rad(int row) const { return (row + 0.5) * step_rad(); }

  double phi_rad(int col) const { return (col + 0.5) * step_rad() - std::numbers::pi; }
};

/// A scan of that many rows in which nothing was seen.
inline NaiveScan naive_unseen_scan(int rows) {
  const std::size_t count = 2U * static_cast<std::size_t>(rows) * static_cast<std::size_t>(rows);
  NaiveScan scan;
  scan.rows = rows;
  scan.z_m.assign(count, std::nan(""));
  scan.delta_z_m.assign(count, 0.0);
  scan.free_to_m.assign(count, 0.0);
  return scan;
}

/// Unit vector of the angles theta and phi (rad) in the body frame.
inline Eigen::Vector3d naive_direction(double theta, double phi) {
  return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
}

/// A box of cubes: cell (i, j, k) begins at origin_m + voxel_m (i, j, k), map frame; there are
/// `size` cells along each axis from `first` on.
struct NaiveBox {
  Eigen::Vector3d origin_m = Eigen::Vector3d::Zero();
  double voxel_m = 1.0;
  Eigen::Vector3i first = Eigen::Vector3i::Zero();
  Eigen::Vector3i size = Eigen::Vector3i::Zero();

  std::size_t cell_count() const { return static_cast<std::size_t>(size.prod()); }

  bool holds(const Eigen::Vector3i& cell) const {
    const Eigen::Array3i place = (cell - first).array();
    return (place >= 0).all() && (place < size.array()).all();
  }

  std::size_t index(const Eigen::Vector3i& cell) const {
    const Eigen::Vector3i place = cell - first;
    return static_cast<std::size_t>((place.x() * size.y() + place.y()) * size.z() + place.z());
  }

  Eigen::Vector3i cell(std::size_t index) const {
    const int i = static_cast<int>(index);
    return first +
           Eigen::Vector3i(i / (size.y() * size.z()), i / size.z() % size.y(), i % size.z());
  }

  Eigen::Vector3i cell_of(const Eigen::Vector3d& point_m) const {
    return ((point_m - origin_m) / voxel_m).array().floor().cast<int>();
  }

  Eigen::Vector3d center_m(const Eigen::Vector3i& cell) const {
    return origin_m + voxel_m * (cell.cast<double>() + Eigen::Vector3d::Constant(0.5));
  }

  /// Distance (m) of a point from the nearest plane between cells.
  double to_face_m(const Eigen::Vector3d& point_m) const {
    const Eigen::Array3d scaled = ((point_m - origin_m) / voxel_m).array();
    return voxel_m * (scaled - scaled.round()).abs().minCoeff();
  }

  /// The cells that hold a point moved by the tolerance along all axes, either way on each.
  std::array<Eigen::Vector3i, 8> cells_near(const Eigen::Vector3d& point_m,
                                            double tolerance_m) const {
    std::array<Eigen::Vector3i, 8> cells;
    for (std::size_t corner = 0; corner < 8; ++corner) {
      const Eigen::Vector3d sign((corner & 1U) != 0 ? 1.0 : -1.0,
                                 (corner & 2U) != 0 ? 1.0 : -1.0,
                                 (corner & 4U) != 0 ? 1.0 : -1.0);
      cells[corner] = cell_of(point_m + tolerance_m * sign);
    }
    return cells;
  }
};

/// Log odds in units of 0.001, rounded; the probability is kept 1e-6 away from 0 and 1.
inline int naive_units(double probability) {
  const double p = std::clamp(probability, 1e-6, 1.0 - 1e-6);
  return static_cast<int>(std::lround(1000.0 * std::log(p / (1.0 - p))));
}

/// The inverse sensor model of one depth (thesis eq. 6.4 to 6.6), as increments of log odds.
struct NaiveDepthModel {
  NaiveSensorModel model;
  double delta_z_m = 0.0;

  /// c of eq. 6.6; 0 where the peak vanishes.
  double width_behind_m() const {
    return naive_peak(model, delta_z_m) > 0.0 ? naive_tail_width_m(model, delta_z_m) : 0.0;
  }

  /// Increment at a distance from the measurement (m), negative in front of it. 0 from 4 c on.
  int increment(double offset_m) const {
    if (!says(offset_m)) {
      return 0;
    }
    if (offset_m < -4.0 * delta_z_m) {
      return naive_units(model.p_free);
    }
    return naive_units(naive_probability(model, offset_m, 0.0, delta_z_m));
  }

  /// True up to where something is said of what is behind the measurement.
  bool says(double offset_m) const { return offset_m <= 4.0 * width_behind_m(); }

  /// By how much a table of coarse steps may be wrong there: the curve is steep in front of the
  /// measurement, and sinks slowly to nothing behind it.
  static int doubt(double offset_m) { return offset_m < 0.0 ? 40 : 10; }

  /// True where the curve is so steep that half a millimetre either way changes more than a table
  /// may.
  bool is_steep(double offset_m) const {
    return std::abs(increment(offset_m + 5e-4) - increment(offset_m - 5e-4)) > 40;
  }

  /// True where it is close whether something is said yet: 1 mm from the end, and with a
  /// p_unknown other than 1/2, where there is a step, a share of the way too.
  bool is_near_end(double offset_m) const {
    const double end_m = 4.0 * width_behind_m();
    const double share = model.p_unknown == 0.5 ? 0.0 : 0.04;
    return std::abs(offset_m - end_m) < 1e-3 + share * end_m;
  }
};

}  // namespace skyhalo::reference

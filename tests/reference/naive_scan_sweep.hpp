#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <optional>

#include "naive_increments.hpp"

namespace skyhalo::reference {

/// The slope of a patch from the relative changes of 1/range on the way from two directions before
/// it to two behind it (NaN where one is missing). A side goes on evenly when its two changes
/// differ by at most a tenth of the nearer one. One even side gives the slope; two that disagree
/// in sign, the evener one; otherwise the one nearer to 0 of both if they agree in sign, else 0. At
/// most 1/2 in size.
struct NaiveSlope {
  double value = 0.0;
  bool close = false;  ///< whether a small error could choose otherwise
};

inline NaiveSlope naive_slope(double z_m, const std::array<double, 4>& around_m) {
  const double up = 1.0 - z_m / around_m[1];
  const double down = z_m / around_m[2] - 1.0;
  const double up_bend = std::abs(up - (z_m / around_m[1] - z_m / around_m[0]));
  const double down_bend = std::abs(down - (z_m / around_m[3] - z_m / around_m[2]));
  const bool up_even = up_bend <= 0.1 * std::abs(up);
  const bool down_even = down_bend <= 0.1 * std::abs(down);
  const bool agree = up * down > 0.0;
  double slope = 0.0;
  if (up_even && !down_even) {
    slope = up;
  } else if (down_even && !up_even) {
    slope = down;
  } else if (agree) {
    slope = std::abs(up) < std::abs(down) ? up : down;
  } else if (up_even && down_even) {
    slope = up_bend < down_bend ? up : down;
  }
  // Single precision sees changes to a few 1e-7.
  constexpr double kDoubt = 1e-6;
  const bool uneven = std::abs(up - down) > kDoubt;
  const bool close =
      uneven && (std::abs(up_bend - 0.1 * std::abs(up)) < kDoubt ||
                 std::abs(down_bend - 0.1 * std::abs(down)) < kDoubt || std::abs(up) < kDoubt ||
                 std::abs(down) < kDoubt ||
                 (!agree && up_even && down_even && std::abs(up_bend - down_bend) < kDoubt));
  return {std::clamp(slope, -0.5, 0.5), close};
}

/// The plane patch that a direction with a depth is taken for: per step of angle the range grows by
/// these shares of itself.
struct NaivePatch {
  double down = 0.0;   ///< with theta
  double left = 0.0;   ///< with phi
  bool close = false;  ///< whether a small error could tilt it otherwise
};

/// Of the neighbours; those without a depth, or beyond the poles, are missing.
inline NaivePatch naive_patch(const NaiveScan& scan, int row, int col) {
  const double z_m = scan.z_m[scan.index(row, col)];
  const auto range_m = [&](int r, int c) {
    const int wrapped = (c + scan.cols()) % scan.cols();
    const bool exists = r >= 0 && r < scan.rows && scan.has_depth(scan.index(r, wrapped));
    return exists ? scan.z_m[scan.index(r, wrapped)] : std::nan("");
  };
  const NaiveSlope down = naive_slope(
      z_m,
      {range_m(row - 2, col), range_m(row - 1, col), range_m(row + 1, col), range_m(row + 2, col)});
  const NaiveSlope left = naive_slope(
      z_m,
      {range_m(row, col - 2), range_m(row, col - 1), range_m(row, col + 1), range_m(row, col + 2)});
  return {down.value, left.value, down.close || left.close};
}

/// The direction cell that a point falls into.
struct NaiveLook {
  int row = 0;
  int col = 0;
  double row_fraction = 0.0;  ///< from the cell's centre, in [-1/2, 1/2]
  double col_fraction = 0.0;
  double range_m = 0.0;
  bool near_border = false;  ///< of the cell, within 1e-4 rad
};

/// Where a scan holds a point (m, body frame).
inline NaiveLook naive_look(const NaiveScan& scan, const Eigen::Vector3d& p_body_m) {
  const double level_m = std::hypot(p_body_m.x(), p_body_m.y());
  const double step = scan.step_rad();
  NaiveLook look;
  look.range_m = p_body_m.norm();
  const double down = std::atan2(level_m, p_body_m.z()) / step;
  const double left = (std::atan2(p_body_m.y(), p_body_m.x()) + std::numbers::pi) / step;
  look.row = std::clamp(static_cast<int>(std::floor(down)), 0, scan.rows - 1);
  const int col = static_cast<int>(std::floor(left));
  look.col = (col + scan.cols()) % scan.cols();
  look.row_fraction = down - look.row - 0.5;
  look.col_fraction = left - col - 0.5;
  const auto to_border_rad = [step](double steps) {
    return step * std::abs(steps - std::round(steps));
  };
  look.near_border = look.range_m < 1e-3 || to_border_rad(down) < 1e-4 ||
                     to_border_rad(left) * level_m / look.range_m < 1e-4;
  return look;
}

/// How far from its centre along the ray a cell may lie and still be touched by a patch: half the
/// cube's edge times the 1-norm of the patch's normal, where the normal's share along the ray is 1.
/// Near the poles, where columns are slivers, the slope across them counts as at 30 degrees.
inline double naive_half_thickness_m(const NaiveScan& scan,
                                     const NaiveLook& look,
                                     const NaivePatch& patch,
                                     const Eigen::Matrix3d& R_map_body,
                                     double voxel_m) {
  const double theta = scan.theta_rad(look.row);
  const double phi = scan.phi_rad(look.col);
  const double step = scan.step_rad();
  const Eigen::Vector3d e_theta(
      std::cos(theta) * std::cos(phi), std::cos(theta) * std::sin(phi), -std::sin(theta));
  const Eigen::Vector3d e_phi(-std::sin(phi), std::cos(phi), 0.0);
  const Eigen::Vector3d normal = naive_direction(theta, phi) + patch.down / step * e_theta +
                                 patch.left / (step * std::max(std::sin(theta), 0.5)) * e_phi;
  return 0.5 * voxel_m * (R_map_body * normal).lpNorm<1>();
}

/// What a scan says of a cell whose centre it holds there; nothing where that is unseen, too far
/// behind the surface, or not wholly within what was seen free.
struct NaiveAnswer {
  std::optional<int> increment;
  int doubt = 0;
  bool close = false;
};

inline NaiveAnswer naive_answer(const NaiveScan& scan,
                                const NaiveLook& look,
                                const Eigen::Matrix3d& R_map_body,
                                const NaiveScanSettings& settings,
                                double voxel_m) {
  const std::size_t seen = scan.index(look.row, look.col);
  NaiveAnswer answer;
  if (scan.has_depth(seen)) {
    const NaivePatch patch = naive_patch(scan, look.row, look.col);
    const double z_m =
        scan.z_m[seen] / (1.0 + patch.down * look.row_fraction + patch.left * look.col_fraction);
    const double half_m = settings.cell_size_term
                              ? naive_half_thickness_m(scan, look, patch, R_map_body, voxel_m)
                              : 0.0;
    const double d_m = look.range_m - z_m;
    const double outside_m = std::max(0.0, std::abs(d_m) - half_m);
    const double offset_m = d_m < 0.0 ? -outside_m : outside_m;
    const NaiveDepthModel depth{settings.model, scan.delta_z_m[seen]};
    if (depth.says(offset_m)) {
      answer.increment = depth.increment(offset_m);
      answer.doubt = NaiveDepthModel::doubt(offset_m);
    }
    answer.close = patch.close || std::abs(std::abs(d_m) - half_m) < 1e-3 ||
                   depth.is_near_end(offset_m) || depth.is_steep(offset_m);
  } else if (scan.is_free(seen)) {
    const NaivePatch across;
    const double beyond_m = look.range_m - scan.free_to_m[seen] +
                            naive_half_thickness_m(scan, look, across, R_map_body, voxel_m);
    if (beyond_m <= 0.0) {
      answer.increment = naive_units(settings.model.p_free);
    }
    answer.close = std::abs(beyond_m) < 1e-4;
  }
  return answer;
}

/// Marks the cells that hold the end points of the depths, where a measurement marks at all.
inline void naive_mark_ends(const NaiveScan& scan,
                            const Eigen::Isometry3d& T_map_body,
                            const NaiveSensorModel& model,
                            NaiveIncrements& increments) {
  const NaiveBox box = increments.box();
  for (int row = 0; row < scan.rows; ++row) {
    for (int col = 0; col < scan.cols(); ++col) {
      const std::size_t seen = scan.index(row, col);
      if (!scan.has_depth(seen)) {
        continue;
      }
      const int peak = NaiveDepthModel{model, scan.delta_z_m[seen]}.increment(0.0);
      const Eigen::Vector3d end_m =
          T_map_body * (scan.z_m[seen] * naive_direction(scan.theta_rad(row), scan.phi_rad(col)));
      if (peak > 0) {
        increments.add(box.cell_of(end_m), peak, 1.0, NaiveDepthModel::doubt(0.0));
        for (const Eigen::Vector3i& cell : box.cells_near(end_m, 1e-5)) {
          if (cell != box.cell_of(end_m)) {
            increments.mark_close(cell);
            increments.mark_close(box.cell_of(end_m));
          }
        }
      }
    }
  }
}

/// Each cell of the box asks the scan in the direction of its centre.
inline NaiveIncrements naive_sweep_integration(const NaiveScan& scan,
                                               const Eigen::Isometry3d& T_map_body,
                                               const NaiveScanSettings& settings,
                                               const NaiveBox& box) {
  NaiveIncrements increments(box);
  for (std::size_t i = 0; i < box.cell_count(); ++i) {
    const Eigen::Vector3d p_body_m =
        T_map_body.linear().transpose() * (box.center_m(box.cell(i)) - T_map_body.translation());
    const NaiveLook look = naive_look(scan, p_body_m);
    const NaiveAnswer answer = naive_answer(scan, look, T_map_body.linear(), settings, box.voxel_m);
    if (answer.increment.has_value()) {
      increments.add(box.cell(i), *answer.increment, 1.0, answer.doubt);
    }
    if (answer.close || look.near_border) {
      increments.mark_close(box.cell(i));
    }
  }
  naive_mark_ends(scan, T_map_body, settings.model, increments);
  return increments;
}

}  // namespace skyhalo::reference

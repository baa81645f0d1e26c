#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>

#include "naive_increments.hpp"
#include "naive_scan_rays.hpp"

namespace skyhalo::reference {

/// What a sensor that sees a cone says. The tip and the axis (unit vector) are in the map frame;
/// 0 < half_angle_rad <= pi/2. Without an echo nothing is nearer than max_range_m.
struct NaiveCone {
  Eigen::Vector3d tip_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d axis = Eigen::Vector3d::UnitX();
  double half_angle_rad = 0.1;
  std::optional<double> range_m;
  double max_range_m = 1.0;
  double delta_z_m = 0.05;
};

/// Of a cell of the cone whose middle is m (m) from the tip: how far behind the range the part of
/// it is that is nearest to the range. `half_m`: half the cell's size along the way.
inline double naive_cone_offset_m(double range_m, double m, double half_m) {
  const double d = m - range_m;
  if (d > half_m) {
    return d - half_m;
  }
  return d < -half_m ? d + half_m : 0.0;
}

/// What is said of that cell, times a weight. Marks it when it is close whether anything is.
inline void naive_cone_say(const NaiveCone& cone,
                           const NaiveSensorModel& model,
                           const Eigen::Vector3i& cell,
                           const Eigen::Vector3d& m_half_m_weight,
                           NaiveIncrements& increments) {
  const double m = m_half_m_weight[0];
  const double half_m = m_half_m_weight[1];
  const auto weighted = [&](int units) {
    return static_cast<int>(std::lround(units * m_half_m_weight[2]));
  };
  if (!cone.range_m) {
    const double far_side_m = m - cone.max_range_m + half_m;
    if (std::abs(far_side_m) < 1e-6) {
      increments.mark_close(cell);
    }
    if (far_side_m <= 0.0) {
      increments.add(cell, weighted(naive_units(model.p_free)), 1.0, 0);
    }
    return;
  }
  const NaiveDepthModel depth{model, cone.delta_z_m};
  const double offset_m = naive_cone_offset_m(*cone.range_m, m, half_m);
  // A table's width behind the range may be a little off.
  const double end_m = 4.0 * depth.width_behind_m();
  if (depth.is_near_end(offset_m) || std::abs(offset_m - end_m) < 0.02 * end_m) {
    increments.mark_close(cell);
  }
  if (depth.says(offset_m)) {
    increments.add(
        cell, weighted(depth.increment(offset_m)), 1.0, NaiveDepthModel::doubt(offset_m));
  }
}

/// A cell whose middle lies in the cone.
inline void naive_cone_cell(const NaiveCone& cone,
                            const NaiveSensorModel& model,
                            const Eigen::Vector3i& cell,
                            NaiveIncrements& increments) {
  const Eigen::Vector3d from_tip_m = increments.box().center_m(cell) - cone.tip_m;
  const double m = from_tip_m.norm();
  if (m < 1e-9) {
    increments.mark_close(cell);
    return;
  }
  const Eigen::Vector3d u = from_tip_m / m;
  const double angle_rad = 2.0 * std::asin(std::min(1.0, 0.5 * (u - cone.axis).norm()));
  if (angle_rad >= cone.half_angle_rad) {
    return;
  }
  const double share = angle_rad / cone.half_angle_rad;
  const double weight = 1.0 - share * share;
  const double half_m =
      0.5 * increments.box().voxel_m * (std::abs(u.x()) + std::abs(u.y()) + std::abs(u.z()));
  naive_cone_say(cone, model, cell, {m, half_m, weight}, increments);
}

/// The cells whose middles lie in the cone, and those that its axis crosses as a ray of a scan
/// does.
inline NaiveIncrements naive_cone_integration(const NaiveCone& cone,
                                              const NaiveSensorModel& model,
                                              const NaiveBox& box) {
  NaiveIncrements increments(box);
  for (std::size_t i = 0; i < box.cell_count(); ++i) {
    naive_cone_cell(cone, model, box.cell(i), increments);
  }
  NaiveScan axis;
  axis.rows = 1;
  axis.z_m = {cone.range_m.value_or(std::nan(""))};
  axis.delta_z_m = {cone.delta_z_m};
  axis.free_to_m = {cone.max_range_m};
  naive_cast(axis, 0, {cone.tip_m, cone.axis}, model, increments);
  return increments;
}

}  // namespace skyhalo::reference

#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cstddef>
#include <vector>

#include "naive_increments.hpp"

namespace skyhalo::reference {

/// Where a ray from a point, with a unit direction, is cut by the box's planes between cells: the
/// distances (m) in rising order, 0 first.
inline std::vector<double> naive_plane_cuts(const NaiveBox& box,
                                            const Eigen::ParametrizedLine<double, 3>& ray) {
  std::vector<double> cuts{0.0};
  for (int axis = 0; axis < 3; ++axis) {
    for (int plane = box.first[axis]; plane <= box.first[axis] + box.size[axis]; ++plane) {
      const double at_m = box.origin_m[axis] + plane * box.voxel_m;
      const double t_m = (at_m - ray.origin()[axis]) / ray.direction()[axis];
      if (ray.direction()[axis] != 0.0 && t_m > 0.0 && t_m < 1e6) {
        cuts.push_back(t_m);
      }
    }
  }
  std::sort(cuts.begin(), cuts.end());
  return cuts;
}

/// Calls `visit(cell, enter_m, leave_m)` for each cell of the box that a ray crosses. Where the
/// middle of a chord lies within 1e-6 m of a face, because the chord is that short or runs along
/// the face, the cells about it are close.
template <class Visit>
void naive_walk(NaiveIncrements& increments,
                const Eigen::ParametrizedLine<double, 3>& ray,
                Visit&& visit) {
  const NaiveBox& box = increments.box();
  const std::vector<double> cuts = naive_plane_cuts(box, ray);
  for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
    const Eigen::Vector3d middle_m = ray.pointAt(0.5 * (cuts[i] + cuts[i + 1]));
    if (box.to_face_m(middle_m) < 1e-6) {
      for (const Eigen::Vector3i& cell : box.cells_near(middle_m, 2e-6)) {
        increments.mark_close(cell);
      }
    }
    const Eigen::Vector3i cell = box.cell_of(middle_m);
    if (cuts[i + 1] > cuts[i] && box.holds(cell)) {
      visit(cell, cuts[i], cuts[i + 1]);
    }
  }
}

/// The ray of one direction: of a depth the cells up to 4 c behind it, of a free one those up to
/// its end. What speaks against a thing counts with the share of the cell that is crossed.
inline void naive_cast(const NaiveScan& scan,
                       std::size_t seen,
                       const Eigen::ParametrizedLine<double, 3>& ray,
                       const NaiveSensorModel& model,
                       NaiveIncrements& increments) {
  const double z_m = scan.z_m[seen];
  const double free_to_m = scan.free_to_m[seen];
  const NaiveDepthModel depth{model, scan.delta_z_m[seen]};
  const auto share = [&](double chord_m) {
    return std::min(1.0, chord_m / increments.box().voxel_m);
  };
  naive_walk(increments, ray, [&](const Eigen::Vector3i& cell, double enter_m, double leave_m) {
    if (scan.has_depth(seen)) {
      const double offset_m = std::clamp(z_m, enter_m, leave_m) - z_m;
      if (depth.is_near_end(offset_m)) {
        increments.mark_close(cell);
      }
      if (depth.says(offset_m)) {
        increments.add(cell,
                       depth.increment(offset_m),
                       share(leave_m - enter_m),
                       NaiveDepthModel::doubt(offset_m));
      }
    } else if (enter_m < free_to_m) {
      const double chord_m = std::min(leave_m, free_to_m) - enter_m;
      increments.add(cell, naive_units(model.p_free), share(chord_m), 0);
    }
  });
}

/// One ray along the centre of each direction with a depth or seen free.
inline NaiveIncrements naive_ray_integration(const NaiveScan& scan,
                                             const Eigen::Isometry3d& T_map_body,
                                             const NaiveScanSettings& settings,
                                             const NaiveBox& box) {
  NaiveIncrements increments(box);
  for (int row = 0; row < scan.rows; ++row) {
    for (int col = 0; col < scan.cols(); ++col) {
      const std::size_t seen = scan.index(row, col);
      if (scan.has_depth(seen) || scan.is_free(seen)) {
        const Eigen::Vector3d u = naive_direction(scan.theta_rad(row), scan.phi_rad(col));
        naive_cast(scan,
                   seen,
                   {T_map_body.translation(), T_map_body.linear() * u},
                   settings.model,
                   increments);
      }
    }
  }
  return increments;
}

}  // namespace skyhalo::reference

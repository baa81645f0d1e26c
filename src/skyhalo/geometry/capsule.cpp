#include "skyhalo/geometry/capsule.hpp"

#include <algorithm>
#include <cmath>

namespace skyhalo {
namespace {

/// The way from the nearest point of a box to a point (m); 0 inside.
Eigen::Vector3d beyond(const Eigen::AlignedBox3d& box_m, const Eigen::Vector3d& point_m) noexcept {
  return point_m - point_m.cwiseMax(box_m.min()).cwiseMin(box_m.max());
}

/// A box of cells that holds those a box (m) touches, faces included.
CellBox cells_about(const VoxelLattice& lattice, const Eigen::AlignedBox3d& box_m) noexcept {
  CellBox cells = cells_touching(lattice, box_m.min(), box_m.max());
  cells.min.array() -= 1;  // the cell below a face, and rounding
  cells.max.array() += 1;
  return cells;
}

}  // namespace

double squared_distance_m2(const Segment& segment, const Eigen::AlignedBox3d& box_m) noexcept {
  // The square of the distance of the point from + t (to - from) is convex in t; half its slope is
  // piecewise linear with a kink where the line crosses the plane of a face. The zero of the slope
  // lies between two such places.
  const Eigen::Vector3d along_m = segment.to_m - segment.from_m;
  const auto beyond_at = [&](double t) { return beyond(box_m, segment.from_m + t * along_m); };
  double low = 0.0;
  double high = 1.0;
  double slope_low = beyond_at(low).dot(along_m);
  double slope_high = beyond_at(high).dot(along_m);
  if (slope_low >= 0.0) {
    return beyond_at(low).squaredNorm();
  }
  if (slope_high <= 0.0) {
    return beyond_at(high).squaredNorm();
  }
  for (int side = 0; side < 6; ++side) {
    const int axis = side / 2;
    const double face_m = side % 2 == 0 ? box_m.min()[axis] : box_m.max()[axis];
    const double t = (face_m - segment.from_m[axis]) / along_m[axis];
    if (!(t > low && t < high)) {  // nor is it a number where the segment has no way along the axis
      continue;
    }
    const double slope = beyond_at(t).dot(along_m);
    (slope < 0.0 ? low : high) = t;
    (slope < 0.0 ? slope_low : slope_high) = slope;
  }
  const double t = low + (high - low) * (-slope_low / (slope_high - slope_low));
  return beyond_at(t).squaredNorm();
}

bool touches(const Capsule& capsule,
             const VoxelLattice& lattice,
             const Eigen::Vector3i& cell) noexcept {
  const double half_m = 0.5 * lattice.voxel_m;
  const Eigen::Vector3d center_m = lattice.center_m(cell);
  const Eigen::Vector3d along_m = capsule.axis.to_m - capsule.axis.from_m;
  const double length2_m2 = along_m.squaredNorm();
  const double t =
      length2_m2 > 0.0 ? (center_m - capsule.axis.from_m).dot(along_m) / length2_m2 : 0.0;
  const double off_m = (capsule.axis.from_m + std::clamp(t, 0.0, 1.0) * along_m - center_m).norm();
  // The balls in and about the cube settle most cells.
  if (off_m <= capsule.radius_m + half_m) {
    return true;
  }
  if (off_m > capsule.radius_m + 1.7321 * half_m) {
    return false;
  }
  const Eigen::Vector3d corner_m = lattice.corner_m(cell);
  const Eigen::AlignedBox3d cube_m(corner_m, corner_m.array() + lattice.voxel_m);
  return squared_distance_m2(capsule.axis, cube_m) <= capsule.radius_m * capsule.radius_m;
}

CellBox cells_near(const VoxelLattice& lattice, const Capsule& capsule) noexcept {
  return cells_about(lattice, capsule.bounds_m());
}

int longest_axis(const Capsule& capsule) noexcept {
  int axis = 0;
  (capsule.axis.to_m - capsule.axis.from_m).cwiseAbs().maxCoeff(&axis);
  return axis;
}

CellBox layer_near(const VoxelLattice& lattice,
                   const Capsule& capsule,
                   int axis,
                   int index) noexcept {
  // Only the part of the segment that comes within a radius of the layer counts.
  const double from_m = capsule.axis.from_m[axis];
  const double along_m = capsule.axis.to_m[axis] - from_m;
  const double low_m = lattice.origin_m[axis] + lattice.voxel_m * index - capsule.radius_m;
  const double high_m = low_m + lattice.voxel_m + 2.0 * capsule.radius_m;
  Capsule part = capsule;
  if (along_m != 0.0) {
    const auto at = [&](double t) -> Eigen::Vector3d {
      return capsule.axis.from_m +
             std::clamp(t, 0.0, 1.0) * (capsule.axis.to_m - capsule.axis.from_m);
    };
    part.axis = {at((low_m - from_m) / along_m), at((high_m - from_m) / along_m)};
  }
  CellBox layer = cells_about(lattice, part.bounds_m());
  layer.min[axis] = index;
  layer.max[axis] = index + 1;
  return layer;
}

double cells_to_look_at(const VoxelLattice& lattice,
                        const Capsule& capsule,
                        const CellBox& within) noexcept {
  const CellBox box = overlap(within, cells_near(lattice, capsule));
  const Eigen::Vector3d size = box.size().cast<double>();
  // A layer's part of the segment goes sideways at most as far as it goes along the axis.
  const double width = (4.0 * capsule.radius_m) / lattice.voxel_m + 6.0;
  const int axis = longest_axis(capsule);
  return size[axis] * std::min(width, size[(axis + 1) % 3]) * std::min(width, size[(axis + 2) % 3]);
}

}  // namespace skyhalo

#include "skyhalo/geometry/voxel_grid.hpp"

#include <algorithm>
#include <array>
#include <sstream>
#include <string>

#include "skyhalo/base/error.hpp"

namespace skyhalo {
namespace {

constexpr double kMaxCells = 2147483648.0;

Error bounds_error(int axis, double from_m, double to_m) {
  static constexpr std::array kAxes{"x", "y", "z"};
  const std::string name = kAxes.at(static_cast<std::size_t>(axis));
  std::ostringstream text;
  text << "map bounds: " << name << " runs from " << from_m << " to " << to_m << " m; expected "
       << name << "0 < " << name << "1";
  return {ErrorKind::kInput, text.str()};
}

}  // namespace

VoxelGrid make_voxel_grid(const Eigen::AlignedBox3d& bounds_m, double voxel_m) {
  if (!(voxel_m > 0.0) || !std::isfinite(voxel_m)) {
    throw Error(ErrorKind::kInput, "map voxel: the edge must be a length above 0 m");
  }
  VoxelGrid grid{.min_m = bounds_m.min(), .voxel_m = voxel_m};
  double cells = 1.0;
  for (int axis = 0; axis < 3; ++axis) {
    const double length_m = bounds_m.max()[axis] - bounds_m.min()[axis];
    if (!(length_m > 0.0) || !std::isfinite(length_m)) {
      throw bounds_error(axis, bounds_m.min()[axis], bounds_m.max()[axis]);
    }
    // A length that is a whole number of voxels but for rounding must not gain a layer.
    const double count = std::max(1.0, std::ceil(length_m / voxel_m - 1e-6));
    cells *= count;
    if (!(cells < kMaxCells)) {
      throw Error(ErrorKind::kInput,
                  "map bounds: more than 2^31 cells; choose smaller bounds or a larger voxel");
    }
    grid.size[axis] = static_cast<int>(count);
  }
  return grid;
}

}  // namespace skyhalo

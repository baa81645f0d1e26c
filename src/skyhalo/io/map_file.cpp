#include "skyhalo/io/map_file.hpp"

#include <octomap/OcTree.h>

#include <sstream>

#include "skyhalo/base/error.hpp"
#include "skyhalo/io/colour.hpp"
#include "skyhalo/io/output_folder.hpp"

namespace skyhalo {

std::vector<ColouredPoint> cell_points(const VoxelGrid& grid,
                                       const std::vector<std::int64_t>& offsets) {
  std::vector<ColouredPoint> points;
  points.reserve(offsets.size());
  for (const std::int64_t offset : offsets) {
    const Eigen::Vector3i cell = grid.cell_at(offset);
    const double height_share = (cell.z() + 0.5) / grid.size.z();
    points.push_back({grid.center_m(cell).cast<float>(), scale_colour(height_share)});
  }
  return points;
}

std::vector<ColouredPoint> occupied_points(const DenseMap& map, double occupied_probability) {
  std::vector<std::int64_t> offsets;
  for (std::int64_t offset = 0; const LogOdds cell : map.cells()) {
    if (cell != kUnknown && probability_of(cell) > occupied_probability) {
      offsets.push_back(offset);
    }
    ++offset;
  }
  return cell_points(map.grid(), offsets);
}

namespace {

/// The octree's key of the map's first cell. One rounding for the whole map: cells keep their
/// neighbours even off the octree's lattice.
Eigen::Vector3i first_octree_key(const std::filesystem::path& file, const VoxelGrid& grid) {
  constexpr double kKeyOfZero = 32768.0;
  const Eigen::Array3d first = (grid.min_m / grid.voxel_m).array().round() + kKeyOfZero;
  if ((first < 0.0).any() || (first + grid.size.cast<double>().array() > 2.0 * kKeyOfZero).any()) {
    throw Error(ErrorKind::kFailure,
                file.string() + ": the map reaches beyond what an octree of this cell can hold");
  }
  return first.cast<int>();
}

}  // namespace

void write_octree(const std::filesystem::path& file, const DenseMap& map) {
  const VoxelGrid& grid = map.grid();
  octomap::OcTree tree(grid.voxel_m);
  // The map has its own limits; the octree must not add tighter ones.
  tree.setClampingThresMin(0.0);
  tree.setClampingThresMax(1.0);
  const Eigen::Vector3i first_key = first_octree_key(file, grid);
  for (std::int64_t offset = 0; const LogOdds cell : map.cells()) {
    if (cell != kUnknown) {
      const Eigen::Vector3i key = first_key + grid.cell_at(offset);
      tree.setNodeValue(octomap::OcTreeKey(static_cast<octomap::key_type>(key.x()),
                                           static_cast<octomap::key_type>(key.y()),
                                           static_cast<octomap::key_type>(key.z())),
                        static_cast<float>(kLogOddsPerUnit * cell),
                        true);
    }
    ++offset;
  }
  tree.updateInnerOccupancy();
  tree.prune();
  std::ostringstream bytes;
  if (!tree.write(bytes)) {
    throw Error(ErrorKind::kFailure, file.string() + ": cannot be written");
  }
  write_bytes(file, bytes.str());
}

}  // namespace skyhalo

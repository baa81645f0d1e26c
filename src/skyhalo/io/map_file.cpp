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

void write_octree(const std::filesystem::path& file, const DenseMap& map) {
  const VoxelGrid& grid = map.grid();
  octomap::OcTree tree(grid.voxel_m);
  // The map has its own limits; the octree must not add tighter ones.
  tree.setClampingThresMin(0.0);
  tree.setClampingThresMax(1.0);
  for (std::int64_t offset = 0; const LogOdds cell : map.cells()) {
    if (cell != kUnknown) {
      const Eigen::Vector3d center_m = grid.center_m(grid.cell_at(offset));
      octomap::OcTreeKey key;
      if (!tree.coordToKeyChecked(center_m.x(), center_m.y(), center_m.z(), key)) {
        throw Error(
            ErrorKind::kFailure,
            file.string() + ": the map reaches beyond what an octree of this cell can hold");
      }
      tree.setNodeValue(key, static_cast<float>(kLogOddsPerUnit * cell), true);
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

#include "skyhalo/io/map_file.hpp"

#include "skyhalo/io/colour.hpp"
#include "skyhalo/io/octomap_file.hpp"
#include "skyhalo/map/to_sparse.hpp"

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
  write_octomap(file, to_sparse(map), OctreeForm::kFull);
}

}  // namespace skyhalo

#include "skyhalo/evaluation/comparison_picture.hpp"

#include "skyhalo/io/colour.hpp"
#include "skyhalo/io/picture.hpp"

namespace skyhalo {
namespace {

// Okabe and Ito's colours, told apart by colour-blind eyes; blue, green, red.
const cv::Vec3b kFound(115, 158, 0);
const cv::Vec3b kClaimed(0, 159, 230);
const cv::Vec3b kMissed(178, 114, 0);
const cv::Vec3b kWhite(255, 255, 255);

}  // namespace

cv::Mat3b truth_picture(const GroundTruth& truth, int cell_px) {
  const VoxelGrid& grid = truth.grid();
  return picture_from_above(grid, cell_px, [&](int x, int y) {
    for (int z = grid.size.z() - 1; z >= 0; --z) {
      if (truth.occupied()[static_cast<std::size_t>(grid.offset_of({x, y, z}))] != 0) {
        return scale_colour((z + 0.5) / grid.size.z());
      }
    }
    return kWhite;
  });
}

cv::Mat3b comparison_picture(const DenseMap& map,
                             const GroundTruth& truth,
                             double occupied_probability,
                             int cell_px) {
  const VoxelGrid& grid = map.grid();
  return picture_from_above(grid, cell_px, [&](int x, int y) {
    cv::Vec3b colour = kWhite;
    for (int z = 0; z < grid.size.z(); ++z) {
      const auto offset = static_cast<std::size_t>(grid.offset_of({x, y, z}));
      const LogOdds cell = map.cells()[offset];
      const bool claimed = cell != kUnknown && probability_of(cell) > occupied_probability;
      const bool occupied = truth.occupied()[offset] != 0;
      if (claimed && occupied) {
        return kFound;
      }
      if (claimed) {
        colour = kClaimed;
      } else if (occupied && colour == kWhite) {
        colour = kMissed;
      }
    }
    return colour;
  });
}

}  // namespace skyhalo

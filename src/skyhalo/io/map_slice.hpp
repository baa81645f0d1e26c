#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <opencv2/core/mat.hpp>

#include "skyhalo/map/occupancy.hpp"
#include "skyhalo/map/sparse_map.hpp"

namespace skyhalo {

/// A range of heights (m, map frame), `z_min_m <= z_max_m`.
struct HeightRange {
  double z_min_m = 0.0;
  double z_max_m = 0.0;
};

/// A map seen from above, as ROS' map_server has it: one pixel for a column of cells, the image's
/// up is y, its right is x.
struct MapSlice {
  cv::Mat1b image;           ///< 0 occupied, 254 free, 205 unknown
  double voxel_m = 0.0;      ///< edge of a pixel
  Eigen::Vector2d corner_m;  ///< the lower left corner of the lower left pixel, map frame
};

/// The columns of a map between two heights. A column is occupied if any of its cells is, free if
/// any is and none is occupied, else unknown. Cells that reach into the range belong to it, those
/// that only touch it do not; with equal heights, the cell of that height. The image is as large as
/// what is known there. Throws `Error`: input when nothing is, failure when it had more than 2^28
/// pixels.
[[nodiscard]] MapSlice slice_of(const SparseMap& map,
                                const HeightRange& heights,
                                const OccupancyRule& rule);

/// Writes a slice as PNG and, beside it, the YAML file that map_server loads, called like the PNG
/// file; a reader that does as map_server does sees the same columns occupied, free and unknown.
/// Both are renamed to their names when both are whole. Throws `Error` (failure) when they cannot
/// be written.
void write_slice(const std::filesystem::path& png, const MapSlice& slice);

}  // namespace skyhalo

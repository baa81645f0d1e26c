#include "skyhalo/io/map_slice.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

#include "skyhalo/base/error.hpp"
#include "skyhalo/base/number_text.hpp"
#include "skyhalo/io/image_file.hpp"
#include "skyhalo/io/output_folder.hpp"
#include "skyhalo/io/unfinished_file.hpp"
#include "skyhalo/map/cell_map.hpp"

namespace skyhalo {
namespace {

constexpr unsigned char kOccupiedPixel = 0;
constexpr unsigned char kFreePixel = 254;
constexpr unsigned char kUnknownPixel = 205;

/// All cells between two heights.
CellBox cells_between(const VoxelLattice& lattice, const HeightRange& heights) {
  CellBox box = whole_lattice();
  const auto index = [&](double z_m) {
    const double cells = (z_m - lattice.origin_m.z()) / lattice.voxel_m;
    return std::clamp(cells, 1.0 * box.min.z(), 1.0 * box.max.z());
  };
  // Heights on a cell's face are meant so, however they were rounded.
  constexpr double kOnFace = 1e-6;
  const double first = std::floor(index(heights.z_min_m) + kOnFace);
  const double end = std::ceil(index(heights.z_max_m) - kOnFace);
  box.min.z() = static_cast<int>(first);
  box.max.z() = static_cast<int>(std::max(end, first + 1.0));
  return box;
}

/// Visits what is known in a box as blocks of equal cells.
template <class Visit>
void for_each_block(const SparseMap& map, const CellBox& box, const Visit& visit) {
  for (const Eigen::Vector3i& brick : map.bricks()) {
    for_each_known_block_of(map, brick, box, [&](const CellBox& block, LogOdds value) {
      visit(block, value);
      return true;
    });
  }
}

CellBox known_cells(const SparseMap& map, const CellBox& box) {
  CellBox known;
  for_each_block(map, box, [&](const CellBox& block, LogOdds /*value*/) {
    const bool first = known.empty();
    known.min = first ? block.min : known.min.cwiseMin(block.min);
    known.max = first ? block.max : known.max.cwiseMax(block.max);
  });
  return known;
}

std::string text_of(double value) {
  return number_text("%.10g", value);
}

}  // namespace

MapSlice slice_of(const SparseMap& map, const HeightRange& heights, const OccupancyRule& rule) {
  constexpr std::int64_t kMostPixels = std::int64_t{1} << 28;
  const std::string range = text_of(heights.z_min_m) + " m and " + text_of(heights.z_max_m) + " m";
  const CellBox known = known_cells(map, cells_between(map.lattice(), heights));
  if (known.empty()) {
    throw Error(ErrorKind::kInput, "nothing of the map is known between the heights " + range);
  }
  const Eigen::Vector3i size = known.size();
  if (std::int64_t{size.x()} * size.y() > kMostPixels) {
    throw Error(ErrorKind::kFailure,
                "a slice of the map would have " + std::to_string(size.x()) + " x " +
                    std::to_string(size.y()) + " pixels, at most 2^28 are made");
  }
  MapSlice slice{.image = cv::Mat1b(size.y(), size.x(), kUnknownPixel),
                 .voxel_m = map.lattice().voxel_m,
                 .corner_m = map.lattice().corner_m(known.min).head<2>()};
  for_each_block(map, known, [&](const CellBox& block, LogOdds value) {
    const Occupancy state = rule(value);
    if (state == Occupancy::kNotKnown) {
      return;
    }
    for (int y = block.min.y(); y < block.max.y(); ++y) {
      unsigned char* const row = slice.image[known.max.y() - 1 - y];
      for (int x = block.min.x(); x < block.max.x(); ++x) {
        unsigned char& pixel = row[x - known.min.x()];
        if (state == Occupancy::kOccupied) {
          pixel = kOccupiedPixel;
        } else if (pixel == kUnknownPixel) {
          pixel = kFreePixel;
        }
      }
    }
  });
  return slice;
}

void write_slice(const std::filesystem::path& png, const MapSlice& slice) {
  std::filesystem::path yaml = png;
  yaml.replace_extension(".yaml");
  UnfinishedFile image(png);
  UnfinishedFile text(yaml);
  write_bytes(image.path(), encode_png(slice.image));
  // A reader takes (255 - pixel) / 255 for the probability; 205 must be no less than `free_thresh`.
  write_bytes(text.path(),
              "image: " +
                  nlohmann::json(png.filename().string())
                      .dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) +
                  "\nmode: trinary\nresolution: " + text_of(slice.voxel_m) + "\norigin: [" +
                  text_of(slice.corner_m.x()) + ", " + text_of(slice.corner_m.y()) +
                  ", 0]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n");
  image.commit();
  text.commit();
}

}  // namespace skyhalo

#include "skyhalo/io/picture.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "skyhalo/io/colour.hpp"

namespace skyhalo {
namespace {

const cv::Vec3b kNoMeasurement(48, 48, 48);
const cv::Vec3b kUnknownColour(240, 228, 216);
const cv::Vec3b kWhite(255, 255, 255);

/// The disparity that 99 % of the measured pixels do not exceed; 1 without any.
float full_scale(const cv::Mat1f& disparity_px) {
  std::vector<float> values;
  std::copy_if(disparity_px.begin(), disparity_px.end(), std::back_inserter(values), [](float d) {
    return d > 0.0F;
  });
  if (values.empty()) {
    return 1.0F;
  }
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(values.size() * 99 / 100);
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

LogOdds cell_of(const DenseMap& map, const Eigen::Vector3i& cell) {
  return map.cells()[static_cast<std::size_t>(map.grid().offset_of(cell))];
}

cv::Mat3b enlarged(const cv::Mat3b& cells, int cell_px) {
  cv::Mat3b picture;
  cv::resize(cells, picture, {}, cell_px, cell_px, cv::INTER_NEAREST);
  return picture;
}

}  // namespace

cv::Mat3b picture_from_above(const VoxelGrid& grid,
                             int cell_px,
                             const std::function<cv::Vec3b(int x, int y)>& colour_of) {
  cv::Mat3b cells(grid.size.y(), grid.size.x());
  for (int x = 0; x < grid.size.x(); ++x) {
    for (int y = 0; y < grid.size.y(); ++y) {
      cells(grid.size.y() - 1 - y, x) = colour_of(x, y);
    }
  }
  return enlarged(cells, cell_px);
}

cv::Mat3b disparity_picture(const cv::Mat1f& disparity_px) {
  const float full = full_scale(disparity_px);
  cv::Mat3b picture(disparity_px.size());
  std::transform(disparity_px.begin(), disparity_px.end(), picture.begin(), [&](float d) {
    return d >= 0.0F ? scale_colour(0.05 + 0.95 * d / full) : cv::Vec3b(0, 0, 0);
  });
  return picture;
}

cv::Mat3b grid_picture(const SphericalGrid& grid, int cell_px) {
  const GridGeometry& geometry = grid.geometry();
  double nearest_m = std::numeric_limits<double>::infinity();
  for (int row = 0; row < geometry.rows; ++row) {
    for (int col = 0; col < geometry.cols; ++col) {
      nearest_m = std::min(nearest_m, grid.depth_m({row, col}).value_or(nearest_m));
    }
  }
  cv::Mat3b cells(geometry.rows, geometry.cols, kNoMeasurement);
  for (int row = 0; row < geometry.rows; ++row) {
    for (int col = 0; col < geometry.cols; ++col) {
      if (const auto depth_m = grid.depth_m({row, col})) {
        cells(row, geometry.cols - 1 - col) = scale_colour(nearest_m / *depth_m);
      }
    }
  }
  return enlarged(cells, cell_px);
}

cv::Mat3b slice_picture(const DenseMap& map, double z_m, int cell_px) {
  const VoxelGrid& grid = map.grid();
  const int layer =
      std::clamp(grid.cell_of({grid.min_m.x(), grid.min_m.y(), z_m}).z(), 0, grid.size.z() - 1);
  return picture_from_above(grid, cell_px, [&](int x, int y) {
    const LogOdds cell = cell_of(map, {x, y, layer});
    if (cell == kUnknown) {
      return kUnknownColour;
    }
    const auto grey = static_cast<unsigned char>(std::lround(255.0 * (1.0 - probability_of(cell))));
    return cv::Vec3b(grey, grey, grey);
  });
}

cv::Mat3b top_picture(const DenseMap& map, double occupied_probability, int cell_px) {
  const VoxelGrid& grid = map.grid();
  return picture_from_above(grid, cell_px, [&](int x, int y) {
    cv::Vec3b colour = kUnknownColour;
    for (int z = 0; z < grid.size.z(); ++z) {
      const LogOdds cell = cell_of(map, {x, y, z});
      if (cell != kUnknown && probability_of(cell) > occupied_probability) {
        colour = scale_colour((z + 0.5) / grid.size.z());
      } else if (cell != kUnknown && colour == kUnknownColour) {
        colour = kWhite;
      }
    }
    return colour;
  });
}

}  // namespace skyhalo

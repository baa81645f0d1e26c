#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <vector>

namespace skyhalo {

/// Shrinks images by a whole factor: each pixel of the result is the mean of a block, rounded. Rows
/// and columns beyond the last whole block are left out. Its memory is kept from image to image.
class BlockMean {
 public:
  /// `factor` >= 1 blocks per side; `image` holds at least one block. `out` gets its size.
  void shrink(const cv::Mat1b& image, int factor, cv::Mat1b& out);

 private:
  void shrink_row(const cv::Mat1b& image, int factor, int row, std::uint8_t* out);

  std::vector<std::uint32_t> sums_;  // of the columns of a row of blocks
};

}  // namespace skyhalo

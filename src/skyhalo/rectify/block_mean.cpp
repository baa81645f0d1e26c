#include "skyhalo/rectify/block_mean.hpp"

#include <algorithm>

namespace skyhalo {
namespace {

void halve_row(const std::uint8_t* upper,
               const std::uint8_t* lower,
               int cols,
               std::uint8_t* out) noexcept {
  for (int u = 0; u < cols; ++u, upper += 2, lower += 2) {
    const int sum = upper[0] + upper[1] + lower[0] + lower[1];
    out[u] = static_cast<std::uint8_t>((sum + 2) / 4);
  }
}

}  // namespace

void BlockMean::shrink(const cv::Mat1b& image, int factor, cv::Mat1b& out) {
  if (factor == 1) {
    image.copyTo(out);
    return;
  }
  out.create(image.rows / factor, image.cols / factor);
  for (int v = 0; v < out.rows; ++v) {
    if (factor == 2) {
      halve_row(image[2 * v], image[2 * v + 1], out.cols, out[v]);
    } else {
      shrink_row(image, factor, v, out[v]);
    }
  }
}

void BlockMean::shrink_row(const cv::Mat1b& image, int factor, int row, std::uint8_t* out) {
  const int out_cols = image.cols / factor;
  const int cols = out_cols * factor;
  sums_.assign(static_cast<std::size_t>(cols), 0);
  for (int v = row * factor; v < (row + 1) * factor; ++v) {
    const std::uint8_t* in = image[v];
    for (int u = 0; u < cols; ++u) {
      sums_[static_cast<std::size_t>(u)] += in[u];
    }
  }
  const auto area = static_cast<std::uint32_t>(factor * factor);
  const std::uint32_t* block = sums_.data();
  for (int u = 0; u < out_cols; ++u, block += factor) {
    std::uint32_t sum = area / 2;
    for (int i = 0; i < factor; ++i) {
      sum += block[i];
    }
    out[u] = static_cast<std::uint8_t>(sum / area);
  }
}

}  // namespace skyhalo

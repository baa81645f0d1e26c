#pragma once

#include <filesystem>
#include <opencv2/core/mat.hpp>

namespace skyhalo {

/// An image as it is stored (grey or BGR, 8 or 16 bit). Throws `Error` (input) naming the file when
/// it is missing, is no image, or is cut off or damaged.
[[nodiscard]] cv::Mat read_image(const std::filesystem::path& file);

/// Writes an image (8 or 16 bit) as PNG. Throws `Error` (failure) when it cannot be written.
void write_png(const std::filesystem::path& file, const cv::Mat& image);

}  // namespace skyhalo

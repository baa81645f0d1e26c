#pragma once

#include <filesystem>
#include <opencv2/core/mat.hpp>
#include <string>

namespace skyhalo {

/// An image as it is stored (grey or BGR, 8 or 16 bit). Throws `Error` (input) naming the file when
/// it is missing, is no image, or is cut off or damaged.
[[nodiscard]] cv::Mat read_image(const std::filesystem::path& file);

/// The bytes of an image (8 or 16 bit) as a PNG file. Throws `Error` (failure) when it cannot be
/// encoded, for instance with more than 2^20 pixels on a side.
[[nodiscard]] std::string encode_png(const cv::Mat& image);

/// Writes an image (8 or 16 bit) as PNG. Throws `Error` (failure) when it cannot be written.
void write_png(const std::filesystem::path& file, const cv::Mat& image);

}  // namespace skyhalo

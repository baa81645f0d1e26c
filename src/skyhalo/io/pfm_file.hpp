#pragma once

#include <filesystem>
#include <opencv2/core/mat.hpp>

namespace skyhalo {

/// Reads a grey PFM image (`Pf`) of 32-bit floats, of either byte order; NaN and infinity are kept.
/// Throws `Error` (input) naming the file when it is missing, is none, or is cut off.
[[nodiscard]] cv::Mat1f read_pfm(const std::filesystem::path& file);

/// Writes an image as grey PFM, little-endian; it reads back to the last bit. Throws `Error`
/// (failure) when it is empty or cannot be written.
void write_pfm(const std::filesystem::path& file, const cv::Mat1f& image);

}  // namespace skyhalo

#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>

namespace skyhalo {

// What is carried about; the seed as in `procedural_texture`.

[[nodiscard]] cv::Mat3f paint_cardboard(std::uint64_t seed);
[[nodiscard]] cv::Mat3f paint_crate(std::uint64_t seed);
[[nodiscard]] cv::Mat3f paint_cloth(std::uint64_t seed);
[[nodiscard]] cv::Mat3f paint_metal(std::uint64_t seed);

}  // namespace skyhalo

#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>

namespace skyhalo {

// What grows, lies and flows; the seed as in `procedural_texture`.

[[nodiscard]] cv::Mat3f paint_forest_floor(std::uint64_t seed);
[[nodiscard]] cv::Mat3f paint_grass(std::uint64_t seed);
[[nodiscard]] cv::Mat3f paint_soil(std::uint64_t seed);
[[nodiscard]] cv::Mat3f paint_bark(std::uint64_t seed);
[[nodiscard]] cv::Mat3f paint_leaf(std::uint64_t seed);
[[nodiscard]] cv::Mat3f paint_stone(std::uint64_t seed);
[[nodiscard]] cv::Mat3f paint_ripples(std::uint64_t seed);
[[nodiscard]] cv::Mat3f paint_clouds(std::uint64_t seed);
[[nodiscard]] cv::Mat3f paint_gravel(std::uint64_t seed);

}  // namespace skyhalo

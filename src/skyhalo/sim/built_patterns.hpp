#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>

namespace skyhalo {

// What is built and laid; the seed as in `procedural_texture`.

[[nodiscard]] cv::Mat3f paint_asphalt(std::uint64_t seed);
[[nodiscard]] cv::Mat3f paint_brick(std::uint64_t seed);
[[nodiscard]] cv::Mat3f paint_plaster(std::uint64_t seed);
[[nodiscard]] cv::Mat3f paint_concrete(std::uint64_t seed);
[[nodiscard]] cv::Mat3f paint_planks(std::uint64_t seed);
[[nodiscard]] cv::Mat3f paint_corrugated(std::uint64_t seed);
[[nodiscard]] cv::Mat3f paint_facade(std::uint64_t seed);
[[nodiscard]] cv::Mat3f paint_wall_paint(std::uint64_t seed);
[[nodiscard]] cv::Mat3f paint_tiles(std::uint64_t seed);

}  // namespace skyhalo

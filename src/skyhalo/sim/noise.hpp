#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>

namespace skyhalo {

/// Noise whose detail goes from a few spots across the picture down to single pixels.
struct NoiseShape {
  int side_px = 512;   ///< width and height, > 0
  int cells_x = 4;     ///< spots across in the coarsest octave, 1...side_px
  int cells_y = 4;     ///< and down
  int octaves = 8;     ///< each twice as fine, down to the pixel
  float gain = 0.75F;  ///< an octave's strength over that of the one before
};

/// Value noise of several octaves that wraps at all edges: mean 0.5, standard deviation 0.2.
[[nodiscard]] cv::Mat1f fractal_noise(const NoiseShape& shape, std::uint64_t seed);

/// A picture cut into cells round random points; it wraps at all edges.
struct CellNoise {
  cv::Mat1f nearest;  ///< distance to the cell's point, 1 is a mean cell's width
  cv::Mat1f border;   ///< 0 on a border between cells, growing inwards, in the same unit
  cv::Mat1f tone;     ///< the cell's own random number, 0...1
};

/// `cells` across and down, 1...side_px. After Worley 1996.
[[nodiscard]] CellNoise cell_noise(int side_px, int cells, std::uint64_t seed);

/// Smooth noise in -1...1 over the plane, with hills about 1 apart; it never repeats. Total.
[[nodiscard]] float hill_noise(float x, float y, std::uint64_t seed) noexcept;

}  // namespace skyhalo

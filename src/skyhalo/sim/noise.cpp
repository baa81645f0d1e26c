#include "skyhalo/sim/noise.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/core.hpp>
#include <vector>

#include "skyhalo/sim/random_numbers.hpp"

namespace skyhalo {
namespace {

constexpr float kSpread = 0.2F;

float random_share(std::uint64_t a, std::uint64_t b) noexcept {
  return static_cast<float>(stirred(a, b) >> 40U) * 0x1p-24F;
}

float smooth(float t) noexcept {
  return t * t * (3.0F - 2.0F * t);
}

/// Where a pixel lies between two points of a lattice that wraps.
struct Between {
  int first = 0;
  int second = 0;
  float share = 0.0F;  ///< of the second
};

std::vector<Between> places(int side_px, int cells) {
  std::vector<Between> result(static_cast<std::size_t>(side_px));
  for (int i = 0; i < side_px; ++i) {
    const float x = static_cast<float>(i) * static_cast<float>(cells) / static_cast<float>(side_px);
    const int first = static_cast<int>(x);
    result[static_cast<std::size_t>(i)] = {
        first % cells, (first + 1) % cells, smooth(x - static_cast<float>(first))};
  }
  return result;
}

cv::Mat1f random_lattice(int rows, int cols, std::uint64_t seed) {
  cv::Mat1f lattice(rows, cols);
  std::uint64_t index = 0;
  for (float& value : lattice) {
    value = random_share(seed, index++) - 0.5F;
  }
  return lattice;
}

/// Adds one octave of noise.
void add_octave(cv::Mat1f& picture, cv::Size cells, float strength, std::uint64_t seed) {
  const cv::Mat1f lattice = random_lattice(cells.height, cells.width, seed);
  const auto across = places(picture.cols, cells.width);
  const auto down = places(picture.rows, cells.height);
  std::vector<float> line(static_cast<std::size_t>(cells.width));
  for (int v = 0; v < picture.rows; ++v) {
    const Between& y = down[static_cast<std::size_t>(v)];
    for (int i = 0; i < cells.width; ++i) {
      line[static_cast<std::size_t>(i)] =
          strength * std::lerp(lattice(y.first, i), lattice(y.second, i), y.share);
    }
    float* const row = picture[v];
    for (int u = 0; u < picture.cols; ++u) {
      const Between& x = across[static_cast<std::size_t>(u)];
      const float from = line[static_cast<std::size_t>(x.first)];
      row[u] += from + x.share * (line[static_cast<std::size_t>(x.second)] - from);
    }
  }
}

/// Random points, one in each cell of a lattice that wraps.
class ScatteredPoints {
 public:
  ScatteredPoints(int cells, std::uint64_t seed) : cells_(cells), xs_(count()), ys_(count()) {
    for (std::size_t i = 0; i < xs_.size(); ++i) {
      xs_[i] = random_share(seed, 2 * i);
      ys_[i] = random_share(seed, 2 * i + 1);
    }
  }

  /// The nearest point's index and the distances (cells) to it and to the second nearest.
  void nearest(float x, float y, int& index, std::array<float, 2>& distances) const {
    std::array<float, 2> squares{1e9F, 1e9F};
    const int x0 = static_cast<int>(x);
    const int y0 = static_cast<int>(y);
    for (int j = y0 - 1; j <= y0 + 1; ++j) {
      for (int i = x0 - 1; i <= x0 + 1; ++i) {
        const int at = (j + cells_) % cells_ * cells_ + (i + cells_) % cells_;
        const float dx = static_cast<float>(i) + xs_[static_cast<std::size_t>(at)] - x;
        const float dy = static_cast<float>(j) + ys_[static_cast<std::size_t>(at)] - y;
        const float square = dx * dx + dy * dy;
        if (square < squares[0]) {
          squares = {square, squares[0]};
          index = at;
        } else {
          squares[1] = std::min(squares[1], square);
        }
      }
    }
    distances = {std::sqrt(squares[0]), std::sqrt(squares[1])};
  }

 private:
  [[nodiscard]] std::size_t count() const {
    return static_cast<std::size_t>(cells_) * static_cast<std::size_t>(cells_);
  }

  int cells_;
  std::vector<float> xs_;
  std::vector<float> ys_;
};

}  // namespace

cv::Mat1f fractal_noise(const NoiseShape& shape, std::uint64_t seed) {
  cv::Mat1f picture(shape.side_px, shape.side_px, 0.0F);
  float strength = 1.0F;
  cv::Size cells(shape.cells_x, shape.cells_y);
  for (int octave = 0; octave < shape.octaves; ++octave, strength *= shape.gain) {
    add_octave(picture, cells, strength, stirred(seed, static_cast<std::uint64_t>(octave)));
    cells.width = std::min(2 * cells.width, shape.side_px);
    cells.height = std::min(2 * cells.height, shape.side_px);
  }
  cv::Scalar mean;
  cv::Scalar deviation;
  cv::meanStdDev(picture, mean, deviation);
  const double scale = kSpread / std::max(deviation[0], 1e-9);
  picture.convertTo(picture, CV_32F, scale, 0.5 - scale * mean[0]);
  return picture;
}

CellNoise cell_noise(int side_px, int cells, std::uint64_t seed) {
  CellNoise noise{
      cv::Mat1f(side_px, side_px), cv::Mat1f(side_px, side_px), cv::Mat1f(side_px, side_px)};
  const ScatteredPoints points(cells, seed);
  const float scale = static_cast<float>(cells) / static_cast<float>(side_px);
  for (int v = 0; v < side_px; ++v) {
    for (int u = 0; u < side_px; ++u) {
      int index = 0;
      std::array<float, 2> distances{};
      points.nearest(
          scale * static_cast<float>(u), scale * static_cast<float>(v), index, distances);
      noise.nearest(v, u) = distances[0];
      noise.border(v, u) = distances[1] - distances[0];
      noise.tone(v, u) = random_share(~seed, static_cast<std::uint64_t>(index));
    }
  }
  return noise;
}

float hill_noise(float x, float y, std::uint64_t seed) noexcept {
  if (!(std::abs(x) < 1e6F) || !(std::abs(y) < 1e6F)) {
    return 0.0F;
  }
  const float x0 = std::floor(x);
  const float y0 = std::floor(y);
  const auto corner = [&](float i, float j) {
    const auto column = static_cast<std::uint64_t>(static_cast<std::int64_t>(x0 + i));
    const auto row = static_cast<std::uint64_t>(static_cast<std::int64_t>(y0 + j));
    return 2.0F * random_share(stirred(seed, column), row) - 1.0F;
  };
  const float share = smooth(x - x0);
  const float top = std::lerp(corner(0.0F, 0.0F), corner(1.0F, 0.0F), share);
  const float bottom = std::lerp(corner(0.0F, 1.0F), corner(1.0F, 1.0F), share);
  return std::lerp(top, bottom, smooth(y - y0));
}

}  // namespace skyhalo

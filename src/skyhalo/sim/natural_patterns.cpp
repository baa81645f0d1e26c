#include "skyhalo/sim/natural_patterns.hpp"

#include <cmath>
#include <numbers>

#include "skyhalo/sim/noise.hpp"
#include "skyhalo/sim/pattern_paint.hpp"
#include "skyhalo/sim/random_numbers.hpp"

namespace skyhalo {
namespace {

constexpr float kTurnRad = 2.0F * std::numbers::pi_v<float>;

void strew_leaves(cv::Mat3f& picture, int count, RandomNumbers& random) {
  for (int i = 0; i < count; ++i) {
    const cv::Point2f middle = random_point(random, picture.cols);
    const float length_px = random.uniform(8.0F, 20.0F);
    const float width_px = length_px * random.uniform(0.35F, 0.6F);
    const PaintBgr dry = random_colour(random, {0.14F, 0.24F, 0.38F}, {0.26F, 0.42F, 0.54F}, 0.45F);
    const PaintBgr green = random_colour(random, {0.10F, 0.30F, 0.20F}, {0.2F, 0.5F, 0.4F}, 0.3F);
    const PaintBgr colour = random.chance(0.2F) ? green : dry;
    const float angle_rad = random.uniform(0.0F, kTurnRad);
    const auto shadow =
        leaf_outline(middle + cv::Point2f(1.5F, 1.5F), length_px, width_px, angle_rad);
    stamp(picture, shadow, colour * 0.25F);
    stamp(picture, leaf_outline(middle, length_px, width_px, angle_rad), colour);
    const cv::Point2f half(std::cos(angle_rad) * length_px / 2.0F,
                           std::sin(angle_rad) * length_px / 2.0F);
    stroke(picture, middle - half, middle + half, 1.5F, colour * 1.35F);
  }
}

void strew_twigs(cv::Mat3f& picture, int count, RandomNumbers& random) {
  for (int i = 0; i < count; ++i) {
    const cv::Point2f from = random_point(random, picture.cols);
    const float angle_rad = random.uniform(0.0F, kTurnRad);
    const float length_px = random.uniform(20.0F, 90.0F);
    const cv::Point2f to = from + length_px * cv::Point2f(std::cos(angle_rad), std::sin(angle_rad));
    const PaintBgr colour =
        random_colour(random, {0.10F, 0.14F, 0.20F}, {0.35F, 0.42F, 0.48F}, 0.3F);
    stroke(picture, from, to, random.uniform(2.0F, 5.0F), colour);
  }
}

/// Blades of grass in all directions, most of them towards the top.
void strew_blades(cv::Mat3f& picture, int count, RandomNumbers& random) {
  for (int i = 0; i < count; ++i) {
    const cv::Point2f from = random_point(random, picture.cols);
    const float angle_rad = random.uniform(0.0F, kTurnRad);
    const float length_px = random.uniform(8.0F, 26.0F);
    const cv::Point2f to = from + length_px * cv::Point2f(std::cos(angle_rad), std::sin(angle_rad));
    const PaintBgr fresh =
        random_colour(random, {0.08F, 0.24F, 0.14F}, {0.22F, 0.56F, 0.42F}, 0.35F);
    const PaintBgr dry = random_colour(random, {0.2F, 0.4F, 0.4F}, {0.4F, 0.6F, 0.65F}, 0.2F);
    stroke(picture, from, to, random.uniform(1.5F, 3.5F), random.chance(0.15F) ? dry : fresh);
  }
}

}  // namespace

cv::Mat3f paint_forest_floor(std::uint64_t seed) {
  RandomNumbers random(seed);
  cv::Mat3f picture =
      blended(spots(1024, 6, 0.8F, random.bits()), {0.05F, 0.09F, 0.13F}, {0.20F, 0.30F, 0.40F});
  strew_leaves(picture, 3500, random);
  strew_twigs(picture, 250, random);
  strew_leaves(picture, 1200, random);
  shade(picture, spots(1024, 5, 0.9F, random.bits()), 1.6F);
  return picture;
}

cv::Mat3f paint_grass(std::uint64_t seed) {
  RandomNumbers random(seed);
  cv::Mat3f picture =
      blended(spots(1024, 12, 0.8F, random.bits()), {0.04F, 0.12F, 0.08F}, {0.16F, 0.34F, 0.26F});
  strew_blades(picture, 16000, random);
  shade(picture, spots(1024, 10, 0.85F, random.bits()), 1.5F);
  return picture;
}

cv::Mat3f paint_soil(std::uint64_t seed) {
  RandomNumbers random(seed);
  cv::Mat3f picture =
      blended(spots(512, 3, 0.85F, random.bits()), {0.10F, 0.16F, 0.22F}, {0.40F, 0.50F, 0.58F});
  const CellNoise pebbles = cell_noise(512, 40, random.bits());
  paint_over(picture,
             step(cv::Mat1f(pebbles.nearest + 0.6F * pebbles.tone), 0.35F, 0.2F),
             {0.50F, 0.56F, 0.60F},
             0.7F);
  strew_twigs(picture, 30, random);
  return picture;
}

cv::Mat3f paint_bark(std::uint64_t seed) {
  RandomNumbers random(seed);
  const NoiseShape upright{.side_px = 512, .cells_x = 16, .cells_y = 3, .octaves = 7, .gain = 0.8F};
  const cv::Mat1f ridges = fractal_noise(upright, random.bits());
  cv::Mat3f picture = blended(ridges, {0.05F, 0.08F, 0.10F}, {0.40F, 0.48F, 0.55F});
  const cv::Mat1f cracks = fractal_noise(
      {.side_px = 512, .cells_x = 20, .cells_y = 4, .octaves = 3, .gain = 0.5F}, random.bits());
  paint_over(picture, step(cv::Mat1f(cv::abs(cracks - 0.5F)), 0.06F, 0.01F), {0.03F, 0.04F, 0.05F});
  paint_over(picture,
             step(spots(512, 4, 0.8F, random.bits()), 0.68F, 0.8F),
             {0.20F, 0.38F, 0.30F},
             0.6F);  // moss
  shade(picture, spots(512, 8, 0.9F, random.bits()), 1.2F);
  return picture;
}

cv::Mat3f paint_leaf(std::uint64_t seed) {
  RandomNumbers random(seed);
  cv::Mat3f picture =
      blended(spots(512, 6, 0.8F, random.bits()), {0.05F, 0.20F, 0.12F}, {0.24F, 0.58F, 0.46F});
  const CellNoise veins = cell_noise(512, 24, random.bits());
  paint_over(picture, step(veins.border, 0.12F, 0.02F), {0.30F, 0.66F, 0.56F}, 0.5F);
  shade(picture, veins.tone, 0.9F);
  return picture;
}

cv::Mat3f paint_stone(std::uint64_t seed) {
  RandomNumbers random(seed);
  cv::Mat3f picture =
      blended(spots(512, 4, 0.85F, random.bits()), {0.20F, 0.21F, 0.22F}, {0.66F, 0.67F, 0.68F});
  const CellNoise cracks = cell_noise(512, 5, random.bits());
  paint_over(picture, step(cracks.border, 0.05F, 0.01F), {0.10F, 0.10F, 0.10F}, 0.8F);
  paint_over(picture,
             step(spots(512, 5, 0.8F, random.bits()), 0.66F, 0.78F),
             {0.25F, 0.42F, 0.36F},
             0.7F);  // lichen
  return picture;
}

cv::Mat3f paint_ripples(std::uint64_t seed) {
  RandomNumbers random(seed);
  const NoiseShape waves{.side_px = 512, .cells_x = 6, .cells_y = 12, .octaves = 7, .gain = 0.75F};
  return blended(fractal_noise(waves, random.bits()), {0.40F, 0.34F, 0.20F}, {0.90F, 0.84F, 0.68F});
}

cv::Mat3f paint_clouds(std::uint64_t seed) {
  const NoiseShape heaps{.side_px = 512, .cells_x = 4, .cells_y = 4, .octaves = 8, .gain = 0.55F};
  const cv::Mat1f cover = step(fractal_noise(heaps, seed), 0.45F, 0.85F);
  return blended(cover, {0.0F, 0.0F, 0.0F}, {1.0F, 1.0F, 1.0F});
}

cv::Mat3f paint_gravel(std::uint64_t seed) {
  RandomNumbers random(seed);
  const CellNoise stones = cell_noise(512, 36, random.bits());
  cv::Mat3f picture = blended(stones.tone, {0.28F, 0.32F, 0.35F}, {0.72F, 0.76F, 0.80F});
  paint_over(picture, step(stones.border, 0.22F, 0.02F), {0.10F, 0.11F, 0.12F});
  shade(picture, spots(512, 4, 0.9F, random.bits()), 1.5F);
  return picture;
}

}  // namespace skyhalo

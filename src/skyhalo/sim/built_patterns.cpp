#include "skyhalo/sim/built_patterns.hpp"

#include <cmath>
#include <numbers>
#include <opencv2/imgproc.hpp>

#include "skyhalo/sim/noise.hpp"
#include "skyhalo/sim/pattern_paint.hpp"
#include "skyhalo/sim/random_numbers.hpp"

namespace skyhalo {
namespace {

constexpr float kTurnRad = 2.0F * std::numbers::pi_v<float>;

/// Grain along the vertical, as of sawn wood.
cv::Mat1f grain(int side_px, std::uint64_t seed) {
  return fractal_noise(
      {.side_px = side_px, .cells_x = 48, .cells_y = 3, .octaves = 6, .gain = 0.85F}, seed);
}

/// Areas in rows, every second one shifted by half an area, each in a colour of its own.
void lay_courses(cv::Mat3f& picture, cv::Size area, int joint_px, RandomNumbers& random) {
  for (int row = 0; row * area.height < picture.rows; ++row) {
    const int shift = row % 2 == 0 ? 0 : area.width / 2;
    for (int col = 0; col * area.width < picture.cols; ++col) {
      const PaintBgr colour =
          random_colour(random, {0.16F, 0.22F, 0.48F}, {0.30F, 0.38F, 0.66F}, 0.35F);
      const cv::Rect brick(col * area.width + shift,
                           row * area.height,
                           area.width - joint_px,
                           area.height - joint_px);
      fill(picture, brick, colour);
      fill(picture, brick - cv::Point(picture.cols, 0), colour);
    }
  }
}

/// One window with its frame, panes and curtains.
void put_window(cv::Mat3f& picture, cv::Rect area, RandomNumbers& random) {
  const PaintBgr frame = random_colour(random, {0.7F, 0.72F, 0.75F}, {0.9F, 0.92F, 0.95F}, 0.1F);
  fill(picture, area + cv::Size(12, 0) - cv::Point(6, 0), frame * 0.75F);
  fill(picture, area, frame);
  const int pane_width = area.width / 2 - 9;
  for (int pane = 0; pane < 2; ++pane) {
    const cv::Rect glass(
        area.x + 6 + pane * (pane_width + 6), area.y + 6, pane_width, area.height - 12);
    fill(picture, glass, random_colour(random, {0.10F, 0.09F, 0.07F}, {0.34F, 0.30F, 0.25F}, 0.2F));
    const int curtain = random.below(glass.width);
    const cv::Rect cloth(
        pane == 0 ? glass.x : glass.x + glass.width - curtain, glass.y, curtain, glass.height);
    fill(picture, cloth, random_colour(random, {0.3F, 0.4F, 0.5F}, {0.8F, 0.8F, 0.8F}, 0.2F));
  }
  fill(picture, {area.x + 6, area.y + area.height / 3, area.width - 12, 5}, frame);
  fill(picture, {area.x - 10, area.y + area.height, area.width + 20, 8}, frame * 0.9F);
  fill(picture, {area.x - 10, area.y + area.height + 8, area.width + 20, 5}, frame * 0.3F);
}

}  // namespace

cv::Mat3f paint_asphalt(std::uint64_t seed) {
  RandomNumbers random(seed);
  cv::Mat3f picture =
      blended(spots(1024, 3, 0.95F, random.bits()), {0.08F, 0.08F, 0.08F}, {0.50F, 0.50F, 0.50F});
  CellNoise patches = cell_noise(256, 3, random.bits());
  cv::resize(patches.tone, patches.tone, {1024, 1024}, 0.0, 0.0, cv::INTER_NEAREST);
  cv::resize(patches.border, patches.border, {1024, 1024});
  shade(picture, patches.tone, 0.35F);
  paint_over(picture, step(patches.border, 0.02F, 0.005F), {0.06F, 0.06F, 0.06F}, 0.8F);
  for (int i = 0; i < 4000; ++i) {
    const cv::Point2f pebble = random_point(random, 1024);
    const PaintBgr colour = random_colour(random, {0.35F, 0.36F, 0.38F}, {0.7F, 0.7F, 0.7F}, 0.2F);
    stamp(picture, leaf_outline(pebble, 5.0F, 4.0F, random.uniform(0.0F, kTurnRad)), colour);
  }
  paint_over(picture,
             step(spots(1024, 4, 0.6F, random.bits()), 0.68F, 0.8F),
             {0.07F, 0.07F, 0.08F},
             0.5F);  // oil
  return picture;
}

cv::Mat3f paint_brick(std::uint64_t seed) {
  RandomNumbers random(seed);
  cv::Mat3f picture(512, 512, cv::Vec3f(0.55F, 0.60F, 0.62F));
  lay_courses(picture, {64, 32}, 4, random);
  shade(picture, spots(512, 32, 0.9F, random.bits()), 0.9F);
  shade(picture, spots(512, 3, 0.7F, random.bits()), 0.7F);
  return picture;
}

cv::Mat3f paint_plaster(std::uint64_t seed) {
  RandomNumbers random(seed);
  cv::Mat3f picture =
      blended(spots(512, 3, 0.85F, random.bits()), {0.44F, 0.52F, 0.58F}, {0.78F, 0.88F, 0.94F});
  shade(picture, spots(512, 64, 0.9F, random.bits()), 0.6F);
  const cv::Mat1f streaks = fractal_noise(
      {.side_px = 512, .cells_x = 24, .cells_y = 2, .octaves = 4, .gain = 0.6F}, random.bits());
  paint_over(picture, step(streaks, 0.66F, 0.8F), {0.30F, 0.34F, 0.36F}, 0.4F);
  return picture;
}

cv::Mat3f paint_concrete(std::uint64_t seed) {
  RandomNumbers random(seed);
  cv::Mat3f picture =
      blended(spots(512, 3, 0.88F, random.bits()), {0.32F, 0.34F, 0.35F}, {0.72F, 0.74F, 0.75F});
  const CellNoise holes = cell_noise(512, 20, random.bits());
  paint_over(picture,
             step(cv::Mat1f(holes.nearest + holes.tone), 0.16F, 0.10F),
             {0.12F, 0.12F, 0.12F},
             0.8F);
  const CellNoise cracks = cell_noise(512, 3, random.bits());
  paint_over(picture, step(cracks.border, 0.02F, 0.005F), {0.15F, 0.15F, 0.15F}, 0.7F);
  return picture;
}

cv::Mat3f paint_planks(std::uint64_t seed) {
  RandomNumbers random(seed);
  cv::Mat3f picture =
      blended(grain(512, random.bits()), {0.12F, 0.22F, 0.32F}, {0.44F, 0.60F, 0.74F});
  for (int board = 0; board < 8; ++board) {
    const cv::Rect area(board * 64, 0, 64, 512);
    brighten(picture, area, random.uniform(0.6F, 1.25F));
    fill(picture, {board * 64, 0, 4, 512}, {0.04F, 0.06F, 0.08F});
    const int end = random.below(500);
    fill(picture, {board * 64, end, 64, 4}, {0.05F, 0.07F, 0.09F});
    for (int knot = 0; knot < 5; ++knot) {
      const cv::Point2f middle(static_cast<float>(board * 64 + 10 + random.below(46)),
                               random.uniform(0.0F, 512.0F));
      stamp(picture, leaf_outline(middle, 13.0F, 8.0F, 1.57F), {0.07F, 0.11F, 0.16F});
    }
  }
  shade(picture, spots(512, 6, 0.9F, random.bits()), 0.8F);
  return picture;
}

cv::Mat3f paint_corrugated(std::uint64_t seed) {
  RandomNumbers random(seed);
  cv::Mat3f picture(512, 512);
  for (int u = 0; u < 512; ++u) {
    const float wave = std::cos(static_cast<float>(u) * kTurnRad / 32.0F);
    picture.col(u).setTo(cv::Vec3f::all(0.62F + 0.26F * wave));
  }
  shade(picture, spots(512, 4, 0.9F, random.bits()), 1.1F);
  const cv::Mat1f rust = fractal_noise(
      {.side_px = 512, .cells_x = 10, .cells_y = 3, .octaves = 7, .gain = 0.75F}, random.bits());
  paint_over(picture, step(rust, 0.62F, 0.78F), {0.12F, 0.22F, 0.40F}, 0.8F);
  fill(picture, {0, 250, 512, 5}, {0.2F, 0.2F, 0.2F});
  return picture;
}

cv::Mat3f paint_facade(std::uint64_t seed) {
  RandomNumbers random(seed);
  cv::Mat3f picture;
  cv::resize(paint_plaster(random.bits()), picture, {1024, 1024});
  for (int row = 0; row < 4; ++row) {
    fill(picture, {0, row * 256 + 4, 1024, 10}, {0.42F, 0.46F, 0.50F});
    fill(picture, {0, row * 256 + 14, 1024, 4}, {0.15F, 0.16F, 0.18F});
    for (int col = 0; col < 4; ++col) {
      put_window(picture, {col * 256 + 66, row * 256 + 54, 124, 148}, random);
    }
  }
  shade(picture, spots(1024, 32, 0.9F, random.bits()), 0.6F);
  return picture;
}

cv::Mat3f paint_wall_paint(std::uint64_t seed) {
  return blended(fractal_noise({.side_px = 512, .cells_x = 2, .cells_y = 2, .octaves = 3}, seed),
                 {0.77F, 0.80F, 0.81F},
                 {0.79F, 0.82F, 0.83F});
}

cv::Mat3f paint_tiles(std::uint64_t seed) {
  RandomNumbers random(seed);
  cv::Mat3f picture(512, 512, cv::Vec3f(0.16F, 0.17F, 0.18F));
  for (int row = 0; row < 8; ++row) {
    for (int col = 0; col < 8; ++col) {
      fill(picture,
           {col * 64, row * 64, 60, 60},
           random_colour(random, {0.45F, 0.48F, 0.52F}, {0.62F, 0.68F, 0.72F}, 0.2F));
    }
  }
  shade(picture, spots(512, 5, 0.9F, random.bits()), 1.3F);
  return picture;
}

}  // namespace skyhalo

#include "skyhalo/sim/goods_patterns.hpp"

#include <numbers>

#include "skyhalo/sim/noise.hpp"
#include "skyhalo/sim/pattern_paint.hpp"
#include "skyhalo/sim/random_numbers.hpp"

namespace skyhalo {
namespace {

constexpr int kSidePx = 512;
const PaintBgr kInk(0.10F, 0.11F, 0.13F);

/// Rows of short bars that look like words.
void write_lines(cv::Mat3f& picture, cv::Rect area, int row_px, RandomNumbers& random) {
  for (int y = area.y; y + row_px < area.y + area.height; y += 2 * row_px) {
    int x = area.x;
    while (x < area.x + area.width) {
      const int length = 4 + random.below(5 * row_px);
      fill(picture, cv::Rect(x, y, length, row_px) & area, kInk);
      x += length + row_px;
    }
  }
}

void print_bar_code(cv::Mat3f& picture, cv::Rect area, RandomNumbers& random) {
  for (int x = area.x; x < area.x + area.width;) {
    const int width = 2 + random.below(5);
    fill(picture, cv::Rect(x, area.y, width, area.height) & area, kInk);
    x += width + 2 + random.below(5);
  }
}

/// A white label with words and a bar code.
void stick_label(cv::Mat3f& picture, cv::Point corner, RandomNumbers& random) {
  const cv::Rect area(corner, cv::Size(170, 130));
  fill(picture, area, {0.86F, 0.88F, 0.90F});
  write_lines(picture, {corner.x + 10, corner.y + 10, 150, 50}, 5, random);
  print_bar_code(picture, {corner.x + 14, corner.y + 68, 142, 50}, random);
}

/// A big mark in one colour: a maker's sign.
void print_sign(cv::Mat3f& picture, cv::Point2f middle, RandomNumbers& random) {
  const PaintBgr colour = random_colour(random, {0.5F, 0.2F, 0.1F}, {0.1F, 0.15F, 0.6F}, 0.3F);
  const float turn_rad = random.uniform(0.0F, std::numbers::pi_v<float>);
  for (int i = 0; i < 3; ++i) {
    const float angle_rad = turn_rad + 1.047F * static_cast<float>(i);
    stamp(picture, leaf_outline(middle, 120.0F, 36.0F, angle_rad), colour);
  }
}

}  // namespace

cv::Mat3f paint_cardboard(std::uint64_t seed) {
  RandomNumbers random(seed);
  cv::Mat3f picture = blended(
      spots(kSidePx, 4, 0.85F, random.bits()), {0.24F, 0.38F, 0.52F}, {0.46F, 0.64F, 0.80F});
  const int tape = 40 + random.below(300);
  fill(picture, {0, tape, kSidePx, 44}, {0.46F, 0.62F, 0.72F});
  fill(picture, {0, tape + 20, kSidePx, 3}, {0.12F, 0.18F, 0.25F});
  print_sign(picture, {random.uniform(90.0F, 420.0F), random.uniform(90.0F, 420.0F)}, random);
  write_lines(picture, {30 + random.below(180), 400 + random.below(30), 240, 70}, 9, random);
  stick_label(picture, {20 + random.below(300), 30 + random.below(330)}, random);
  const cv::Mat1f fibres = fractal_noise(
      {.side_px = kSidePx, .cells_x = 64, .cells_y = 8, .octaves = 4, .gain = 0.9F}, random.bits());
  shade(picture, fibres, 0.6F);
  shade(picture, spots(kSidePx, 3, 0.8F, random.bits()), 0.7F);
  fill(picture, {0, 0, kSidePx, 5}, {0.10F, 0.16F, 0.22F});
  fill(picture, {0, 0, 5, kSidePx}, {0.10F, 0.16F, 0.22F});
  return picture;
}

cv::Mat3f paint_crate(std::uint64_t seed) {
  RandomNumbers random(seed);
  const NoiseShape along{
      .side_px = kSidePx, .cells_x = 3, .cells_y = 48, .octaves = 6, .gain = 0.85F};
  cv::Mat3f picture =
      blended(fractal_noise(along, random.bits()), {0.14F, 0.26F, 0.38F}, {0.44F, 0.62F, 0.78F});
  for (int board = 0; board < 6; ++board) {
    brighten(picture, cv::Rect(0, board * 85, kSidePx, 85), random.uniform(0.65F, 1.2F));
    fill(picture, {0, board * 85, kSidePx, 8}, {0.04F, 0.05F, 0.06F});
  }
  for (const int x : {0, kSidePx - 64}) {
    brighten(picture, cv::Rect(x, 0, 64, kSidePx), 1.3F);
    fill(picture, {x, 0, 5, kSidePx}, {0.06F, 0.09F, 0.12F});
    fill(picture, {x + 59, 0, 5, kSidePx}, {0.06F, 0.09F, 0.12F});
  }
  write_lines(picture, {120, 200, 270, 110}, 16, random);
  shade(picture, spots(kSidePx, 6, 0.9F, random.bits()), 0.9F);
  return picture;
}

cv::Mat3f paint_cloth(std::uint64_t seed) {
  RandomNumbers random(seed);
  const PaintBgr first = random_colour(random, {0.2F, 0.2F, 0.5F}, {0.6F, 0.4F, 0.2F}, 0.3F);
  const PaintBgr second = random_colour(random, {0.7F, 0.7F, 0.7F}, {0.3F, 0.6F, 0.7F}, 0.2F);
  const int square_px = 16 << random.below(3);
  cv::Mat3f picture(kSidePx, kSidePx);
  for (int v = 0; v < kSidePx; ++v) {
    for (int u = 0; u < kSidePx; ++u) {
      const int lines = u / square_px % 2 + v / square_px % 2;
      picture(v, u) = first + 0.5F * static_cast<float>(lines) * (second - first);
    }
  }
  shade(picture, spots(kSidePx, 5, 0.9F, random.bits()), 1.3F);
  return picture;
}

cv::Mat3f paint_metal(std::uint64_t seed) {
  RandomNumbers random(seed);
  cv::Mat3f picture = blended(
      spots(kSidePx, 3, 0.85F, random.bits()), {0.55F, 0.55F, 0.55F}, {0.95F, 0.95F, 0.95F});
  for (int i = 0; i < 220; ++i) {
    const cv::Point2f from = random_point(random, kSidePx);
    const float tilt = random.uniform(-8.0F, 8.0F);
    const cv::Point2f to = from + cv::Point2f(random.uniform(10.0F, 70.0F), tilt);
    const float tone = random.chance(0.5F) ? 0.3F : 1.0F;
    stroke(picture, from, to, 2.0F, PaintBgr::all(tone));
  }
  paint_over(picture,
             step(spots(kSidePx, 5, 0.8F, random.bits()), 0.62F, 0.8F),
             {0.20F, 0.26F, 0.30F},
             0.5F);  // dirt
  return picture;
}

}  // namespace skyhalo

#include "skyhalo/sim/pattern_paint.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "skyhalo/sim/noise.hpp"

namespace skyhalo {
namespace {

/// Calls `draw(shift)` for each copy of what lies in `extent` that touches the picture.
template <typename Draw>
void for_each_copy(const cv::Mat3f& picture, const cv::Rect2f& extent, const Draw& draw) {
  const cv::Rect2f whole(
      0.0F, 0.0F, static_cast<float>(picture.cols), static_cast<float>(picture.rows));
  for (int j = -1; j <= 1; ++j) {
    for (int i = -1; i <= 1; ++i) {
      const cv::Point2f shift(static_cast<float>(i) * whole.width,
                              static_cast<float>(j) * whole.height);
      if (((extent + shift) & whole).area() > 0.0F) {
        draw(shift);
      }
    }
  }
}

}  // namespace

cv::Mat3f blended(const cv::Mat1f& share, const PaintBgr& from, const PaintBgr& to) {
  cv::Mat3f picture(share.size());
  std::transform(share.begin(), share.end(), picture.begin(), [&](float value) {
    return from + std::clamp(value, 0.0F, 1.0F) * (to - from);
  });
  return picture;
}

cv::Mat1f spots(int side_px, int cells, float gain, std::uint64_t seed) {
  return fractal_noise({.side_px = side_px, .cells_x = cells, .cells_y = cells, .gain = gain},
                       seed);
}

void fill(cv::Mat3f& picture, cv::Rect area, const PaintBgr& colour) {
  picture(area & cv::Rect(0, 0, picture.cols, picture.rows)).setTo(colour);
}

void brighten(cv::Mat3f& picture, cv::Rect area, float factor) {
  cv::Mat3f part = picture(area);
  part *= static_cast<double>(factor);
}

void paint_over(cv::Mat3f& picture,
                const cv::Mat1f& amount,
                const PaintBgr& colour,
                float thickness) {
  std::transform(picture.begin(),
                 picture.end(),
                 amount.begin(),
                 picture.begin(),
                 [&](const PaintBgr& was, float a) {
                   return was + std::clamp(thickness * a, 0.0F, 1.0F) * (colour - was);
                 });
}

void shade(cv::Mat3f& picture, const cv::Mat1f& noise, float strength) {
  std::transform(
      picture.begin(),
      picture.end(),
      noise.begin(),
      picture.begin(),
      [&](const PaintBgr& was, float n) { return was * (1.0F + strength * (n - 0.5F)); });
}

cv::Mat1f step(const cv::Mat1f& values, float from, float to) {
  cv::Mat1f result(values.size());
  std::transform(values.begin(), values.end(), result.begin(), [&](float value) {
    const float t = std::clamp((value - from) / (to - from), 0.0F, 1.0F);
    return t * t * (3.0F - 2.0F * t);
  });
  return result;
}

cv::Mat3b finished(const cv::Mat3f& picture) {
  cv::Mat3b bytes;
  picture.convertTo(bytes, CV_8U, 255.0);
  return bytes;
}

void stamp(cv::Mat3f& picture, const std::vector<cv::Point2f>& corners, const PaintBgr& colour) {
  cv::Point2f low = corners.front();
  cv::Point2f high = low;
  for (const cv::Point2f& corner : corners) {
    low = {std::min(low.x, corner.x), std::min(low.y, corner.y)};
    high = {std::max(high.x, corner.x), std::max(high.y, corner.y)};
  }
  const cv::Point2f margin(1.0F, 1.0F);
  for_each_copy(picture, cv::Rect2f(low - margin, high + margin), [&](cv::Point2f shift) {
    std::vector<cv::Point> moved;
    moved.reserve(corners.size());
    for (const cv::Point2f& corner : corners) {
      moved.emplace_back(cvRound(corner.x + shift.x), cvRound(corner.y + shift.y));
    }
    cv::fillConvexPoly(picture, moved, cv::Scalar(colour[0], colour[1], colour[2]));
  });
}

void stroke(
    cv::Mat3f& picture, cv::Point2f from, cv::Point2f to, float width_px, const PaintBgr& colour) {
  const cv::Point2f along = to - from;
  const float length = std::max(std::hypot(along.x, along.y), 1e-3F);
  const cv::Point2f aside(-along.y * width_px / (2.0F * length),
                          along.x * width_px / (2.0F * length));
  stamp(picture, {from - aside, from + aside, to}, colour);
}

std::vector<cv::Point2f> leaf_outline(cv::Point2f middle,
                                      float length_px,
                                      float width_px,
                                      float angle_rad) {
  const cv::Point2f along(std::cos(angle_rad) * length_px / 2.0F,
                          std::sin(angle_rad) * length_px / 2.0F);
  const cv::Point2f aside(-std::sin(angle_rad) * width_px / 2.0F,
                          std::cos(angle_rad) * width_px / 2.0F);
  return {middle + along,
          middle + 0.4F * along + 0.8F * aside,
          middle - 0.3F * along + aside,
          middle - along,
          middle - 0.3F * along - aside,
          middle + 0.4F * along - 0.8F * aside};
}

cv::Point2f random_point(RandomNumbers& random, int side_px) {
  const float x = random.uniform() * static_cast<float>(side_px);
  return {x, random.uniform() * static_cast<float>(side_px)};
}

PaintBgr random_colour(RandomNumbers& random,
                       const PaintBgr& from,
                       const PaintBgr& to,
                       float variation) {
  const PaintBgr between = from + random.uniform() * (to - from);
  return between * (1.0F + random.uniform(-variation, variation));
}

}  // namespace skyhalo

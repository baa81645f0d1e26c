#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "skyhalo/sim/random_numbers.hpp"

namespace skyhalo {

/// Blue, green, red in 0...1, as in all these.
using PaintBgr = cv::Vec3f;

/// From one colour to another as `share` goes from 0 to 1; beyond, it stays.
[[nodiscard]] cv::Mat3f blended(const cv::Mat1f& share, const PaintBgr& from, const PaintBgr& to);

/// Noise from `cells` spots across down to single pixels; see `NoiseShape`.
[[nodiscard]] cv::Mat1f spots(int side_px, int cells, float gain, std::uint64_t seed);

/// Paints over the picture with a colour, as thickly as `amount` (0...1, else clamped) times
/// `thickness` says.
void paint_over(cv::Mat3f& picture,
                const cv::Mat1f& amount,
                const PaintBgr& colour,
                float thickness = 1.0F);

/// Fills what of a rectangle lies in the picture.
void fill(cv::Mat3f& picture, cv::Rect area, const PaintBgr& colour);

/// Multiplies the colours of a rectangle, which lies in the picture.
void brighten(cv::Mat3f& picture, cv::Rect area, float factor);

/// Multiplies each pixel with 1 + strength * (noise - 0.5).
void shade(cv::Mat3f& picture, const cv::Mat1f& noise, float strength);

/// 0 below `from`, 1 above `to`, smooth between; `from` may be the larger.
[[nodiscard]] cv::Mat1f step(const cv::Mat1f& values, float from, float to);

/// With the values as bytes.
[[nodiscard]] cv::Mat3b finished(const cv::Mat3f& picture);

/// Fills a polygon that may reach over the edges, where it comes in again at the other side.
/// The corners are pixels.
void stamp(cv::Mat3f& picture, const std::vector<cv::Point2f>& corners, const PaintBgr& colour);

/// A stroke of a width from `from` to `to` that wraps likewise, pointed at its end.
void stroke(
    cv::Mat3f& picture, cv::Point2f from, cv::Point2f to, float width_px, const PaintBgr& colour);

/// A leaf's outline round a middle.
[[nodiscard]] std::vector<cv::Point2f> leaf_outline(cv::Point2f middle,
                                                    float length_px,
                                                    float width_px,
                                                    float angle_rad);

/// A random point in a square picture.
[[nodiscard]] cv::Point2f random_point(RandomNumbers& random, int side_px);

/// A colour between two, brighter or darker by up to `variation`.
[[nodiscard]] PaintBgr random_colour(RandomNumbers& random,
                                     const PaintBgr& from,
                                     const PaintBgr& to,
                                     float variation);

}  // namespace skyhalo

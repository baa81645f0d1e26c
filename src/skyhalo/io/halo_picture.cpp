#include "skyhalo/io/halo_picture.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <opencv2/imgproc.hpp>
#include <string>
#include <vector>

#include "skyhalo/base/number_text.hpp"
#include "skyhalo/geometry/angle.hpp"
#include "skyhalo/io/colour.hpp"

namespace skyhalo {

const cv::Vec3b HaloColours::kFree(226, 234, 238);
const cv::Vec3b HaloColours::kUnseen(48, 48, 48);
const cv::Vec3b HaloColours::kPartly(190, 190, 190);
const cv::Vec3b HaloColours::kBeyond(128, 128, 128);

namespace {

constexpr double kNearM = 1.0;
constexpr double kFarM = 33.0;
constexpr std::array kLegendM{1.0, 2.0, 4.0, 8.0, 16.0, 33.0};
const cv::Vec3b kPaper(255, 255, 255);
const cv::Vec3b kInk(40, 40, 40);
const cv::Vec3b kLine(150, 150, 150);
const cv::Vec3b kUnseenLine(84, 84, 84);
const cv::Vec3b kPartlyLine(140, 140, 140);
constexpr int kFont = cv::FONT_HERSHEY_SIMPLEX;

/// Writes a text whose middle is at `middle`.
void put_text(cv::Mat3b& picture,
              const std::string& text,
              const cv::Point& middle,
              double scale,
              const cv::Scalar& colour) {
  int below_px = 0;
  const cv::Size size = cv::getTextSize(text, kFont, scale, 1, &below_px);
  const cv::Point origin(middle.x - size.width / 2, middle.y + size.height / 2);
  cv::putText(picture, text, origin, kFont, scale, colour, 1, cv::LINE_AA);
}

double font_scale(int width_px) {
  return std::clamp(width_px / 1080.0, 0.3, 1.0) * 0.5;
}

// --- unrolled ---

cv::Mat3b unrolled_cells(const Halo& halo) {
  const GridGeometry& grid = halo.geometry();
  cv::Mat3b cells(grid.rows, grid.cols);
  for (int row = 0; row < grid.rows; ++row) {
    for (int col = 0; col < grid.cols; ++col) {
      const auto depth_m = halo.depth_m({row, col});
      const cv::Vec3b& nothing =
          halo.sight({row, col}) == Sight::kFree ? HaloColours::kFree : HaloColours::kUnseen;
      cells(row, grid.cols - 1 - col) = depth_m ? range_colour(*depth_m) : nothing;
    }
  }
  return cells;
}

/// Colours what is below a line half way to the line's colour.
void shade(cv::Mat3b& picture, const cv::Rect& line) {
  cv::Mat3b part = picture(line & cv::Rect({0, 0}, picture.size()));
  part = 0.5 * part + 0.5 * cv::Mat3b(part.size(), kLine);
}

void draw_lines(cv::Mat3b& sphere) {
  for (int eighth = 1; eighth < 8; ++eighth) {
    shade(sphere, {sphere.cols * eighth / 8, 0, 1, sphere.rows});
  }
  shade(sphere, {0, sphere.rows / 2, sphere.cols, 1});
}

/// The azimuths below the sphere, from straight behind over the left side.
cv::Mat3b azimuth_strip(int width_px) {
  constexpr std::array kNames{
      "135 left", "90 left", "45 left", "ahead", "45 right", "90 right", "135 right"};
  const double scale = font_scale(width_px);
  cv::Mat3b strip(static_cast<int>(std::lround(44 * scale)), width_px, kPaper);
  for (std::size_t i = 0; i < kNames.size(); ++i) {
    const cv::Point middle(width_px * (static_cast<int>(i) + 1) / 8, strip.rows / 2);
    put_text(strip, kNames[i], middle, scale, kInk);
  }
  return strip;
}

/// Which place of a bar of the width stands for a range; the inverse of `range_colour`'s scale.
int bar_px(double range_m, int width_px) {
  const double share = std::log(range_m / kNearM) / std::log(kFarM / kNearM);
  return static_cast<int>(std::lround(share * (width_px - 1)));
}

void draw_range_bar(cv::Mat3b& strip, const cv::Rect& bar, double scale) {
  for (int i = 0; i < bar.width; ++i) {
    const double range_m = kNearM * std::pow(kFarM / kNearM, i / std::max(1.0, bar.width - 1.0));
    strip(cv::Rect(bar.x + i, bar.y, 1, bar.height)).setTo(range_colour(range_m));
  }
  for (const double range_m : kLegendM) {
    const cv::Point middle(bar.x + bar_px(range_m, bar.width), bar.y + 2 * bar.height);
    put_text(strip, number_text("%.0f m", range_m), middle, scale, kInk);
  }
}

cv::Mat3b legend_strip(int width_px) {
  const double scale = font_scale(width_px);
  const int unit_px = std::max(2, static_cast<int>(std::lround(24 * scale)));
  cv::Mat3b strip(3 * unit_px, width_px, kPaper);
  draw_range_bar(strip, {width_px / 16, unit_px / 4, width_px / 2, unit_px}, scale);
  int left_px = width_px * 11 / 16;
  for (const auto& [name, colour] :
       {std::pair{"free", HaloColours::kFree}, std::pair{"not seen", HaloColours::kUnseen}}) {
    const cv::Rect box =
        cv::Rect(left_px, unit_px / 4, width_px / 16, unit_px) & cv::Rect({0, 0}, strip.size());
    strip(box).setTo(colour);
    cv::rectangle(strip, box, kLine);
    put_text(strip, name, {box.x + box.width / 2, box.y + 2 * unit_px}, scale, kInk);
    left_px += width_px / 8;
  }
  return strip;
}

// --- from above ---

/// The picture from above: pixels and metres.
struct Disc {
  int size_px;
  double max_range_m;
  double px_per_m;

  Disc(int size, double range_m)
      : size_px(size), max_range_m(range_m), px_per_m(0.48 * size / range_m) {}

  /// Forward and left (m) of a pixel's middle.
  [[nodiscard]] Eigen::Vector2d place_m(int u, int v) const {
    const double middle = 0.5 * (size_px - 1);
    return {(middle - v) / px_per_m, (middle - u) / px_per_m};
  }

  [[nodiscard]] cv::Point pixel(double forward_m, double left_m) const {
    const double middle = 0.5 * (size_px - 1);
    return {cvRound(middle - left_m * px_per_m), cvRound(middle - forward_m * px_per_m)};
  }
};

std::size_t sector_of(const Eigen::Vector2d& place_m) {
  const double turns = std::atan2(place_m.y(), place_m.x()) / (2.0 * std::numbers::pi);
  const long sector = std::lround(turns * kRingSectors);
  return static_cast<std::size_t>((sector + kRingSectors) % kRingSectors);
}

/// What a sector says of the places at a range; an obstacle's edge is `edge_m` thick. Lines of a
/// hatch differ where it is not known to be free.
cv::Vec3b colour_at(const RegionView& sector, double range_m, double edge_m, bool on_line) {
  if (range_m >= sector.nearest_m) {
    return range_m < sector.nearest_m + edge_m ? range_colour(sector.nearest_m)
                                               : HaloColours::kBeyond;
  }
  if (sector.cells > 0 && range_m < sector.free_to_m) {
    return HaloColours::kFree;
  }
  if (sector.nearest_cell) {
    return on_line ? kPartlyLine : HaloColours::kPartly;
  }
  return on_line ? kUnseenLine : HaloColours::kUnseen;
}

void paint_sectors(cv::Mat3b& picture, const Disc& disc, const Ring& ring) {
  constexpr double kEdgeShare = 0.03;
  const double edge_m = kEdgeShare * disc.max_range_m;
  const int hatch_px = std::max(4, disc.size_px / 72);
  const int line_px = std::max(1, hatch_px / 6);
  for (int v = 0; v < picture.rows; ++v) {
    for (int u = 0; u < picture.cols; ++u) {
      const Eigen::Vector2d place_m = disc.place_m(u, v);
      if (place_m.norm() <= disc.max_range_m) {
        const RegionView& sector = ring[sector_of(place_m)];
        picture(v, u) = colour_at(sector, place_m.norm(), edge_m, (u + v) % hatch_px < line_px);
      }
    }
  }
}

/// A round number of metres, so that there are at most five rings.
double ring_step_m(double max_range_m) {
  const double least_m = max_range_m / 5.0;
  const double decade_m = std::pow(10.0, std::floor(std::log10(least_m)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * decade_m >= least_m * (1.0 - 1e-9)) {
      return factor * decade_m;
    }
  }
  return 10.0 * decade_m;
}

void draw_rings(cv::Mat3b& picture, const Disc& disc) {
  const double step_m = ring_step_m(disc.max_range_m);
  const cv::Point middle = disc.pixel(0.0, 0.0);
  const double scale = font_scale(disc.size_px) * 1.2;
  for (int i = 1; i * step_m <= disc.max_range_m * (1.0 + 1e-9); ++i) {
    const int radius_px = cvRound(i * step_m * disc.px_per_m);
    cv::circle(picture, middle, radius_px, kLine, 1, cv::LINE_AA);
    // Right of straight behind, where forward-looking vehicles see nothing.
    const std::string text = number_text("%g m", i * step_m);
    const cv::Point place = disc.pixel(-i * step_m * std::cos(0.35), -i * step_m * std::sin(0.35));
    const cv::Size size = cv::getTextSize(text, kFont, scale, 1, nullptr);
    const cv::Rect box(place.x - size.width / 2 - 3,
                       place.y - size.height / 2 - 3,
                       size.width + 6,
                       size.height + 6);
    cv::rectangle(picture, box, kPaper, cv::FILLED);
    put_text(picture, text, place, scale, kInk);
  }
}

void draw_body(cv::Mat3b& picture, const Disc& disc) {
  const int r = std::max(3, disc.size_px / 60);
  const cv::Point middle = disc.pixel(0.0, 0.0);
  const std::array<cv::Point, 3> corners{middle + cv::Point(0, -r),
                                         middle + cv::Point(-r * 2 / 3, r),
                                         middle + cv::Point(r * 2 / 3, r)};
  cv::fillConvexPoly(picture, corners.data(), 3, cv::Scalar(40, 40, 200), cv::LINE_AA);
  cv::polylines(picture, corners, true, kPaper, 1, cv::LINE_AA);
}

}  // namespace

cv::Vec3b range_colour(double range_m) noexcept {
  return scale_colour(1.0 - std::log(range_m / kNearM) / std::log(kFarM / kNearM));
}

cv::Mat3b halo_picture(const Halo& halo, int cell_px) {
  cv::Mat3b sphere;
  cv::resize(unrolled_cells(halo), sphere, {}, cell_px, cell_px, cv::INTER_NEAREST);
  draw_lines(sphere);
  cv::Mat3b picture;
  cv::vconcat(std::vector<cv::Mat>{sphere, azimuth_strip(sphere.cols), legend_strip(sphere.cols)},
              picture);
  return picture;
}

cv::Mat3b halo_top_picture(const Halo& halo,
                           const PitchBand& pitch,
                           const Eigen::Matrix3d& R_map_body,
                           double max_range_m,
                           int size_px) {
  const Disc disc(size_px, max_range_m);
  cv::Mat3b picture(size_px, size_px, kPaper);
  paint_sectors(picture, disc, ring_of(halo, pitch, R_map_body));
  draw_rings(picture, disc);
  draw_body(picture, disc);
  return picture;
}

}  // namespace skyhalo

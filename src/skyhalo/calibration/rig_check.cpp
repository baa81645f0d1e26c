#include "skyhalo/calibration/rig_check.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "skyhalo/base/error.hpp"
#include "skyhalo/base/number_text.hpp"
#include "skyhalo/calibration/rig_findings.hpp"
#include "skyhalo/geometry/angle.hpp"

namespace skyhalo {
namespace {

/// Share of the rectified pixels that both raw cameras see, on a raster of 64 x 64.
double seen_share(const StereoPair& pair) {
  if (!pair.raw) {
    return 1.0;
  }
  constexpr int kRaster = 64;
  int seen = 0;
  for (int row = 0; row < kRaster; ++row) {
    for (int col = 0; col < kRaster; ++col) {
      const Eigen::Vector3d ray = ray_of(pair.model,
                                         (col + 0.5) / kRaster * pair.image_size_px.width - 0.5,
                                         (row + 0.5) / kRaster * pair.image_size_px.height - 0.5);
      seen += sees(pair.raw->left, pair.raw->R_left_cam * ray) &&
                      sees(pair.raw->right, pair.raw->R_right_cam * ray)
                  ? 1
                  : 0;
    }
  }
  return static_cast<double>(seen) / (kRaster * kRaster);
}

/// Share of the matched pixels that masks and rcrop leave, on a raster of 64 x 64.
double kept_share(const StereoPair& pair, const cv::Size& matched_px, int downscale, int rcrop_px) {
  constexpr int kRaster = 64;
  int kept = 0;
  for (int row = 0; row < kRaster; ++row) {
    for (int col = 0; col < kRaster; ++col) {
      const cv::Point at((2 * col + 1) * matched_px.width / (2 * kRaster),
                         (2 * row + 1) * matched_px.height / (2 * kRaster));
      const bool masked = std::ranges::any_of(
          pair.masks_px, [&](const cv::Rect& mask) { return mask.contains(at * downscale); });
      kept += !masked && matched_px.width - at.x > rcrop_px ? 1 : 0;
    }
  }
  return static_cast<double>(kept) / (kRaster * kRaster);
}

PairReport report_on(const StereoPair& pair, const RigCheckSettings& settings) {
  const int downscale = pair.downscale.value_or(settings.downscale);
  const PairModel matched = downscaled(pair.model, downscale);
  const cv::Size matched_px(pair.image_size_px.width / downscale,
                            pair.image_size_px.height / downscale);
  const int rcrop_px = pair.rcrop_px.value_or(settings.rcrop_px);
  return {.name = pair.name,
          .raw = pair.raw.has_value(),
          .model = pair.model,
          .size_px = pair.image_size_px,
          .downscale = downscale,
          .matched_px = matched_px,
          .kept_share = kept_share(pair, matched_px, downscale, rcrop_px),
          .max_range_m = pair.max_range_m,
          .field = field_of_view(pair.model, pair.image_size_px),
          .axis_body = pair.T_body_camera.linear().col(2),
          .rows_body = pair.T_body_camera.linear().col(0),
          .position_body_m = pair.T_body_camera.translation(),
          .seen_share = seen_share(pair),
          .min_range_m = range_at_disparity_m(matched, settings.max_disparity_px),
          .range_of_one_cell_m =
              range_at_uncertainty_m(matched, settings.voxel_m, settings.delta_d_px)};
}

std::string rounded_degrees(double angle_rad) {
  return number_text("%.1f degrees", std::abs(deg_from_rad(angle_rad)));
}

}  // namespace

std::string in_words(const Eigen::Vector3d& direction_body) {
  const Eigen::Vector3d& d = direction_body;
  const double elevation = std::atan2(d.z(), std::hypot(d.x(), d.y()));
  if (std::abs(elevation) > rad_from_deg(85.0)) {
    return elevation > 0.0 ? "up" : "down";
  }
  const double azimuth = std::atan2(d.y(), d.x());
  constexpr std::array<const char*, 4> kQuarters{"forward", "left", "back", "right"};
  const int quarter = static_cast<int>(std::lround(azimuth / rad_from_deg(90.0)));
  const double turn = azimuth - quarter * rad_from_deg(90.0);
  const auto word = [&](int of_quarter) {
    return std::string(kQuarters.at(static_cast<std::size_t>((of_quarter + 4) % 4)));
  };
  std::string text = word(quarter);
  if (std::abs(turn) > rad_from_deg(0.5)) {
    text +=
        ", " + rounded_degrees(turn) + " towards " + word(turn > 0.0 ? quarter + 1 : quarter - 1);
  }
  if (std::abs(elevation) > rad_from_deg(0.5)) {
    text += ", " + rounded_degrees(elevation) + (elevation > 0.0 ? " up" : " down");
  }
  return text;
}

RigReport check_rig(const RigDescription& rig, const RigCheckSettings& settings) {
  RigReport report;
  for (std::size_t i = 0; i < rig.pairs.size(); ++i) {
    const PairDescription& pair = rig.pairs[i];
    const auto warn = [&](const std::string& finding) {
      report.warnings.push_back("pair " + pair.name + ": " + finding);
    };
    for (const std::string& finding : findings_on(pair)) {
      warn(finding);
    }
    try {
      const StereoRig one = resolve({.name = rig.name, .T_body_imu = {}, .pairs = {pair}});
      report.pairs.push_back(report_on(one.pairs.front(), settings));
      for (const std::string& finding : findings_on(report.pairs.back())) {
        warn(finding);
      }
    } catch (const Error& error) {
      const std::string message = error.what();  // pairs[0].KEY: ...
      report.unusable.push_back("pairs[" + std::to_string(i) + "]" +
                                message.substr(message.find('.')));
    }
  }
  return report;
}

}  // namespace skyhalo

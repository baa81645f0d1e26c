#include "skyhalo/calibration/rig_check.hpp"

#include <array>
#include <cmath>
#include <cstdio>

#include "skyhalo/base/error.hpp"
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

PairReport report_on(const StereoPair& pair, const RigCheckSettings& settings) {
  const int downscale = pair.downscale.value_or(settings.downscale);
  const PairModel matched = downscaled(pair.model, downscale);
  return {.name = pair.name,
          .raw = pair.raw.has_value(),
          .model = pair.model,
          .size_px = pair.image_size_px,
          .downscale = downscale,
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
  std::array<char, 32> text{};
  const int length =
      std::snprintf(text.data(), text.size(), "%.1f degrees", std::abs(deg_from_rad(angle_rad)));
  return {text.data(), static_cast<std::size_t>(length)};
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
  for (const PairDescription& pair : rig.pairs) {
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
      warn("cannot be used: " + message.substr(message.find('.') + 1));
    }
  }
  return report;
}

}  // namespace skyhalo

#include "rig_report.hpp"

#include <sstream>

#include "skyhalo/base/number_text.hpp"
#include "skyhalo/geometry/angle.hpp"

namespace skyhalo::app {
namespace {

std::string vector_text(const Eigen::Vector3d& v) {
  return "(" + number_text("%.3f", v.x()) + ", " + number_text("%.3f", v.y()) + ", " +
         number_text("%.3f", v.z()) + ")";
}

std::string resolution(const PairModel& model) {
  if (const auto* pinhole = std::get_if<PinholePair>(&model)) {
    return "f " + number_text("%.2f", pinhole->focal_px) + " px";
  }
  const auto& spherical = std::get<SphericalPair>(model);
  return number_text("%.5f", deg_from_rad(spherical.delta_theta_u_rad)) + " x " +
         number_text("%.5f", deg_from_rad(spherical.delta_theta_v_rad)) + " degrees per pixel";
}

std::string kind(const PairModel& model) {
  return std::holds_alternative<PinholePair>(model) ? "pinhole" : "spherical";
}

void describe(const PairReport& pair, const RigCheckSettings& settings, std::ostream& text) {
  text << "pair " << pair.name << (pair.raw ? ": raw images, rectified to " : ": rectified, ")
       << kind(pair.model) << "\n"
       << "  baseline         " << number_text("%.4f", baseline_m(pair.model)) << " m\n"
       << "  rectified image  " << pair.size_px.width << " x " << pair.size_px.height << ", "
       << resolution(pair.model) << ", matched at 1/" << pair.downscale << "\n"
       << "  field of view    " << number_text("%.1f", deg_from_rad(pair.field.horizontal_rad))
       << " x " << number_text("%.1f", deg_from_rad(pair.field.vertical_rad)) << " degrees";
  if (pair.raw) {
    text << ", " << number_text("%.0f", 100.0 * pair.seen_share) << " % of it seen by both cameras";
  }
  text << "\n  looks            " << in_words(pair.axis_body) << ", axis "
       << vector_text(pair.axis_body) << " in body (x forward, y left, z up)\n"
       << "  right camera at  " << vector_text(pair.position_body_m) << " m in body\n"
       << "  range            from " << number_text("%.2f", pair.min_range_m) << " m ("
       << settings.max_disparity_px << " px of disparity); uncertainty passes one cell of "
       << settings.voxel_m << " m at " << number_text("%.1f", pair.range_of_one_cell_m) << " m\n";
}

nlohmann::json list(const Eigen::Vector3d& v) {
  return {v.x(), v.y(), v.z()};
}

nlohmann::json json_of(const PairReport& pair) {
  nlohmann::json json = {{"name", pair.name},
                         {"raw", pair.raw},
                         {"model", kind(pair.model)},
                         {"baseline_m", baseline_m(pair.model)},
                         {"size_px", {pair.size_px.width, pair.size_px.height}},
                         {"downscale", pair.downscale},
                         {"hfov_deg", deg_from_rad(pair.field.horizontal_rad)},
                         {"vfov_deg", deg_from_rad(pair.field.vertical_rad)},
                         {"axis_body", list(pair.axis_body)},
                         {"looks", in_words(pair.axis_body)},
                         {"position_body_m", list(pair.position_body_m)},
                         {"seen_share", pair.seen_share},
                         {"min_range_m", pair.min_range_m},
                         {"range_of_one_cell_m", pair.range_of_one_cell_m}};
  if (const auto* pinhole = std::get_if<PinholePair>(&pair.model)) {
    json["focal_px"] = pinhole->focal_px;
  } else if (const auto* spherical = std::get_if<SphericalPair>(&pair.model)) {
    json["delta_theta_rad"] = {spherical->delta_theta_u_rad, spherical->delta_theta_v_rad};
  }
  return json;
}

}  // namespace

RigCheckSettings check_settings(const Config& config) {
  return {
      .downscale = config.detector.matching.downscale,
      .rcrop_px = config.detector.matching.rcrop_px,
      .max_disparity_px = static_cast<double>(config.detector.matching.matcher.max_disparity_px),
      .delta_d_px = config.detector.sensor_model.delta_d_px,
      .voxel_m = config.detector.map.voxel_m};
}

std::string rig_table(const RigReport& report, const RigCheckSettings& settings) {
  std::ostringstream text;
  for (const PairReport& pair : report.pairs) {
    describe(pair, settings, text);
  }
  return text.str();
}

nlohmann::json rig_json(const RigReport& report) {
  nlohmann::json pairs = nlohmann::json::array();
  for (const PairReport& pair : report.pairs) {
    pairs.push_back(json_of(pair));
  }
  return {{"pairs", pairs}, {"warnings", report.warnings}, {"unusable", report.unusable}};
}

}  // namespace skyhalo::app

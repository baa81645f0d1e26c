#pragma once

#include <array>
#include <string_view>
#include <utility>

#include "skyhalo/config/config.hpp"

namespace skyhalo {

/// An angle that is radians in the program and degrees in the file.
template <class Number>
struct InDegrees {
  Number& angle_rad;
};

/// The words for the values of an enumeration in files.
template <class Enum>
struct EnumWords;

template <>
struct EnumWords<MatcherKind> {
  static constexpr std::array kWords{std::pair{MatcherKind::kSgm, std::string_view("sgm")},
                                     std::pair{MatcherKind::kOpencv, std::string_view("opencv")}};
};

template <>
struct EnumWords<CameraChoice> {
  static constexpr std::array kWords{std::pair{CameraChoice::kAuto, std::string_view("auto")},
                                     std::pair{CameraChoice::kGrey, std::string_view("grey")},
                                     std::pair{CameraChoice::kColour, std::string_view("colour")}};
};

template <>
struct EnumWords<DepthRuleKind> {
  static constexpr std::array kWords{
      std::pair{DepthRuleKind::kThesis, std::string_view("thesis")},
      std::pair{DepthRuleKind::kMean, std::string_view("mean")},
      std::pair{DepthRuleKind::kNearest, std::string_view("nearest")},
      std::pair{DepthRuleKind::kQuantile, std::string_view("quantile")}};
};

template <>
struct EnumWords<IntegrationMethod> {
  static constexpr std::array kWords{
      std::pair{IntegrationMethod::kAuto, std::string_view("auto")},
      std::pair{IntegrationMethod::kRays, std::string_view("rays")},
      std::pair{IntegrationMethod::kSweep, std::string_view("sweep")}};
};

template <>
struct EnumWords<UnseenPolicy> {
  static constexpr std::array kWords{std::pair{UnseenPolicy::kBlock, std::string_view("block")},
                                     std::pair{UnseenPolicy::kSlow, std::string_view("slow")},
                                     std::pair{UnseenPolicy::kAllow, std::string_view("allow")}};
};

template <>
struct EnumWords<Avoidance> {
  static constexpr std::array kWords{std::pair{Avoidance::kSlide, std::string_view("slide")},
                                     std::pair{Avoidance::kStop, std::string_view("stop")}};
};

/// Marks an angle for a visitor; keeps its constness.
template <class Number>
InDegrees<Number> in_degrees(Number& angle_rad) {
  return {angle_rad};
}

// The one list of all settings, in the order of the file, a function for each section: loader,
// dumper, `--set` and the documentation page walk over it. The config is `const` for those that
// only read. A visitor has `section(name, meaning)` and `field(key, value, meaning)`.

template <class Dataset, class Visitor>
void visit_dataset(Dataset& dataset, Visitor& visitor) {
  visitor.section("dataset", "how recordings are read");
  visitor.field("cameras",
                dataset.cameras,
                "which pair of a recording: grey, colour, or auto (grey where there is one)");
}

template <class Matching, class Visitor>
void visit_matching(Matching& matching, Visitor& visitor) {
  visitor.section("matching", "from images to disparities (thesis 5.1, 5.2)");
  visitor.field("matcher", matching.matcher.kind, "the engine: sgm (our own) or opencv");
  visitor.field("downscale", matching.downscale, "whole factor by which images are shrunk, 1...16");
  visitor.field("max_disparity_px",
                matching.matcher.max_disparity_px,
                "search range in the matched image, a multiple of 16 in 16...256");
  visitor.field("rcrop_px",
                matching.rcrop_px,
                "right-most columns of the matched image to discard (eq. 5.1)");
  visitor.field("masks_px",
                matching.masks_px,
                "airframe: list of [u, v, width, height] in full-resolution pixels");
}

template <class Sgm, class Visitor>
void visit_sgm(Sgm& sgm, Visitor& visitor) {
  visitor.section("sgm",
                  "our own matcher; costs are halves of census bits, lengths matched pixels");
  visitor.field("p1", sgm.p1, "penalty of a step of one disparity along a path, 0...p2_min");
  visitor.field(
      "p2_min", sgm.p2_min, "penalty of a larger step at an edge of the image, p1...p2_max");
  visitor.field(
      "p2_max", sgm.p2_max, "penalty of a larger step where the image is even, p2_min...51");
  visitor.field("uniqueness_percent",
                sgm.uniqueness_percent,
                "by how much the best sum must beat those not beside it, 0...100");
  visitor.field(
      "left_right_px", sgm.left_right_px, "largest difference in the left-right check, 0...256");
  visitor.field("texture_min_grey",
                sgm.texture_min_grey,
                "least range of grey within 9 x 9 px, 0...255; 0 for no check");
  visitor.field("repetition_px",
                sgm.repetition_px,
                "pixels of 9 x 9 that look repeated and make one unsure, 1...82; 82 for no check");
  visitor.field("median_passes", sgm.median_passes, "how often the 5 x 5 median is taken, 0...10");
  visitor.field("fill_min_px",
                sgm.fill_min_px,
                "disparities among 5 x 5 px that fill a hole, 1...26; 26 for never");
  visitor.field("speckle_size_px",
                sgm.speckle_size_px,
                "smaller islands of disparity are discarded; 0 for none");
  visitor.field("speckle_step_px", sgm.speckle_step_px, "a larger step parts islands, 0...256");
  visitor.field("edge_step_px",
                sgm.edge_step_px,
                "pixels beside a larger step are discarded, 0...256; 0 for none");
}

template <class Sgbm, class Visitor>
void visit_opencv(Sgbm& opencv, Visitor& visitor) {
  visitor.section("opencv", "OpenCV's matcher, for those who choose it");
  visitor.field("block_px", opencv.block_px, "side of the matched block, odd, 1...11");
  visitor.field("paths", opencv.paths, "aggregation paths: 3, 5 or 8");
  visitor.field("uniqueness_percent",
                opencv.uniqueness_percent,
                "by how much the best cost must beat the others, 0...100");
  visitor.field("left_right_px",
                opencv.left_right_px,
                "largest difference in the left-right check, at least 1");
  visitor.field("speckle_size_px",
                opencv.speckle_size_px,
                "smaller islands of disparity are discarded; 0 for none");
  visitor.field(
      "speckle_range_px", opencv.speckle_range_px, "a step of disparity that parts islands");
}

template <class Sphere, class Visitor>
void visit_sphere(Sphere& sphere, Visitor& visitor) {
  visitor.section("sphere", "from disparities to nearest distances by direction (thesis 5.3, 5.4)");
  visitor.field("theta_min_deg",
                in_degrees(sphere.bounds.theta_min_rad),
                "first polar angle; 0 is up, 90 the horizon");
  visitor.field("theta_max_deg", in_degrees(sphere.bounds.theta_max_rad), "last polar angle");
  visitor.field("phi_min_deg",
                in_degrees(sphere.bounds.phi_min_rad),
                "first azimuth; 0 is forward, positive to the left");
  visitor.field("phi_max_deg",
                in_degrees(sphere.bounds.phi_max_rad),
                "last azimuth; at most a turn from the first");
  visitor.field("step_deg",
                in_degrees(sphere.bounds.step_rad),
                "size of a cell; all bounds are multiples of it");
  visitor.field(
      "rule",
      sphere.depth.kind,
      "how a cell's ranges become its depth: thesis (eq. 5.4), mean, nearest or quantile");
  visitor.field("sigma_threshold_m",
                sphere.depth.sigma_threshold_m,
                "thesis: cells that vary less are one surface, of others the nearest point counts");
  visitor.field("sigma_factor",
                sphere.depth.sigma_factor,
                "thesis: how many deviations in front of its mean a surface's depth lies");
  visitor.field(
      "nearest_count",
      sphere.depth.nearest_count,
      "nearest: as near as this many points bear out, 1...8, or a quarter of a cell's pixels");
  visitor.field("quantile",
                sphere.depth.quantile,
                "quantile: the range that this share of a cell's points does not exceed, 0...1");
  visitor.field("min_seen_share",
                sphere.seen.min_share,
                "share of the pixels about a cell that must be valid for it to count as seen");
  visitor.field(
      "seen_window_deg",
      in_degrees(sphere.seen.window_rad),
      "how far about a cell nothing nearer may be, nor too much invalid, for it to be free");
  visitor.field("near_m",
                sphere.seen.near_m,
                "nearer places to the body need not be seen for a direction to be free");
  visitor.field("max_range_m", sphere.max_range_m, "points farther from the camera are left out");
}

template <class Safety, class Visitor>
void visit_safety(Safety& safety, Visitor& visitor) {
  visitor.section("safety", "velocities that can still stop in time");
  visitor.field(
      "radius_m", safety.radius_m, "of a ball about the body origin that holds the vehicle");
  visitor.field("margin_m", safety.margin_m, "kept besides the radius");
  visitor.field("brake_mps2", safety.brake_mps2, "braking limit of the horizontal velocity, m/s^2");
  visitor.field("brake_vertical_mps2", safety.brake_vertical_mps2, "of the vertical one, m/s^2");
  visitor.field("delay_s", safety.delay_s, "from the images until a command takes effect");
  visitor.field("unseen",
                safety.unseen,
                "where nothing was seen: block (as if there were something), slow or allow");
  visitor.field(
      "unseen_speed_mps", safety.unseen_speed_mps, "slow: towards what was not seen, m/s");
  visitor.field("look_angle_deg",
                in_degrees(safety.look_angle_rad),
                "about the way: what is unseen farther aside does not hinder; 90 asks for all");
  visitor.field("avoidance",
                safety.avoidance,
                "before a thing: slide (along it) or stop (keep the direction)");
}

template <class Sensor, class Visitor>
void visit_sensor_model(Sensor& sensor, Visitor& visitor) {
  visitor.section("sensor_model", "from one range to occupancy along its ray (thesis 6.1)");
  visitor.field("k", sensor.k, "how much a sure measurement marks, in (0, 1)");
  visitor.field("p_unknown", sensor.p_unknown, "probability of a cell that nothing is known of");
  visitor.field("p_free", sensor.p_free, "probability that a crossing ray leaves in a cell");
  visitor.field("delta_d_px", sensor.delta_d_px, "expected disparity error in the matched image");
}

template <class Map, class Visitor>
void visit_map(Map& map, Visitor& visitor) {
  visitor.section("map", "the occupancy map (thesis 6.2, 7)");
  visitor.field("voxel_m", map.voxel_m, "edge of a map cell");
  visitor.field("log_odds_limit",
                map.log_odds_limit,
                "log odds are kept within plus and minus this, 0.001...32");
  visitor.field("method",
                map.method,
                "how a scan enters: rays (thesis), sweep (each cell looks up its direction), auto");
  visitor.field("cell_size_term",
                map.cell_size_term,
                "sweep: a surface marks all cells that it touches, however exact the sensor is");
  visitor.field("half_life_occupied_s",
                map.decay.half_life_occupied_s,
                "after which what occupied cells know has halved, unless seen again; 0 for never");
  visitor.field("half_life_free_s", map.decay.half_life_free_s, "the same of free cells");
  visitor.field("local_side_m", map.local_side_m, "local map: its length and width");
  visitor.field("local_height_m", map.local_height_m, "local map: its height");
  visitor.field("memory_mib",
                map.memory_mib,
                "sparse map with tiles: memory that it may take before far ones leave it");
}

template <class Bounds, class Visitor>
void visit_bounds(Bounds& bounds, Visitor& visitor) {
  visitor.section("bounds", "of the global map when none are given; frame of the first pose");
  visitor.field("ahead_m", bounds.ahead_m, "beyond the end of the drive");
  visitor.field("behind_m", bounds.behind_m, "behind the start");
  visitor.field("side_m", bounds.side_m, "to the left and to the right");
  visitor.field("bottom_m", bounds.bottom_m, "lowest z");
  visitor.field("top_m", bounds.top_m, "highest z");
}

template <class Evaluation, class Visitor>
void visit_evaluation(Evaluation& evaluation, Visitor& visitor) {
  visitor.section("evaluation", "how a map is scored (thesis 8)");
  visitor.field(
      "max_range_m", evaluation.max_range_m, "laser points farther from the camera are left out");
  visitor.field("occupied_probability",
                evaluation.occupied_probability,
                "a cell is called occupied above this");
  visitor.field("labels_may_end_early",
                evaluation.labels_may_end_early,
                "accept labels that end before the drive does");
}

/// All sections of a `Config` or `const Config`.
template <class AnyConfig, class Visitor>
void visit_fields(AnyConfig& config, Visitor& visitor) {
  visit_dataset(config.dataset, visitor);
  visit_matching(config.detector.matching, visitor);
  visit_sgm(config.detector.matching.matcher.sgm, visitor);
  visit_opencv(config.detector.matching.matcher.opencv, visitor);
  visit_sphere(config.detector.sphere, visitor);
  visit_safety(config.safety, visitor);
  visit_sensor_model(config.detector.sensor_model, visitor);
  visit_map(config.detector.map, visitor);
  visit_bounds(config.bounds, visitor);
  visit_evaluation(config.evaluation, visitor);
}

}  // namespace skyhalo

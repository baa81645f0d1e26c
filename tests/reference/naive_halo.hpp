#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numbers>
#include <optional>
#include <vector>

#include "reference/naive_pinhole.hpp"
#include "reference/naive_spherical_grid.hpp"

namespace skyhalo::reference {

/// Source of a stitched cell that no pair knows anything about.
inline constexpr std::uint8_t kNaiveHaloNoSource = 255;

/// A vector in the body or the camera frame, as its name says.
using NaiveVector3 = std::array<double, 3>;

/// One rectified pair as its body sees it (METHOD.md sections 0 and 1). The pinhole takes f_px and
/// offset_px (added to every disparity), the spherical one delta_theta_u_rad and delta_theta_v_rad
/// (radians per pixel). B_m is the baseline, the camera is the right (reference) one. Camera ranges
/// outside [min_range_m, max_range_m] give no point; max_range_m is finite.
struct NaivePairView {
  bool spherical = false;
  double f_px = 0.0;
  double offset_px = 0.0;
  double delta_theta_u_rad = 0.0;
  double delta_theta_v_rad = 0.0;
  double u0_px = 0.0;
  double v0_px = 0.0;
  double B_m = 0.0;
  NaiveMatrix3 R_body_camera = {{{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}}};
  NaiveVector3 t_body_camera_m = {0.0, 0.0, 0.0};
  double min_range_m = 0.0;
  double max_range_m = 0.0;
};

/// Disparities (px) of the right image, row-major, NaN where there is none.
struct NaiveHaloImage {
  int width_px = 0;
  int height_px = 0;
  std::vector<float> disparities_px;
};

/// How a cell's depth comes from its list of ranges.
enum class NaiveHaloRule { kMeanMinusSigma, kMean, kNearest, kQuantile };

/// The rule and its numbers: sigma_factor (no unit) and sigma_threshold_m of the mean minus sigma,
/// nearest_count of the n-th nearest, quantile in [0, 1]. No depth is below floor_m.
struct NaiveHaloDepthSettings {
  NaiveHaloRule rule = NaiveHaloRule::kMeanMinusSigma;
  double sigma_factor = 3.0;
  double sigma_threshold_m = 0.0;
  int nearest_count = 1;
  double quantile = 0.0;
  double floor_m = 0.0;
};

/// Where a walk along a cell's centre starts (m from the body origin), and the smallest share of a
/// cell that must be seen for it to be known free.
struct NaiveHaloFreeSettings {
  double near_m = 0.0;
  double min_seen_share = 0.0;
  double window_rad =
      0.0;  ///< a cell is judged by all cells this far away, see naive_halo_windowed
};

/// What one pixel says: nothing, far (range_m infinite, no point), or a point.
enum class NaiveHaloState { kInvalid, kFar, kPoint };

/// One pixel's reading: the range from the camera (m, NaN if invalid) and, if it is a point, the
/// point in the body frame (m).
struct NaiveHaloReading {
  NaiveHaloState state = NaiveHaloState::kInvalid;
  double range_m = std::numeric_limits<double>::quiet_NaN();
  NaiveVector3 point_body_m = {0.0, 0.0, 0.0};
};

/// What the pixels whose viewing rays fall into each cell say (row-major): how many are valid and
/// invalid, the smallest camera range of the valid ones (m, infinite for far ones and where there
/// is none), the share of the cell that lies in the image, and the share of it that is seen.
struct NaiveHaloSeen {
  std::vector<int> valid;
  std::vector<int> invalid;
  std::vector<double> nearest_seen_m;
  std::vector<double> coverage;
  std::vector<double> seen_share;
};

/// A stretch of a walk: from this range (m, along the walk's cell centre) on, the camera sees the
/// places in the direction of this cell (nothing: outside the grid, or at the camera itself).
struct NaiveHaloLook {
  double from_m = 0.0;
  std::optional<std::size_t> cell;
};

/// The walk along one cell's centre. free_to_m is not yet limited by the cell's depth. `looks` are
/// the look-cells in order, with the one that ended the walk. The margins (rad) are for tests to
/// skip what rounding decides: corner_margin_rad is at most the angle between the looks' directions
/// and the nearest corner of any cell (may be below 0), start_margin_rad the angle between the
/// first look's direction and the nearest edge.
struct NaiveHaloWalk {
  double free_to_m = 0.0;
  std::vector<NaiveHaloLook> looks;
  double corner_margin_rad = std::numeric_limits<double>::infinity();
  double start_margin_rad = std::numeric_limits<double>::infinity();
};

/// All about one pair's grid, row-major: the ranges from the body origin (m) of each cell's points
/// in image order, the depth (m, NaN where there is none), what is seen, how far it is free (m, 0
/// is unseen, limited by the depth) and the walks that say so.
struct NaiveHaloPair {
  NaiveGridSpec spec;
  std::vector<std::vector<double>> ranges_m;
  std::vector<double> depth_m;
  NaiveHaloSeen seen;
  std::vector<double> free_to_m;
  std::vector<NaiveHaloWalk> walks;
};

/// The pairs' grids stitched over the whole sphere, row-major, phi from -pi: depth (m, NaN where
/// there is none), index of the pair it came from (kNaiveHaloNoSource: none), how far it is free
/// (m, 0 is unseen).
struct NaiveHaloSphere {
  NaiveGridSpec spec;
  std::vector<double> depth_m;
  std::vector<std::uint8_t> source;
  std::vector<double> free_to_m;
};

/// Box of angles [theta_min, theta_max) x [phi_min, phi_max) in the body frame, radians. phi counts
/// modulo 2 pi; phi_max < phi_min stands for the box over +-pi.
struct NaiveHaloBox {
  double theta_min_rad = 0.0;
  double theta_max_rad = 0.0;
  double phi_min_rad = 0.0;
  double phi_max_rad = 0.0;
};

/// Answer of a query: the nearest depth (m, infinite if none) and its cell (the first if equal),
/// the smallest free_to (m, 0 if there are no cells), how many cells were asked, and how many of
/// them have neither a depth nor a free_to above 0.
struct NaiveHaloAnswer {
  double nearest_m = std::numeric_limits<double>::infinity();
  std::optional<std::size_t> nearest_cell;
  double free_to_m = 0.0;
  int cells = 0;
  int unseen_cells = 0;
};

// ------------------------------------------------------------------------------------ vectors ---

inline double naive_halo_dot(const NaiveVector3& a, const NaiveVector3& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

inline double naive_halo_norm(const NaiveVector3& a) {
  return std::sqrt(naive_halo_dot(a, a));
}

/// Angle in [0, pi] between two vectors of any length, radians.
inline double naive_halo_angle(const NaiveVector3& a, const NaiveVector3& b) {
  const NaiveVector3 cross = {
      a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
  return std::atan2(naive_halo_norm(cross), naive_halo_dot(a, b));
}

/// A direction of the camera frame in the body frame.
inline NaiveVector3 naive_halo_to_body(const NaivePairView& view, const NaiveVector3& camera) {
  NaiveVector3 body{};
  for (std::size_t row = 0; row < 3; ++row) {
    for (std::size_t column = 0; column < 3; ++column) {
      body[row] += view.R_body_camera[row][column] * camera[column];
    }
  }
  return body;
}

/// A direction of the body frame in the camera frame.
inline NaiveVector3 naive_halo_to_camera(const NaivePairView& view, const NaiveVector3& body) {
  NaiveVector3 camera{};
  for (std::size_t row = 0; row < 3; ++row) {
    for (std::size_t column = 0; column < 3; ++column) {
      camera[column] += view.R_body_camera[row][column] * body[row];
    }
  }
  return camera;
}

/// Unit vector (body) of a polar angle and an azimuth, radians (the inverse of thesis eq. 5.2).
inline NaiveVector3 naive_halo_direction(double theta_rad, double phi_rad) {
  return {std::sin(theta_rad) * std::cos(phi_rad),
          std::sin(theta_rad) * std::sin(phi_rad),
          std::cos(theta_rad)};
}

// ---------------------------------------------------------------------------------- the cells ---

inline std::size_t naive_halo_cell_count(const NaiveGridSpec& spec) {
  return static_cast<std::size_t>(naive_row_count(spec)) *
         static_cast<std::size_t>(naive_column_count(spec));
}

/// Angles (rad) of the place in a cell at these shares (0 to 1, no unit) of its extent in theta and
/// phi; rho is 1 m. phi may exceed pi where the grid does.
inline NaiveSpherical naive_halo_place_in_cell(const NaiveGridSpec& spec,
                                               std::size_t cell,
                                               double theta_share,
                                               double phi_share) {
  const auto columns = static_cast<std::size_t>(naive_column_count(spec));
  const std::size_t row = cell / columns;
  const std::size_t column = cell % columns;
  NaiveSpherical place;
  place.rho_m = 1.0;
  place.theta_rad = spec.theta_min_rad + (static_cast<double>(row) + theta_share) * spec.step_rad;
  place.phi_rad = spec.phi_min_rad + (static_cast<double>(column) + phi_share) * spec.step_rad;
  return place;
}

/// Unit vector (body) to the centre of a cell.
inline NaiveVector3 naive_halo_centre(const NaiveGridSpec& spec, std::size_t cell) {
  const NaiveSpherical centre = naive_halo_place_in_cell(spec, cell, 0.5, 0.5);
  return naive_halo_direction(centre.theta_rad, centre.phi_rad);
}

/// Cell of a body-frame vector of any length; nothing at the origin and outside the grid.
inline std::optional<std::size_t> naive_halo_cell_of(const NaiveGridSpec& spec,
                                                     const NaiveVector3& body) {
  const std::optional<NaiveSpherical> spherical = naive_spherical(body);
  if (!spherical.has_value()) {
    return std::nullopt;
  }
  return naive_cell_index(spec, *spherical);
}

// --------------------------------------------------------------------------------- the pixels ---

/// Viewing ray (camera frame, any length) of a pixel.
inline NaiveVector3 naive_halo_ray_camera(const NaivePairView& view, double u_px, double v_px) {
  if (!view.spherical) {
    return {(u_px - view.u0_px) / view.f_px, (v_px - view.v0_px) / view.f_px, 1.0};
  }
  const double alpha_rad = (u_px - view.u0_px) * view.delta_theta_u_rad;
  const double beta_rad = (v_px - view.v0_px) * view.delta_theta_v_rad;
  return {std::sin(alpha_rad),
          std::cos(alpha_rad) * std::sin(beta_rad),
          std::cos(alpha_rad) * std::cos(beta_rad)};
}

/// Pixel coordinates (u, v) that a direction of the camera frame projects to, in the image or not;
/// nothing where the model has no pixel for it.
inline std::optional<std::array<double, 2>> naive_halo_project(const NaivePairView& view,
                                                               const NaiveVector3& camera) {
  const double x = camera[0];
  const double y = camera[1];
  const double z = camera[2];
  if (view.spherical) {
    const double alpha_rad = std::atan2(x, std::sqrt(y * y + z * z));
    const double beta_rad = std::atan2(y, z);
    return std::array<double, 2>{view.u0_px + alpha_rad / view.delta_theta_u_rad,
                                 view.v0_px + beta_rad / view.delta_theta_v_rad};
  }
  if (!(z > 0.0)) {
    return std::nullopt;
  }
  return std::array<double, 2>{view.u0_px + view.f_px * x / z, view.v0_px + view.f_px * y / z};
}

/// Reading of the pixel (u, v) with this disparity, all in pixels (thesis eq. 4.1, 4.3 and 4.4).
inline NaiveHaloReading naive_halo_reading(const NaivePairView& view,
                                           double u_px,
                                           double v_px,
                                           double disparity_px) {
  const NaiveHaloReading invalid;
  NaiveHaloReading far;
  far.state = NaiveHaloState::kFar;
  far.range_m = std::numeric_limits<double>::infinity();

  const double d_px = view.spherical ? disparity_px : disparity_px + view.offset_px;
  if (!std::isfinite(d_px) || d_px < 0.0) {
    return invalid;
  }
  const double quarter_turn_rad = std::numbers::pi / 2.0;
  const double alpha_rad = (u_px - view.u0_px) * view.delta_theta_u_rad;
  if (view.spherical && !(alpha_rad > -quarter_turn_rad && alpha_rad < quarter_turn_rad)) {
    return invalid;
  }
  if (d_px == 0.0) {
    return far;
  }

  NaiveVector3 point_cam_m{};
  if (view.spherical) {
    const double delta_rad = d_px * view.delta_theta_u_rad;
    if (alpha_rad + delta_rad >= quarter_turn_rad) {
      return invalid;
    }
    const double k_m = view.B_m * std::cos(alpha_rad + delta_rad) / std::sin(delta_rad);
    const NaiveVector3 ray = naive_halo_ray_camera(view, u_px, v_px);
    point_cam_m = {k_m * ray[0], k_m * ray[1], k_m * ray[2]};
  } else {
    point_cam_m = naive_pinhole_point_cam_m({view.B_m, view.f_px, view.u0_px, view.v0_px},
                                            {u_px, v_px, d_px});
  }

  const double range_m = naive_halo_norm(point_cam_m);
  if (range_m < view.min_range_m) {
    return invalid;
  }
  if (range_m > view.max_range_m) {
    return far;
  }
  NaiveHaloReading reading;
  reading.state = NaiveHaloState::kPoint;
  reading.range_m = range_m;
  const NaiveVector3 turned_m = naive_halo_to_body(view, point_cam_m);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    reading.point_body_m[axis] = turned_m[axis] + view.t_body_camera_m[axis];
  }
  return reading;
}

/// Readings of all pixels, row-major.
inline std::vector<NaiveHaloReading> naive_halo_readings(const NaivePairView& view,
                                                         const NaiveHaloImage& image) {
  std::vector<NaiveHaloReading> readings;
  for (int v = 0; v < image.height_px; ++v) {
    for (int u = 0; u < image.width_px; ++u) {
      const double disparity_px = image.disparities_px[readings.size()];
      readings.push_back(naive_halo_reading(view, u, v, disparity_px));
    }
  }
  return readings;
}

/// Ranges (m, from the body origin) of the points in each cell, in image order.
inline std::vector<std::vector<double>> naive_halo_ranges(const NaiveGridSpec& spec,
                                                          const NaivePairView& view,
                                                          const NaiveHaloImage& image) {
  std::vector<std::vector<double>> ranges_m(naive_halo_cell_count(spec));
  for (const NaiveHaloReading& reading : naive_halo_readings(view, image)) {
    if (reading.state != NaiveHaloState::kPoint) {
      continue;
    }
    const std::optional<std::size_t> cell = naive_halo_cell_of(spec, reading.point_body_m);
    if (cell.has_value()) {
      ranges_m[*cell].push_back(naive_halo_norm(reading.point_body_m));
    }
  }
  return ranges_m;
}

// ---------------------------------------------------------------------------------- the depth ---

/// Lower bound (m) of class i of the ranges, a sixteenth of an octave each: 0 is 2^-4, 192 is 2^8.
inline double naive_halo_class_low_m(int i) {
  const int octave = i / 16 - 4;
  const double share = i % 16 / 16.0;
  return std::ldexp(1.0 + share, octave);
}

/// Quantile (0 to 1) of ranges (m, at least one) that are counted in classes, linear within a
/// class, not below the smallest.
inline double naive_halo_quantile_m(const std::vector<double>& ranges_m, double quantile) {
  constexpr int kClasses = 12 * 16;
  std::array<int, kClasses> counts{};
  for (const double range_m : ranges_m) {
    int i = 0;
    while (i + 1 < kClasses && range_m >= naive_halo_class_low_m(i + 1)) {
      ++i;
    }
    ++counts[static_cast<std::size_t>(i)];
  }
  const double min_m = *std::min_element(ranges_m.begin(), ranges_m.end());
  const double target = quantile * static_cast<double>(ranges_m.size());
  int before = 0;
  for (int i = 0; i < kClasses; ++i) {
    const int count = counts[static_cast<std::size_t>(i)];
    if (count > 0 && before + count >= target) {
      const double low_m = naive_halo_class_low_m(i);
      const double high_m = naive_halo_class_low_m(i + 1);
      return std::max(min_m, low_m + (target - before) / count * (high_m - low_m));
    }
    before += count;
  }
  return std::numeric_limits<double>::quiet_NaN();  // a quantile above 1
}

/// Depth (m) of one cell from its ranges (m), NaN if it has none (thesis eq. 5.4 and others).
inline double naive_halo_depth_m(const std::vector<double>& ranges_m,
                                 const NaiveHaloDepthSettings& settings) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  if (ranges_m.empty()) {
    return kNan;
  }
  const NaiveCell statistics = naive_cell(ranges_m, 0.0, 0.0);
  double depth_m = kNan;
  switch (settings.rule) {
    case NaiveHaloRule::kMeanMinusSigma:
      depth_m = statistics.sigma_m < settings.sigma_threshold_m
                    ? statistics.mean_m - settings.sigma_factor * statistics.sigma_m
                    : statistics.min_m;
      break;
    case NaiveHaloRule::kMean:
      depth_m = statistics.mean_m;
      break;
    case NaiveHaloRule::kNearest: {
      std::vector<double> sorted_m = ranges_m;
      std::sort(sorted_m.begin(), sorted_m.end());
      const auto count = static_cast<std::size_t>(std::max(settings.nearest_count, 1));
      if (sorted_m.size() < count) {
        return kNan;
      }
      depth_m = sorted_m[count - 1];
      break;
    }
    case NaiveHaloRule::kQuantile:
      depth_m = naive_halo_quantile_m(ranges_m, settings.quantile);
      break;
  }
  return std::max(depth_m, settings.floor_m);
}

/// Depths (m, NaN where there is none) of all cells.
inline std::vector<double> naive_halo_depths(const std::vector<std::vector<double>>& ranges_m,
                                             const NaiveHaloDepthSettings& settings) {
  std::vector<double> depths_m;
  depths_m.reserve(ranges_m.size());
  for (const std::vector<double>& cell_ranges_m : ranges_m) {
    depths_m.push_back(naive_halo_depth_m(cell_ranges_m, settings));
  }
  return depths_m;
}

// ------------------------------------------------------------------------------- what is seen ---

/// Share (0 to 1) of 8 x 8 directions in a cell that project into an image of this size, as if
/// infinitely far.
inline double naive_halo_coverage(const NaiveGridSpec& spec,
                                  const NaivePairView& view,
                                  int width_px,
                                  int height_px,
                                  std::size_t cell) {
  int inside = 0;
  for (int i = 0; i < 8; ++i) {
    for (int j = 0; j < 8; ++j) {
      const NaiveSpherical place =
          naive_halo_place_in_cell(spec, cell, (i + 0.5) / 8.0, (j + 0.5) / 8.0);
      const NaiveVector3 body = naive_halo_direction(place.theta_rad, place.phi_rad);
      const auto pixel = naive_halo_project(view, naive_halo_to_camera(view, body));
      if (pixel.has_value() && (*pixel)[0] >= -0.5 && (*pixel)[0] < width_px - 0.5 &&
          (*pixel)[1] >= -0.5 && (*pixel)[1] < height_px - 0.5) {
        ++inside;
      }
    }
  }
  return inside / 64.0;
}

/// What is seen of each cell: every pixel counts in the cell of its viewing ray, turned to the body
/// frame, wherever its point is.
inline NaiveHaloSeen naive_halo_seen(const NaiveGridSpec& spec,
                                     const NaivePairView& view,
                                     const NaiveHaloImage& image) {
  const std::size_t cells = naive_halo_cell_count(spec);
  NaiveHaloSeen seen;
  seen.valid.assign(cells, 0);
  seen.invalid.assign(cells, 0);
  seen.nearest_seen_m.assign(cells, std::numeric_limits<double>::infinity());
  const std::vector<NaiveHaloReading> readings = naive_halo_readings(view, image);
  std::size_t pixel = 0;
  for (int v = 0; v < image.height_px; ++v) {
    for (int u = 0; u < image.width_px; ++u) {
      const NaiveHaloReading& reading = readings[pixel++];
      const NaiveVector3 ray_body = naive_halo_to_body(view, naive_halo_ray_camera(view, u, v));
      const std::optional<std::size_t> cell = naive_halo_cell_of(spec, ray_body);
      if (!cell.has_value()) {
        continue;
      }
      if (reading.state == NaiveHaloState::kInvalid) {
        ++seen.invalid[*cell];
      } else {
        ++seen.valid[*cell];
        seen.nearest_seen_m[*cell] = std::min(seen.nearest_seen_m[*cell], reading.range_m);
      }
    }
  }
  for (std::size_t cell = 0; cell < cells; ++cell) {
    const double coverage = naive_halo_coverage(spec, view, image.width_px, image.height_px, cell);
    const int looking = seen.valid[cell] + seen.invalid[cell];
    seen.coverage.push_back(coverage);
    seen.seen_share.push_back(
        looking == 0 ? 0.0 : static_cast<double>(seen.valid[cell]) / looking * coverage);
  }
  return seen;
}

// ------------------------------------------------------------------------------- what is free ---

/// Angle (rad) between a body-frame direction and the nearest corner of the cells, which are taken
/// to go on beyond the bounds of the grid.
inline double naive_halo_corner_angle_rad(const NaiveGridSpec& spec, const NaiveVector3& body) {
  const std::optional<NaiveSpherical> spherical = naive_spherical(body);
  if (!spherical.has_value()) {
    return 0.0;
  }
  const double row = (spherical->theta_rad - spec.theta_min_rad) / spec.step_rad;
  const double column = (spherical->phi_rad - spec.phi_min_rad) / spec.step_rad;
  const double phi_rad = spec.phi_min_rad + std::round(column) * spec.step_rad;
  const double above_rad = spec.theta_min_rad + std::floor(row) * spec.step_rad;
  const double below_rad = above_rad + spec.step_rad;
  return std::min(naive_halo_angle(body, naive_halo_direction(above_rad, phi_rad)),
                  naive_halo_angle(body, naive_halo_direction(below_rad, phi_rad)));
}

/// Angle (rad) between a body-frame direction and the nearest edge of the cells, likewise.
inline double naive_halo_edge_angle_rad(const NaiveGridSpec& spec, const NaiveVector3& body) {
  const std::optional<NaiveSpherical> spherical = naive_spherical(body);
  if (!spherical.has_value()) {
    return 0.0;
  }
  const double row = (spherical->theta_rad - spec.theta_min_rad) / spec.step_rad;
  const double column = (spherical->phi_rad - spec.phi_min_rad) / spec.step_rad;
  const double to_row_rad = std::abs(row - std::round(row)) * spec.step_rad;
  const double to_column_rad = std::abs(column - std::round(column)) * spec.step_rad;
  return std::min(to_row_rad, std::asin(std::sin(to_column_rad) * std::sin(spherical->theta_rad)));
}

/// What a walk goes through: one pair's grid, the pair, and what it sees.
struct NaiveHaloScene {
  NaiveGridSpec spec;
  NaivePairView view;
  NaiveHaloSeen seen;
  NaiveHaloFreeSettings settings;
};

/// A place on a walk: its range (m) from the body origin, the vector to it from the camera (m, body
/// axes), the cell whose direction that is, and whether the place is known to be free.
struct NaiveHaloPlace {
  double range_m = 0.0;
  NaiveVector3 from_camera_m = {0.0, 0.0, 0.0};
  std::optional<std::size_t> look_cell;
  bool free = false;
};

/// The place at range_m from the body origin in a direction (unit vector, body).
inline NaiveHaloPlace naive_halo_place(const NaiveHaloScene& scene,
                                       const NaiveVector3& direction,
                                       double range_m) {
  NaiveHaloPlace place;
  place.range_m = range_m;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    place.from_camera_m[axis] = range_m * direction[axis] - scene.view.t_body_camera_m[axis];
  }
  place.look_cell = naive_halo_cell_of(scene.spec, place.from_camera_m);
  if (place.look_cell.has_value()) {
    const std::size_t cell = *place.look_cell;
    place.free = scene.seen.seen_share[cell] >= scene.settings.min_seen_share &&
                 naive_halo_norm(place.from_camera_m) <=
                     std::min(scene.seen.nearest_seen_m[cell], scene.view.max_range_m);
  }
  return place;
}

/// Narrows two places on a walk, of which the predicate holds at `first` and not at `second`, to
/// 1e-12 of the range.
template <typename Predicate>
void naive_halo_bisect(const NaiveHaloScene& scene,
                       const NaiveVector3& direction,
                       const Predicate& holds,
                       NaiveHaloPlace& first,
                       NaiveHaloPlace& second) {
  while (second.range_m - first.range_m > 1e-12 * second.range_m) {
    const double middle_m = 0.5 * (first.range_m + second.range_m);
    if (middle_m <= first.range_m || middle_m >= second.range_m) {
      return;
    }
    const NaiveHaloPlace middle = naive_halo_place(scene, direction, middle_m);
    (holds(middle) ? first : second) = middle;
  }
}

/// Range (m) after a place for a walk's next step: at most 0.05 % on and about 1e-4 rad of the
/// camera's direction.
inline double naive_halo_next_m(const NaiveHaloScene& scene,
                                const NaiveVector3& direction,
                                const NaiveHaloPlace& here) {
  // The camera's distance to the walk's line.
  const NaiveVector3& camera_m = scene.view.t_body_camera_m;
  const double aside_m =
      naive_halo_norm(camera_m) * std::sin(naive_halo_angle(direction, camera_m));
  const double scale_m = std::max(here.range_m, 1e-3);
  double step_m = 0.0005 * scale_m;
  if (aside_m > 0.0) {
    const double squared_m2 = naive_halo_dot(here.from_camera_m, here.from_camera_m);
    step_m = std::min(step_m, 1e-4 * squared_m2 / aside_m);
  }
  return here.range_m + std::max(step_m, 1e-9 * scale_m);
}

/// The range (m) where a walk that is free at `here` ends before `next`, nothing if it goes on.
/// Appends the changes of the look-cell on the way.
inline std::optional<double> naive_halo_end_between(const NaiveHaloScene& scene,
                                                    const NaiveVector3& direction,
                                                    NaiveHaloPlace here,
                                                    const NaiveHaloPlace& next,
                                                    std::vector<NaiveHaloLook>& looks) {
  while (true) {
    // Where the look-cell changes first, if it does.
    NaiveHaloPlace last = next;
    NaiveHaloPlace change = next;
    if (here.look_cell != next.look_cell) {
      last = here;
      naive_halo_bisect(
          scene,
          direction,
          [&](const NaiveHaloPlace& place) { return place.look_cell == here.look_cell; },
          last,
          change);
    }
    // In one cell the free places are an interval: their distance to the camera is convex.
    if (!last.free) {
      naive_halo_bisect(
          scene, direction, [](const NaiveHaloPlace& place) { return place.free; }, here, last);
      return here.range_m;
    }
    if (here.look_cell == next.look_cell) {
      return std::nullopt;
    }
    looks.push_back({change.range_m, change.look_cell});
    if (!change.free) {
      return last.range_m;
    }
    here = change;
  }
}

/// Walks along a cell's centre from near_m outwards as long as every place is known to be free, by
/// fine steps; where a step changes the look-cell or ends the walk, that range is bisected.
inline NaiveHaloWalk naive_halo_walk(const NaiveHaloScene& scene, std::size_t cell) {
  const NaiveVector3 centre = naive_halo_centre(scene.spec, cell);
  NaiveHaloPlace here = naive_halo_place(scene, centre, scene.settings.near_m);
  NaiveHaloWalk walk;
  walk.looks.push_back({here.range_m, here.look_cell});
  walk.corner_margin_rad = naive_halo_corner_angle_rad(scene.spec, here.from_camera_m);
  walk.start_margin_rad = naive_halo_edge_angle_rad(scene.spec, here.from_camera_m);
  if (!here.free) {
    return walk;
  }
  double here_corner_rad = walk.corner_margin_rad;
  while (true) {
    const NaiveHaloPlace next =
        naive_halo_place(scene, centre, naive_halo_next_m(scene, centre, here));
    const double next_corner_rad = naive_halo_corner_angle_rad(scene.spec, next.from_camera_m);
    const double turn_rad = naive_halo_angle(here.from_camera_m, next.from_camera_m);
    const double margin_rad = std::min(here_corner_rad, next_corner_rad) - 0.5 * turn_rad;
    walk.corner_margin_rad = std::min(walk.corner_margin_rad, margin_rad);
    const std::optional<double> end_m =
        naive_halo_end_between(scene, centre, here, next, walk.looks);
    if (end_m.has_value()) {
      walk.free_to_m = *end_m;
      return walk;
    }
    here = next;
    here_corner_rad = next_corner_rad;
  }
}

/// The walks of all cells.
inline std::vector<NaiveHaloWalk> naive_halo_walks(const NaiveHaloScene& scene) {
  std::vector<NaiveHaloWalk> walks;
  for (std::size_t cell = 0; cell < naive_halo_cell_count(scene.spec); ++cell) {
    walks.push_back(naive_halo_walk(scene, cell));
  }
  return walks;
}

/// How far each cell is free (m, 0 is unseen): its walk, limited by its depth (m) if it has one.
inline std::vector<double> naive_halo_free_to(const std::vector<NaiveHaloWalk>& walks,
                                              const std::vector<double>& depth_m) {
  std::vector<double> free_to_m;
  for (std::size_t cell = 0; cell < walks.size(); ++cell) {
    const double walked_m = walks[cell].free_to_m;
    free_to_m.push_back(std::isnan(depth_m[cell]) ? walked_m : std::min(walked_m, depth_m[cell]));
  }
  return free_to_m;
}

/// What is seen, judged through the window about each cell: the share of the window's pixels that
/// are valid, times the cell's own coverage, and the nearest that any of them sees. The window has
/// the rows within window_rad (rounded to whole rows) and in each of these the columns within
/// window_rad / sin(theta of the row's middle) (rounded to whole ones), or at most half a row to
/// either side without meeting itself. A cell that no valid pixel looks into itself is not seen.
/// Columns wrap where the grid goes all the way round.
inline NaiveHaloSeen naive_halo_windowed(const NaiveGridSpec& spec,
                                         const NaiveHaloSeen& seen,
                                         double window_rad) {
  const int window_rows = static_cast<int>(std::lround(window_rad / spec.step_rad));
  const int rows = naive_row_count(spec);
  const int columns = naive_column_count(spec);
  const bool circle =
      static_cast<int>(std::lround(2.0 * std::numbers::pi / spec.step_rad)) == columns;
  NaiveHaloSeen windowed = seen;
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      const auto own = static_cast<std::size_t>(row * columns + column);
      int valid = 0;
      int looking = 0;
      for (int r = row - window_rows; r <= row + window_rows; ++r) {
        const double theta_rad = spec.theta_min_rad + (r + 0.5) * spec.step_rad;
        const double reach =
            std::min(window_rad / (spec.step_rad * std::sin(theta_rad)), columns / 2.0 - 1.0);
        const int window_columns = static_cast<int>(std::lround(reach));
        if (r < 0 || r >= rows) {
          continue;
        }
        for (int c = column - window_columns; c <= column + window_columns; ++c) {
          if (!circle && (c < 0 || c >= columns)) {
            continue;
          }
          const auto other = static_cast<std::size_t>(r * columns + (c + columns) % columns);
          valid += seen.valid[other];
          looking += seen.valid[other] + seen.invalid[other];
          windowed.nearest_seen_m[own] =
              std::min(windowed.nearest_seen_m[own], seen.nearest_seen_m[other]);
        }
      }
      windowed.seen_share[own] =
          seen.valid[own] == 0 ? 0.0 : static_cast<double>(valid) / looking * seen.coverage[own];
    }
  }
  return windowed;
}

/// All about one pair's grid.
inline NaiveHaloPair naive_halo_pair(const NaiveGridSpec& spec,
                                     const NaivePairView& view,
                                     const NaiveHaloImage& image,
                                     const NaiveHaloDepthSettings& depth_settings,
                                     const NaiveHaloFreeSettings& free_settings) {
  NaiveHaloPair pair;
  pair.spec = spec;
  pair.ranges_m = naive_halo_ranges(spec, view, image);
  pair.depth_m = naive_halo_depths(pair.ranges_m, depth_settings);
  pair.seen = naive_halo_seen(spec, view, image);
  const NaiveHaloSeen windowed = naive_halo_windowed(spec, pair.seen, free_settings.window_rad);
  pair.walks = naive_halo_walks({spec, view, windowed, free_settings});
  pair.free_to_m = naive_halo_free_to(pair.walks, pair.depth_m);
  return pair;
}

// ----------------------------------------------------------------------------------- stitching ---

/// The grid of the whole sphere, rows from up, columns from phi = -pi; the step in radians.
inline NaiveGridSpec naive_halo_sphere_spec(double step_rad) {
  NaiveGridSpec spec;
  spec.theta_max_rad = std::numbers::pi;
  spec.phi_min_rad = -std::numbers::pi;
  spec.phi_max_rad = std::numbers::pi;
  spec.step_rad = step_rad;
  return spec;
}

/// One cell of the stitched sphere: depth (m, NaN if none), source and free_to (m).
struct NaiveHaloStitched {
  double depth_m = std::numeric_limits<double>::quiet_NaN();
  std::uint8_t source = kNaiveHaloNoSource;
  double free_to_m = 0.0;
};

/// Stitches the cell whose centre is in this direction.
inline NaiveHaloStitched naive_halo_stitched_cell(
    const std::vector<std::optional<NaiveHaloPair>>& pairs, const NaiveSpherical& centre) {
  NaiveHaloStitched nearest;
  NaiveHaloStitched freest;
  for (std::size_t index = 0; index < pairs.size(); ++index) {
    const std::optional<NaiveHaloPair>& pair = pairs[index];
    const auto own = pair.has_value() ? naive_cell_index(pair->spec, centre) : std::nullopt;
    if (!own.has_value()) {
      continue;
    }
    const double depth_m = pair->depth_m[*own];
    const double free_to_m = pair->free_to_m[*own];
    const auto source = static_cast<std::uint8_t>(index);
    if (depth_m < nearest.depth_m || (std::isnan(nearest.depth_m) && !std::isnan(depth_m))) {
      nearest.depth_m = depth_m;
      nearest.source = source;
    }
    if (free_to_m > freest.free_to_m) {
      freest.free_to_m = free_to_m;
      freest.source = source;
    }
  }
  if (std::isnan(nearest.depth_m)) {
    return freest;
  }
  nearest.free_to_m = std::min(freest.free_to_m, nearest.depth_m);
  return nearest;
}

/// Stitches the pairs' grids (all of this step, bounds multiples of it; some may be absent). Reads
/// only their spec, depth_m and free_to_m (METHOD.md section 4).
inline NaiveHaloSphere naive_halo_stitch(double step_rad,
                                         const std::vector<std::optional<NaiveHaloPair>>& pairs) {
  NaiveHaloSphere sphere;
  sphere.spec = naive_halo_sphere_spec(step_rad);
  for (std::size_t cell = 0; cell < naive_halo_cell_count(sphere.spec); ++cell) {
    const NaiveSpherical centre = naive_halo_place_in_cell(sphere.spec, cell, 0.5, 0.5);
    const NaiveHaloStitched stitched = naive_halo_stitched_cell(pairs, centre);
    sphere.depth_m.push_back(stitched.depth_m);
    sphere.source.push_back(stitched.source);
    sphere.free_to_m.push_back(stitched.free_to_m);
  }
  return sphere;
}

// ------------------------------------------------------------------------------------- queries ---

/// Answer over the cells that are marked.
inline NaiveHaloAnswer naive_halo_answer(const NaiveHaloSphere& sphere,
                                         const std::vector<bool>& marked) {
  NaiveHaloAnswer answer;
  double free_to_m = std::numeric_limits<double>::infinity();
  for (std::size_t cell = 0; cell < marked.size(); ++cell) {
    if (!marked[cell]) {
      continue;
    }
    ++answer.cells;
    free_to_m = std::min(free_to_m, sphere.free_to_m[cell]);
    if (std::isnan(sphere.depth_m[cell])) {
      answer.unseen_cells += sphere.free_to_m[cell] > 0.0 ? 0 : 1;
    } else if (sphere.depth_m[cell] < answer.nearest_m) {
      answer.nearest_m = sphere.depth_m[cell];
      answer.nearest_cell = cell;
    }
  }
  answer.free_to_m = answer.cells > 0 ? free_to_m : 0.0;
  return answer;
}

/// Cells whose centre is within half_angle_rad of an axis (body, any length but 0), and the one
/// that holds the axis. Straight down belongs to the last row.
inline std::vector<bool> naive_halo_cone_cells(const NaiveHaloSphere& sphere,
                                               const NaiveVector3& axis_body,
                                               double half_angle_rad) {
  std::vector<bool> marked;
  for (std::size_t cell = 0; cell < naive_halo_cell_count(sphere.spec); ++cell) {
    const NaiveVector3 centre = naive_halo_centre(sphere.spec, cell);
    marked.push_back(naive_halo_angle(centre, axis_body) <= half_angle_rad);
  }
  std::optional<NaiveSpherical> axis = naive_spherical(axis_body);
  if (axis.has_value()) {
    axis->theta_rad = std::min(axis->theta_rad, std::nextafter(std::numbers::pi, 0.0));
    const std::optional<std::size_t> cell = naive_cell_index(sphere.spec, *axis);
    if (cell.has_value()) {
      marked[*cell] = true;
    }
  }
  return marked;
}

/// Cells whose centre is in a box of angles.
inline std::vector<bool> naive_halo_box_cells(const NaiveHaloSphere& sphere,
                                              const NaiveHaloBox& box) {
  const double turn_rad = 2.0 * std::numbers::pi;
  double phi_max_rad = box.phi_max_rad;
  while (phi_max_rad < box.phi_min_rad) {
    phi_max_rad += turn_rad;
  }
  std::vector<bool> marked;
  for (std::size_t cell = 0; cell < naive_halo_cell_count(sphere.spec); ++cell) {
    const NaiveSpherical centre = naive_halo_place_in_cell(sphere.spec, cell, 0.5, 0.5);
    double phi_rad = centre.phi_rad;  // moved to the first turn that is not before the box
    while (phi_rad >= box.phi_min_rad) {
      phi_rad -= turn_rad;
    }
    while (phi_rad < box.phi_min_rad) {
      phi_rad += turn_rad;
    }
    marked.push_back(centre.theta_rad >= box.theta_min_rad &&
                     centre.theta_rad < box.theta_max_rad && phi_rad < phi_max_rad);
  }
  return marked;
}

/// What is known in a cone about an axis (body, any length but 0); the half angle in radians.
inline NaiveHaloAnswer naive_halo_in_cone(const NaiveHaloSphere& sphere,
                                          const NaiveVector3& axis_body,
                                          double half_angle_rad) {
  return naive_halo_answer(sphere, naive_halo_cone_cells(sphere, axis_body, half_angle_rad));
}

/// What is known in a box of angles.
inline NaiveHaloAnswer naive_halo_in_box(const NaiveHaloSphere& sphere, const NaiveHaloBox& box) {
  return naive_halo_answer(sphere, naive_halo_box_cells(sphere, box));
}

}  // namespace skyhalo::reference

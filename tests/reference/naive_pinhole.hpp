#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>

namespace skyhalo::reference {

/// Equatorial radius of the Mercator projection of the KITTI INS poses, metres.
inline constexpr double kEarthRadiusM = 6378137.0;

/// A rectified pinhole pair: baseline in metres, focal length and principal point in pixels of the
/// right (reference) image; pixel centres are at integers.
struct NaivePinholePair {
  double baseline_m = 0.0;
  double focal_px = 0.0;
  double u0_px = 0.0;
  double v0_px = 0.0;
};

/// A pixel of the right image (u right, v down) and its disparity, all in pixels.
struct NaivePixel {
  double u_px = 0.0;
  double v_px = 0.0;
  double disparity_px = 0.0;
};

/// One INS record in the units of the file: WGS84 latitude and longitude in degrees, altitude in
/// metres, roll, pitch and yaw in radians (yaw 0 is east, counter-clockwise positive).
struct NaiveOxts {
  double lat_deg = 0.0;
  double lon_deg = 0.0;
  double alt_m = 0.0;
  double roll_rad = 0.0;
  double pitch_rad = 0.0;
  double yaw_rad = 0.0;
};

using NaiveMatrix3 = std::array<std::array<double, 3>, 3>;
using NaiveMatrix4 = std::array<std::array<double, 4>, 4>;

/// Point in the camera frame (rectified right camera: x right, y down, z forward), metres, of a
/// pixel with a disparity (thesis eq. 4.1). NaN unless the disparity is > 0.
inline std::array<double, 3> naive_pinhole_point_cam_m(const NaivePinholePair& pair,
                                                       const NaivePixel& pixel) {
  if (!(pixel.disparity_px > 0.0)) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    return {nan, nan, nan};
  }
  const double scale_m_per_px = pair.baseline_m / pixel.disparity_px;
  return {(pixel.u_px - pair.u0_px) * scale_m_per_px,
          (pixel.v_px - pair.v0_px) * scale_m_per_px,
          pair.focal_px * scale_m_per_px};
}

/// Uncertainty in metres of that point, per camera-frame axis and with the sign of the pixel's
/// offset, for a disparity uncertainty delta_d_px in pixels (thesis eq. 4.2). NaN unless the
/// disparity is > 0.
inline std::array<double, 3> naive_pinhole_delta_cam_m(const NaivePinholePair& pair,
                                                       const NaivePixel& pixel,
                                                       double delta_d_px) {
  if (!(pixel.disparity_px > 0.0)) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    return {nan, nan, nan};
  }
  const double scale_m_per_px =
      pair.baseline_m / (pixel.disparity_px * pixel.disparity_px) * delta_d_px;
  return {(pixel.u_px - pair.u0_px) * scale_m_per_px,
          (pixel.v_px - pair.v0_px) * scale_m_per_px,
          pair.focal_px * scale_m_per_px};
}

/// The pair of the image down-sampled by `factor` (1, 2, 4, no unit) with area averaging: the
/// focal length becomes f / s and the principal point (u0 + 0.5) / s - 0.5, likewise v0; the
/// baseline in metres stays (METHOD.md section 1). Disparities shrink by 1 / s too.
inline NaivePinholePair naive_downsampled(const NaivePinholePair& pair, double factor) {
  NaivePinholePair result;
  result.baseline_m = pair.baseline_m;
  result.focal_px = pair.focal_px / factor;
  result.u0_px = (pair.u0_px + 0.5) / factor - 0.5;
  result.v0_px = (pair.v0_px + 0.5) / factor - 0.5;
  return result;
}

/// Matrix product a * b.
inline NaiveMatrix3 naive_product(const NaiveMatrix3& a, const NaiveMatrix3& b) {
  NaiveMatrix3 result{};
  for (std::size_t row = 0; row < 3; ++row) {
    for (std::size_t column = 0; column < 3; ++column) {
      for (std::size_t k = 0; k < 3; ++k) {
        result[row][column] += a[row][k] * b[k][column];
      }
    }
  }
  return result;
}

/// Rotation Rz(yaw) * Ry(pitch) * Rx(roll), radians, from the body frame (x forward, y left, z up)
/// to east-north-up (the rotation of T_map_body in thesis eq. 7.1).
inline NaiveMatrix3 naive_rotation(const NaiveOxts& oxts) {
  const double cr = std::cos(oxts.roll_rad);
  const double sr = std::sin(oxts.roll_rad);
  const double cp = std::cos(oxts.pitch_rad);
  const double sp = std::sin(oxts.pitch_rad);
  const double cy = std::cos(oxts.yaw_rad);
  const double sy = std::sin(oxts.yaw_rad);
  const NaiveMatrix3 roll = {{{1.0, 0.0, 0.0}, {0.0, cr, -sr}, {0.0, sr, cr}}};
  const NaiveMatrix3 pitch = {{{cp, 0.0, sp}, {0.0, 1.0, 0.0}, {-sp, 0.0, cp}}};
  const NaiveMatrix3 yaw = {{{cy, -sy, 0.0}, {sy, cy, 0.0}, {0.0, 0.0, 1.0}}};
  return naive_product(yaw, naive_product(pitch, roll));
}

/// Pose T_enu_body of an INS record: body (INS) coordinates to east-north-up, metres, by the
/// Mercator projection whose scale is the cosine of the first record's latitude (METHOD.md
/// sections 0 and 7, the pose of thesis eq. 7.1). Not made relative to the first pose.
inline NaiveMatrix4 naive_pose_from_oxts(const NaiveOxts& oxts, double first_lat_deg) {
  const double pi = std::numbers::pi;
  const double scale = std::cos(first_lat_deg * pi / 180.0);
  const double east_m = scale * kEarthRadiusM * oxts.lon_deg * pi / 180.0;
  const double north_m =
      scale * kEarthRadiusM * std::log(std::tan((90.0 + oxts.lat_deg) * pi / 360.0));
  const NaiveMatrix3 rotation = naive_rotation(oxts);
  NaiveMatrix4 T_enu_body{};
  for (std::size_t row = 0; row < 3; ++row) {
    for (std::size_t column = 0; column < 3; ++column) {
      T_enu_body[row][column] = rotation[row][column];
    }
  }
  T_enu_body[0][3] = east_m;
  T_enu_body[1][3] = north_m;
  T_enu_body[2][3] = oxts.alt_m;
  T_enu_body[3][3] = 1.0;
  return T_enu_body;
}

}  // namespace skyhalo::reference

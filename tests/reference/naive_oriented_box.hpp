#pragma once

#include <array>
#include <cmath>
#include <cstddef>

namespace skyhalo::reference {

/// A 3D box as a KITTI tracking label gives it, in rectified camera-0 coordinates (x right,
/// y down, z forward): sizes in metres (> 0), the centre of its bottom face in metres, and its
/// rotation about y in radians. The members are in the order of the label's columns.
struct NaiveBox {
  double h_m = 0.0;
  double w_m = 0.0;
  double l_m = 0.0;
  double x_m = 0.0;
  double y_m = 0.0;
  double z_m = 0.0;
  double rotation_y_rad = 0.0;
};

/// The eight corners in camera-0 coordinates, metres: 0-3 the bottom face, 4-7 the top face above
/// them. The neighbours of corner 0 are 1 (along the width), 3 (along the length) and 4 (along
/// the height), as thesis eq. A.1 wants them.
inline std::array<std::array<double, 3>, 8> naive_box_corners(const NaiveBox& box) {
  const std::array<double, 8> sign_x = {1, 1, -1, -1, 1, 1, -1, -1};
  const std::array<double, 8> sign_z = {1, -1, -1, 1, 1, -1, -1, 1};
  const double cosine = std::cos(box.rotation_y_rad);
  const double sine = std::sin(box.rotation_y_rad);
  std::array<std::array<double, 3>, 8> corners{};
  for (std::size_t i = 0; i < 8; ++i) {
    const double local_x_m = sign_x[i] * box.l_m / 2.0;
    const double local_y_m = i < 4 ? 0.0 : -box.h_m;
    const double local_z_m = sign_z[i] * box.w_m / 2.0;
    corners[i][0] = cosine * local_x_m + sine * local_z_m + box.x_m;
    corners[i][1] = local_y_m + box.y_m;
    corners[i][2] = -sine * local_x_m + cosine * local_z_m + box.z_m;
  }
  return corners;
}

/// a - b, component by component.
inline std::array<double, 3> naive_difference(const std::array<double, 3>& a,
                                              const std::array<double, 3>& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

/// Cross product a x b.
inline std::array<double, 3> naive_cross(const std::array<double, 3>& a,
                                         const std::array<double, 3>& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// Dot product of a and b.
inline double naive_dot(const std::array<double, 3>& a, const std::array<double, 3>& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// True if value lies between the two ends, in either order, ends included.
inline bool naive_between(double value, double end_a, double end_b) {
  return (end_a <= value && value <= end_b) || (end_b <= value && value <= end_a);
}

/// True if a point in rectified camera-0 coordinates (metres) lies inside the box, faces included
/// (thesis eq. A.1-A.2 as METHOD.md section 7 restates them). A NaN point is outside.
inline bool naive_inside_box(const NaiveBox& box, const std::array<double, 3>& point_cam_m) {
  const std::array<std::array<double, 3>, 8> corners = naive_box_corners(box);
  const std::array<double, 3> p0 = corners[0];
  const std::array<double, 3> p1 = corners[1];
  const std::array<double, 3> p3 = corners[3];
  const std::array<double, 3> p4 = corners[4];
  const std::array<double, 3> u = naive_cross(naive_difference(p0, p3), naive_difference(p0, p4));
  const std::array<double, 3> v = naive_cross(naive_difference(p0, p1), naive_difference(p0, p4));
  const std::array<double, 3> w = naive_cross(naive_difference(p0, p1), naive_difference(p0, p3));
  return naive_between(naive_dot(u, point_cam_m), naive_dot(u, p0), naive_dot(u, p1)) &&
         naive_between(naive_dot(v, point_cam_m), naive_dot(v, p0), naive_dot(v, p3)) &&
         naive_between(naive_dot(w, point_cam_m), naive_dot(w, p0), naive_dot(w, p4));
}

}  // namespace skyhalo::reference

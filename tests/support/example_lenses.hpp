#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <type_traits>
#include <vector>

#include "reference/naive_lens.hpp"
#include "skyhalo/camera/raw_pair.hpp"

namespace skyhalo::testing {

/// A lens, the image it comes with, and what to call it in a failing test.
struct ExampleLens {
  std::string name;
  Lens lens;
  cv::Size size_px;
};

/// The radial polynomial 1 + k1 s + k2 s^2 (s the square of the radius) whose image radius almost
/// stands still at a radius of 1.2 and shrinks between 1.194 and 1.206.
inline std::array<double, 2> narrow_fold() {
  constexpr double kDip = 1e-4;
  constexpr double kAt2 = 1.2 * 1.2;
  return {-2.0 / (3.0 * kAt2 * (1.0 - kDip)), 1.0 / (5.0 * kAt2 * kAt2 * (1.0 - kDip))};
}

inline std::vector<ExampleLens> radial_tangential_examples() {
  const Intrinsics euroc{458.654, 457.296, 367.215, 248.375};
  const Intrinsics vga{400.0, 404.0, 319.5, 241.0};
  const std::array<double, 2> fold = narrow_fold();
  return {
      {"pinhole", RadialTangentialLens(vga, {}), {640, 480}},
      {"EuRoC",
       RadialTangentialLens(euroc, {-0.28340811, 0.07395907, 0.00019359, 1.76187114e-05}),
       {752, 480}},
      {"5 coefficients",
       RadialTangentialLens({536.07, 536.02, 342.37, 235.54},
                            {-0.26563, -0.046742, 0.001833, -0.00031471, 0.25231}),
       {640, 480}},
      {"8 coefficients",
       RadialTangentialLens({504.98, 505.04, 322.65, 334.18},
                            {5.2654, 3.6204, -6.3e-05, -3.9e-05, 0.18798, 5.6015, 5.6846, 0.97863}),
       {640, 576}},
      {"folds back inside the image",
       RadialTangentialLens(vga, {-0.4, 0.0, 0.0005, -0.0003}),
       {640, 480}},
      {"folds back narrowly", RadialTangentialLens(vga, {fold[0], fold[1]}), {640, 480}},
      {"decentred", RadialTangentialLens(vga, {0.1, -0.02, 0.05, -0.03}), {640, 480}},
      {"pincushion", RadialTangentialLens(vga, {0.3, 0.1, -0.001, 0.002, 0.05}), {640, 480}},
      {"has a pole", RadialTangentialLens(vga, {0.0, 0.0, 0.0, 0.0, 0.0, -0.5}), {640, 480}},
  };
}

/// An ideal fisheye whose field of view (degrees) fills 1280 columns.
inline ExampleLens ideal_fisheye(double field_deg) {
  const double focal_px = 1280.0 / (field_deg * std::numbers::pi / 180.0);
  return {"ideal fisheye of " + std::to_string(field_deg) + " degrees",
          KannalaBrandtLens({focal_px, focal_px, 639.5, 511.5}, {}),
          {1280, 1024}};
}

inline std::vector<ExampleLens> kannala_brandt_examples() {
  const std::array<double, 2> fold = narrow_fold();
  return {
      {"Mynteye fisheye",
       KannalaBrandtLens({366.163, 365.631, 380.573, 225.950},
                         {-0.020476443, -0.007108226, 0.002180580, -0.001192386}),
       {752, 480}},
      ideal_fisheye(175.0),
      ideal_fisheye(200.0),
      {"fisheye of 200 degrees",
       KannalaBrandtLens({286.0, 286.2, 425.5, 398.9}, {-0.0085, 0.0450, -0.0424, 0.0080}),
       {848, 800}},
      {"fisheye that folds back narrowly",
       KannalaBrandtLens({366.0, 366.0, 380.0, 226.0}, {fold[0], fold[1], 0.0, 0.0}),
       {752, 480}},
      {"stretching fisheye",
       KannalaBrandtLens({300.0, 310.0, 400.0, 300.0}, {0.1, 0.02, 0.01, 0.005}),
       {800, 600}},
  };
}

inline std::vector<ExampleLens> double_sphere_examples() {
  const Intrinsics wide{349.756, 348.7245, 365.894, 249.33};
  const auto make = [&](double xi, double alpha) {
    return ExampleLens{"double sphere xi " + std::to_string(xi) + " alpha " + std::to_string(alpha),
                       DoubleSphereLens(wide, {.xi = xi, .alpha = alpha}),
                       {752, 480}};
  };
  return {make(-0.24096, 0.567),
          make(-0.3, 0.4),
          make(-0.5, 0.9),
          make(-0.5, 0.1),
          make(-0.9, 0.6),
          make(0.0, 0.0),
          make(0.0, 1.0),
          make(0.0, 0.5),
          make(0.77, 0.6),
          make(0.5, 0.0),
          make(1.0, 0.3),
          make(1.0, 1.0)};
}

inline std::vector<ExampleLens> extended_unified_examples() {
  const Intrinsics wide{460.979, 459.753, 366.891, 249.273};
  const auto make = [&](double alpha, double beta) {
    return ExampleLens{
        "extended unified alpha " + std::to_string(alpha) + " beta " + std::to_string(beta),
        ExtendedUnifiedLens(wide, {.alpha = alpha, .beta = beta}),
        {752, 480}};
  };
  return {make(0.59166, 1.1241),
          make(0.4, 0.9),
          make(0.5, 1.0),
          make(0.0, 1.0),
          make(1.0, 1.0),
          make(0.9, 0.2),
          make(0.7, 5.0),
          make(0.1, 3.0)};
}

inline std::vector<ExampleLens> example_lenses() {
  std::vector<ExampleLens> all = radial_tangential_examples();
  for (const auto& more :
       {kannala_brandt_examples(), double_sphere_examples(), extended_unified_examples()}) {
    all.insert(all.end(), more.begin(), more.end());
  }
  return all;
}

/// The naive projection by the parameters that the lens was made with.
inline reference::NaiveImagePoint naive_project(const Lens& lens,
                                                const reference::NaiveVector& point) {
  const Intrinsics& in = intrinsics(lens);
  const reference::NaiveIntrinsics camera{in.fx_px, in.fy_px, in.cx_px, in.cy_px};
  return std::visit(
      [&](const auto& model) {
        using Model = std::decay_t<decltype(model)>;
        if constexpr (std::is_same_v<Model, RadialTangentialLens>) {
          return reference::naive_radial_tangential(camera, model.distortion(), point);
        } else if constexpr (std::is_same_v<Model, KannalaBrandtLens>) {
          return reference::naive_kannala_brandt(camera, model.distortion(), point);
        } else if constexpr (std::is_same_v<Model, DoubleSphereLens>) {
          return reference::naive_double_sphere(
              camera, model.shape().xi, model.shape().alpha, point);
        } else {
          return reference::naive_extended_unified(
              camera, model.shape().alpha, model.shape().beta, point);
        }
      },
      lens);
}

/// The larger focal length, the scale of pixels.
inline double focal_px(const Lens& lens) {
  return std::max(intrinsics(lens).fx_px, intrinsics(lens).fy_px);
}

/// Unit vector at an angle theta from the optical axis in the direction phi of the image.
inline Eigen::Vector3d ray_at(double theta_rad, double phi_rad) {
  return {std::sin(theta_rad) * std::cos(phi_rad),
          std::sin(theta_rad) * std::sin(phi_rad),
          std::cos(theta_rad)};
}

/// Angle between two vectors, exact for small ones too.
inline double angle_between_rad(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

/// Seeded random numbers, rays and rotations.
class RandomRays {
 public:
  explicit RandomRays(unsigned seed) : random_(seed) {}

  double in(double from, double to) {
    return std::uniform_real_distribution<double>(from, to)(random_);
  }

  /// A direction within `max_angle_rad` of the optical axis, the angle evenly spread.
  Eigen::Vector3d ray(double max_angle_rad) {
    const double theta = in(0.0, max_angle_rad);
    return ray_at(theta, in(0.0, 2.0 * std::numbers::pi));
  }

  /// A turn by up to `max_angle_rad` about any axis.
  Eigen::Matrix3d rotation(double max_angle_rad) {
    const Eigen::Vector3d axis = ray(std::numbers::pi);
    return Eigen::AngleAxisd(in(0.0, max_angle_rad), axis).toRotationMatrix();
  }

  /// Either sign, and a magnitude of any power of ten between the two.
  double wild(double from_exponent, double to_exponent) {
    const double sign = in(-1.0, 1.0) < 0.0 ? -1.0 : 1.0;
    return sign * std::pow(10.0, in(from_exponent, to_exponent));
  }

 private:
  std::mt19937 random_;
};

}  // namespace skyhalo::testing

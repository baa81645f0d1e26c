#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

namespace skyhalo::reference {

/// Focal lengths and principal point in pixels; pixel centres are at integers.
struct NaiveIntrinsics {
  double fx_px = 0.0;
  double fy_px = 0.0;
  double cx_px = 0.0;
  double cy_px = 0.0;
};

/// A point or direction in the camera frame: x right, y down, z forward.
using NaiveVector = std::array<double, 3>;

/// Pixel (u, v), u right, v down.
using NaiveImagePoint = std::array<double, 2>;

/// Pinhole with radial and tangential distortion (Brown 1966) with the coefficients in OpenCV's
/// order k1 k2 p1 p2 k3 k4 k5 k6. For z > 0; the domain is not looked at.
inline NaiveImagePoint naive_radial_tangential(const NaiveIntrinsics& camera,
                                               const std::array<double, 8>& k,
                                               const NaiveVector& point) {
  const double x = point[0] / point[2];
  const double y = point[1] / point[2];
  const double r2 = x * x + y * y;
  const double above = 1.0 + k[0] * r2 + k[1] * r2 * r2 + k[4] * r2 * r2 * r2;
  const double below = 1.0 + k[5] * r2 + k[6] * r2 * r2 + k[7] * r2 * r2 * r2;
  const double xd = x * above / below + 2.0 * k[2] * x * y + k[3] * (r2 + 2.0 * x * x);
  const double yd = y * above / below + k[2] * (r2 + 2.0 * y * y) + 2.0 * k[3] * x * y;
  return {camera.fx_px * xd + camera.cx_px, camera.fy_px * yd + camera.cy_px};
}

/// Fisheye of Kannala and Brandt 2006 with k1..k4: the image radius is an odd polynomial of the
/// angle to the optical axis.
inline NaiveImagePoint naive_kannala_brandt(const NaiveIntrinsics& camera,
                                            const std::array<double, 4>& k,
                                            const NaiveVector& point) {
  const double across = std::hypot(point[0], point[1]);
  if (across == 0.0) {
    return {camera.cx_px, camera.cy_px};
  }
  const double theta = std::atan2(across, point[2]);
  const double radius = theta + k[0] * std::pow(theta, 3) + k[1] * std::pow(theta, 5) +
                        k[2] * std::pow(theta, 7) + k[3] * std::pow(theta, 9);
  return {camera.fx_px * radius * point[0] / across + camera.cx_px,
          camera.fy_px * radius * point[1] / across + camera.cy_px};
}

/// Double sphere lens (Usenko, Demmel, Cremers 2018, section 4).
inline NaiveImagePoint naive_double_sphere(const NaiveIntrinsics& camera,
                                           double xi,
                                           double alpha,
                                           const NaiveVector& point) {
  const double x = point[0];
  const double y = point[1];
  const double z = point[2];
  const double d1 = std::sqrt(x * x + y * y + z * z);
  const double d2 = std::sqrt(x * x + y * y + (xi * d1 + z) * (xi * d1 + z));
  const double n = alpha * d2 + (1.0 - alpha) * (xi * d1 + z);
  return {camera.fx_px * x / n + camera.cx_px, camera.fy_px * y / n + camera.cy_px};
}

/// Extended unified lens (Khomutenko, Garcia, Martinet 2016).
inline NaiveImagePoint naive_extended_unified(const NaiveIntrinsics& camera,
                                              double alpha,
                                              double beta,
                                              const NaiveVector& point) {
  const double rho =
      std::sqrt(beta * (point[0] * point[0] + point[1] * point[1]) + point[2] * point[2]);
  const double n = alpha * rho + (1.0 - alpha) * point[2];
  return {camera.fx_px * point[0] / n + camera.cx_px, camera.fy_px * point[1] / n + camera.cy_px};
}

/// Angle (rad) from the optical axis of where the image of a double sphere lens first stands still
/// (alpha > 1/2) or runs to infinity. On the second sphere that is the angle psi with
/// `cos psi = -w1`; by the sine rule in the triangle of both centres and the point on the first
/// sphere, the angle there is `psi + asin(xi sin psi)`.
inline double naive_double_sphere_limit_rad(double xi, double alpha) {
  if (xi >= 1.0) {
    return std::numbers::pi;  // psi is half the angle: never beyond a quarter turn
  }
  const double w1 = alpha > 0.5 ? (1.0 - alpha) / alpha : alpha / (1.0 - alpha);
  const double psi = std::acos(-w1);
  return psi + std::asin(xi * std::sin(psi));
}

/// The same of an extended unified lens: a unified one of the point with x and y stretched by
/// sqrt(beta), whose limit is `cos psi = -w`.
inline double naive_extended_unified_limit_rad(double alpha, double beta) {
  const double w = alpha > 0.5 ? (1.0 - alpha) / alpha : alpha / (1.0 - alpha);
  const double psi = std::acos(-w);
  return std::atan2(std::sin(psi) / std::sqrt(beta), std::cos(psi));
}

/// The first angle in (0, end_rad] at which an image radius, a function of the angle, no longer
/// grows; `end_rad` where there is none. By small steps, then ten times smaller ones, and so on.
template <class Radius>
double naive_first_fold_rad(const Radius& radius, double end_rad) {
  double from = 0.0;
  double step = end_rad / 20000.0;
  bool folds = false;
  for (int level = 0; level < 4; ++level) {
    double last = radius(from);
    double at = from + step;
    while (at <= end_rad && radius(at) > last) {
      last = radius(at);
      at += step;
    }
    folds = folds || at <= end_rad;
    if (!folds) {
      return end_rad;
    }
    from = std::max(0.0, at - 2.0 * step);
    step /= 10.0;
  }
  return from;
}

/// Unit vector at an angle from the optical axis of |w| towards (w0, w1); `w` in radians.
inline NaiveVector naive_direction(const std::array<double, 2>& w) {
  const double theta = std::hypot(w[0], w[1]);
  if (theta == 0.0) {
    return {0.0, 0.0, 1.0};
  }
  return {std::sin(theta) * w[0] / theta, std::sin(theta) * w[1] / theta, std::cos(theta)};
}

/// Looks for the directions within an angle of the optical axis that a projection sends to one
/// pixel: tries a grid of directions and improves each that is better than its neighbours by
/// Newton's method with numeric derivatives.
template <class Projection>
class NaiveInverse {
 public:
  /// `project` takes a `NaiveVector` to a `NaiveImagePoint`.
  NaiveInverse(Projection project, double max_angle_rad)
      : project_(project), max_angle_rad_(max_angle_rad) {
    for (std::size_t ring = 0; ring < kRings; ++ring) {
      for (std::size_t spoke = 0; spoke < kSpokes; ++spoke) {
        images_.push_back(image(direction_at(ring, spoke)));
      }
    }
  }

  /// All that were found, each once; good to 1e-10 rad where the image does not stand still.
  [[nodiscard]] std::vector<NaiveVector> all(const NaiveImagePoint& pixel) const {
    std::vector<NaiveVector> found;
    for (std::size_t ring = 0; ring < kRings; ++ring) {
      for (std::size_t spoke = 0; spoke < kSpokes; ++spoke) {
        std::array<double, 2> w = direction_at(ring, spoke);
        if (is_best_of_neighbours(ring, spoke, pixel) && improve(w, pixel)) {
          add_new(found, naive_direction(w));
        }
      }
    }
    return found;
  }

 private:
  static constexpr std::size_t kRings = 64;
  static constexpr std::size_t kSpokes = 48;

  [[nodiscard]] std::array<double, 2> direction_at(std::size_t ring, std::size_t spoke) const {
    const double theta = max_angle_rad_ * (static_cast<double>(ring) + 0.5) / kRings;
    const double phi = 2.0 * std::numbers::pi * static_cast<double>(spoke) / kSpokes;
    return {theta * std::cos(phi), theta * std::sin(phi)};
  }

  [[nodiscard]] NaiveImagePoint image(const std::array<double, 2>& w) const {
    return project_(naive_direction(w));
  }

  static double distance(const NaiveImagePoint& a, const NaiveImagePoint& b) {
    return std::hypot(a[0] - b[0], a[1] - b[1]);
  }

  [[nodiscard]] double miss(std::size_t ring,
                            std::size_t spoke,
                            const NaiveImagePoint& pixel) const {
    return distance(images_[ring * kSpokes + spoke], pixel);
  }

  [[nodiscard]] bool is_best_of_neighbours(std::size_t ring,
                                           std::size_t spoke,
                                           const NaiveImagePoint& pixel) const {
    const double here = miss(ring, spoke, pixel);
    return here <= miss(ring, (spoke + 1) % kSpokes, pixel) &&
           here <= miss(ring, (spoke + kSpokes - 1) % kSpokes, pixel) &&
           (ring == 0 || here <= miss(ring - 1, spoke, pixel)) &&
           (ring + 1 == kRings || here <= miss(ring + 1, spoke, pixel));
  }

  /// Newton's step at w; false where the image stands still.
  bool step_at(const std::array<double, 2>& w,
               const NaiveImagePoint& pixel,
               std::array<double, 2>& step) const {
    constexpr double kH = 1e-6;
    const NaiveImagePoint here = image(w);
    const NaiveImagePoint right = image({w[0] + kH, w[1]});
    const NaiveImagePoint left = image({w[0] - kH, w[1]});
    const NaiveImagePoint lower = image({w[0], w[1] + kH});
    const NaiveImagePoint upper = image({w[0], w[1] - kH});
    const double a = (right[0] - left[0]) / (2.0 * kH);
    const double b = (lower[0] - upper[0]) / (2.0 * kH);
    const double c = (right[1] - left[1]) / (2.0 * kH);
    const double d = (lower[1] - upper[1]) / (2.0 * kH);
    const double determinant = a * d - b * c;
    const double du = pixel[0] - here[0];
    const double dv = pixel[1] - here[1];
    step = {(d * du - b * dv) / determinant, (a * dv - c * du) / determinant};
    return std::isfinite(step[0]) && std::isfinite(step[1]);
  }

  /// Moves w to where its image is the pixel; false when it does not get there within the angle.
  bool improve(std::array<double, 2>& w, const NaiveImagePoint& pixel) const {
    double best = distance(image(w), pixel);
    const double goal = 1e-11 * (1.0 + std::hypot(pixel[0], pixel[1]));
    for (int i = 0; i < 60; ++i) {
      std::array<double, 2> step{};
      if (best == 0.0 || !step_at(w, pixel, step)) {
        break;
      }
      bool better = false;
      for (double part = 1.0; part > 1e-4 && !better; part /= 2.0) {
        const std::array<double, 2> next{w[0] + part * step[0], w[1] + part * step[1]};
        const double there = distance(image(next), pixel);
        better = std::hypot(next[0], next[1]) < std::numbers::pi && there < best;
        if (better) {
          w = next;
          best = there;
        }
      }
      if (!better) {
        break;
      }
    }
    return best <= goal && std::hypot(w[0], w[1]) <= max_angle_rad_;
  }

  static void add_new(std::vector<NaiveVector>& found, const NaiveVector& ray) {
    for (const NaiveVector& other : found) {
      if (std::hypot(ray[0] - other[0], ray[1] - other[1], ray[2] - other[2]) < 1e-6) {
        return;
      }
    }
    found.push_back(ray);
  }

  Projection project_;
  double max_angle_rad_;
  std::vector<NaiveImagePoint> images_;
};

}  // namespace skyhalo::reference

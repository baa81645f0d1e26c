#pragma once

#include <variant>

#include "skyhalo/camera/ask.hpp"
#include "skyhalo/camera/pinhole_pair.hpp"
#include "skyhalo/camera/spherical_pair.hpp"

namespace skyhalo {

/// A rectified pair of either kind. Code per pixel takes the alternatives; these functions ask once
/// per frame or cell.
using PairModel = std::variant<PinholePair, SphericalPair>;

/// The distance between the two cameras.
[[nodiscard]] inline double baseline_m(const PairModel& pair) noexcept {
  return ask(pair, [](const auto& model) { return model.baseline_m; });
}

/// Unit vector (`cam`) of the ray of right-image pixel (u, v).
[[nodiscard]] inline Eigen::Vector3d ray_of(const PairModel& pair,
                                            double u_px,
                                            double v_px) noexcept {
  return ask(pair, [&](const auto& model) { return ray_of(model, u_px, v_px); });
}

/// The point (m, `cam`) that right-image pixel (u, v) with disparity d sees; NaN where there is
/// none.
[[nodiscard]] inline Eigen::Vector3d reproject(const PairModel& pair,
                                               double u_px,
                                               double v_px,
                                               double disparity_px) noexcept {
  return ask(pair, [&](const auto& model) { return reproject(model, u_px, v_px, disparity_px); });
}

/// Right-image pixel (u, v) and disparity d of a point (m, `cam`).
[[nodiscard]] inline Eigen::Vector3d project(const PairModel& pair,
                                             const Eigen::Vector3d& point_m) noexcept {
  return ask(pair, [&](const auto& model) { return project(model, point_m); });
}

/// Size of the change of the point (m, per axis of `cam`) when d is wrong by `delta_d_px`.
[[nodiscard]] inline Eigen::Vector3d uncertainty_m(const PairModel& pair,
                                                   const Eigen::Vector3d& pixel_and_disparity_px,
                                                   double delta_d_px) noexcept {
  return ask(pair, [&](const auto& model) {
    return uncertainty_m(model, pixel_and_disparity_px, delta_d_px);
  });
}

/// Range uncertainty (m) straight ahead at range z.
[[nodiscard]] inline double delta_z_m(const PairModel& pair,
                                      double z_m,
                                      double delta_d_px) noexcept {
  return ask(pair, [&](const auto& model) { return delta_z_m(model, z_m, delta_d_px); });
}

/// The range (m) straight ahead at which the uncertainty reaches `limit_m`.
[[nodiscard]] inline double range_at_uncertainty_m(const PairModel& pair,
                                                   double limit_m,
                                                   double delta_d_px) noexcept {
  return ask(pair,
             [&](const auto& model) { return range_at_uncertainty_m(model, limit_m, delta_d_px); });
}

/// Range (m) straight ahead at disparity d.
[[nodiscard]] inline double range_at_disparity_m(const PairModel& pair,
                                                 double disparity_px) noexcept {
  return ask(pair, [&](const auto& model) { return range_at_disparity_m(model, disparity_px); });
}

/// The smallest range (m) that a search up to `max_disparity_px` can measure in an image of
/// `width_px` columns.
[[nodiscard]] inline double min_range_m(const PairModel& pair,
                                        int width_px,
                                        double max_disparity_px) noexcept {
  return ask(pair,
             [&](const auto& model) { return min_range_m(model, width_px, max_disparity_px); });
}

/// The same pair for images shrunk by a whole factor by area averaging (METHOD 1).
[[nodiscard]] inline PairModel downscaled(const PairModel& pair, int factor) noexcept {
  return ask(pair, [&](const auto& model) -> PairModel { return downscaled(model, factor); });
}

}  // namespace skyhalo

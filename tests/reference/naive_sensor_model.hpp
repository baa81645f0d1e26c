#pragma once

#include <cmath>

namespace skyhalo::reference {

/// Parameters of the inverse sensor model (thesis eq. 6.4-6.6), all without unit:
/// 0 <= k <= 1, 0 < p_free < 0.5, p_free < p_unknown < 1.
struct NaiveSensorModel {
  double k = 0.75;
  double p_unknown = 0.5;
  double p_free = 0.3;
};

/// exp(-(offset / width)^2 / 2), metres in, no unit out; 1 at offset 0, whatever the width.
inline double naive_gaussian(double offset_m, double width_m) {
  if (offset_m == 0.0) {
    return 1.0;
  }
  const double ratio = offset_m / width_m;
  return std::exp(-0.5 * ratio * ratio);
}

/// Height a of the peak above p_unknown (thesis eq. 6.5); delta_z_m is taken as a number of metres.
inline double naive_peak(const NaiveSensorModel& model, double delta_z_m) {
  return model.k * (1.0 - model.p_unknown) * std::exp(-delta_z_m);
}

/// Width c in metres of the tail beyond the measurement (thesis eq. 6.6).
inline double naive_tail_width_m(const NaiveSensorModel& model, double delta_z_m) {
  const double a = naive_peak(model, delta_z_m);
  return delta_z_m * std::sqrt(std::log1p(a / (a + 1.0 - 2.0 * model.p_free)) / std::log(2.0));
}

/// Occupancy probability of a map cell at distance m_m along the ray of a measurement at z_m with
/// range uncertainty delta_z_m >= 0, finite, all in metres (thesis eq. 6.4). Every m_m <= z_m takes
/// the first branch.
inline double naive_probability(const NaiveSensorModel& model,
                                double m_m,
                                double z_m,
                                double delta_z_m) {
  const double a = naive_peak(model, delta_z_m);
  if (m_m <= z_m) {
    return model.p_free +
           (a + model.p_unknown - model.p_free) * naive_gaussian(m_m - z_m, delta_z_m);
  }
  return model.p_unknown + a * naive_gaussian(m_m - z_m, naive_tail_width_m(model, delta_z_m));
}

/// Range uncertainty in metres of a pinhole pair at range z_m; the focal length and the disparity
/// uncertainty are in pixels of the matched image (thesis eq. 6.9).
inline double naive_pinhole_delta_z_m(double z_m,
                                      double baseline_m,
                                      double focal_px,
                                      double delta_d_px) {
  return z_m * z_m * delta_d_px / (baseline_m * focal_px);
}

/// Range uncertainty in metres of a spherical pair at range z_m > 0; delta_theta_u_rad is in
/// radians per pixel of the matched image, delta_d_px in its pixels. First the disparity that a
/// point straight ahead would have (thesis eq. 6.11), then its uncertainty (thesis eq. 6.10).
inline double naive_spherical_delta_z_m(double z_m,
                                        double baseline_m,
                                        double delta_theta_u_rad,
                                        double delta_d_px) {
  const double disparity_px = std::atan(baseline_m / z_m) / delta_theta_u_rad;
  const double tangent = std::tan(disparity_px * delta_theta_u_rad);
  return baseline_m * delta_theta_u_rad * (1.0 + 1.0 / (tangent * tangent)) * delta_d_px;
}

}  // namespace skyhalo::reference

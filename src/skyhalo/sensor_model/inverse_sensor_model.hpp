#pragma once

#include <cmath>

namespace skyhalo {

/// Settings of the inverse sensor model (thesis 6.1); the values are the thesis's.
struct SensorModelConfig {
  double k = 0.75;          ///< how much a sure measurement marks, in (0, 1)
  double p_unknown = 0.5;   ///< probability of a cell that nothing is known of, in (p_free, 1)
  double p_free = 0.3;      ///< probability that a crossing leaves in a cell, in (0, 0.5]
  double delta_d_px = 0.5;  ///< expected error of the disparity in the matched image, > 0
};

/// Throws `Error` (input) naming the key when a setting is outside its domain.
void check(const SensorModelConfig& config);

/// The inverse sensor model along one ray with measurement z (thesis eq. 6.4 to 6.6). The constants
/// of the ray are worked out once; then each map cell on it is asked by its distance m.
class InverseSensorModel {
 public:
  /// Measurement z_m > 0 with uncertainty delta_z_m > 0; settings inside their domain.
  InverseSensorModel(const SensorModelConfig& config, double z_m, double delta_z_m) noexcept;

  [[nodiscard]] double z_m() const noexcept { return z_m_; }

  /// Probability of a cell that the measurement says nothing of.
  [[nodiscard]] double p_unknown() const noexcept { return p_unknown_; }

  /// Probability that a map cell at distance m_m > 0 along the ray is occupied.
  [[nodiscard]] double probability(double m_m) const noexcept {
    if (m_m <= z_m_) {
      const double x = (m_m - z_m_) / delta_z_m_;
      return p_free_ + (a_ + p_unknown_ - p_free_) * std::exp(-0.5 * x * x);
    }
    if (!(c_m_ > 0.0)) {
      return p_unknown_;
    }
    const double x = (m_m - z_m_) / c_m_;
    return p_unknown_ + a_ * std::exp(-0.5 * x * x);
  }

  /// Distance from which a cell in front of the measurement is indistinguishable from merely
  /// crossed (six deviations; the difference is below 2e-8).
  [[nodiscard]] double free_until_m() const noexcept { return z_m_ - 6.0 * delta_z_m_; }

  /// The peak's height above p_unknown: `a` (thesis eq. 6.5).
  [[nodiscard]] double peak() const noexcept { return a_; }

  /// The width behind the measurement: `c` (thesis eq. 6.6), in m; 0 where the peak vanishes.
  [[nodiscard]] double width_behind_m() const noexcept { return c_m_; }

 private:
  double p_unknown_;
  double p_free_;
  double z_m_;
  double delta_z_m_;
  double a_;
  double c_m_;
};

}  // namespace skyhalo

#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace skyhalo {

/// A cubic Hermite curve through values at times, with the slope at each of the parabola through
/// it and its neighbours: exact for a constant acceleration.
class KnotCurve {
 public:
  /// Needs two values or more, a time (s) each, that increase.
  KnotCurve(std::vector<double> times_s, std::vector<Eigen::Vector3d> values);

  /// The value at a time (s); before the first time and after the last that of the end.
  [[nodiscard]] Eigen::Vector3d value(double t_s) const noexcept;

  /// The derivative by time (per second), at the ends' beyond them.
  [[nodiscard]] Eigen::Vector3d slope(double t_s) const noexcept;

  /// The slopes at the given times (per second).
  [[nodiscard]] const std::vector<Eigen::Vector3d>& slopes() const noexcept { return slopes_; }

 private:
  [[nodiscard]] std::size_t interval_at(double t_s) const noexcept;
  [[nodiscard]] double fraction(std::size_t i, double t_s) const noexcept;

  std::vector<double> times_s_;
  std::vector<Eigen::Vector3d> values_;
  std::vector<Eigen::Vector3d> slopes_;
};

}  // namespace skyhalo

#include "skyhalo/sim/knot_curve.hpp"

#include <algorithm>
#include <utility>

#include "skyhalo/sim/hermite.hpp"

namespace skyhalo {

KnotCurve::KnotCurve(std::vector<double> times_s, std::vector<Eigen::Vector3d> values)
    : times_s_(std::move(times_s)), values_(std::move(values)), slopes_(values_.size()) {
  const std::size_t last = values_.size() - 1;
  const auto step_s = [&](std::size_t i) { return times_s_[i + 1] - times_s_[i]; };
  const auto chord = [&](std::size_t i) -> Eigen::Vector3d {
    return (values_[i + 1] - values_[i]) / step_s(i);
  };
  for (std::size_t i = 1; i < last; ++i) {
    slopes_[i] =
        (step_s(i) * chord(i - 1) + step_s(i - 1) * chord(i)) / (step_s(i - 1) + step_s(i));
  }
  slopes_[0] = last > 1 ? Eigen::Vector3d(2.0 * chord(0) - slopes_[1]) : chord(0);
  slopes_[last] = last > 1 ? Eigen::Vector3d(2.0 * chord(last - 1) - slopes_[last - 1]) : chord(0);
}

std::size_t KnotCurve::interval_at(double t_s) const noexcept {
  const auto after = std::upper_bound(times_s_.begin() + 1, times_s_.end() - 1, t_s);
  return static_cast<std::size_t>(after - times_s_.begin()) - 1;
}

double KnotCurve::fraction(std::size_t i, double t_s) const noexcept {
  return std::clamp((t_s - times_s_[i]) / (times_s_[i + 1] - times_s_[i]), 0.0, 1.0);
}

Eigen::Vector3d KnotCurve::value(double t_s) const noexcept {
  const std::size_t i = interval_at(t_s);
  return hermite_value({.value_0 = values_[i],
                        .slope_0 = slopes_[i],
                        .value_1 = values_[i + 1],
                        .slope_1 = slopes_[i + 1],
                        .interval_s = times_s_[i + 1] - times_s_[i]},
                       fraction(i, t_s));
}

Eigen::Vector3d KnotCurve::slope(double t_s) const noexcept {
  const std::size_t i = interval_at(t_s);
  return hermite_slope({.value_0 = values_[i],
                        .slope_0 = slopes_[i],
                        .value_1 = values_[i + 1],
                        .slope_1 = slopes_[i + 1],
                        .interval_s = times_s_[i + 1] - times_s_[i]},
                       fraction(i, t_s));
}

}  // namespace skyhalo

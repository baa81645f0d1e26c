#include "skyhalo/sim/speed_profile.hpp"

#include <algorithm>
#include <cmath>

namespace skyhalo {
namespace {

/// Turning back at the speed that the limit reaches in this time (s) is next to a stop.
constexpr double kCornerSeconds = 0.001;

/// The square of the greatest speed at the other end of an interval with the acceleration that the
/// bend leaves (m^2/s^2).
double reach(double square, double length_m, double curvature_per_m, double acceleration_mps2) {
  const double lateral = std::min(square * curvature_per_m, acceleration_mps2);
  const double along = std::sqrt((acceleration_mps2 - lateral) * (acceleration_mps2 + lateral));
  return square + 2.0 * length_m * along;
}

}  // namespace

std::vector<double> fastest_speeds(const FlightPath& path, const FlightLimits& limits) {
  const std::size_t count = path.points_m.size();
  const double corner_mps = kCornerSeconds * limits.acceleration_mps2;
  const double fastest = limits.speed_mps * limits.speed_mps;
  std::vector<double> squares(count, 0.0);
  for (std::size_t i = 1; i + 1 < count; ++i) {
    const double bend = path.curvatures_per_m[i] * fastest;
    squares[i] = bend > limits.acceleration_mps2
                     ? limits.acceleration_mps2 / path.curvatures_per_m[i]
                     : fastest;
    if (path.is_corner(i)) {
      squares[i] = corner_mps * corner_mps;
    }
  }
  const auto limit = [&](std::size_t from, std::size_t to) {
    const std::size_t interval = std::min(from, to);
    const double bend = std::max(path.curvatures_per_m[from], path.curvatures_per_m[to]);
    const double greatest =
        reach(squares[from], path.lengths_m[interval], bend, limits.acceleration_mps2);
    squares[to] = std::min(squares[to], greatest);
  };
  for (std::size_t i = 0; i + 1 < count; ++i) {
    limit(i, i + 1);
  }
  for (std::size_t i = count - 1; i > 0; --i) {
    limit(i, i - 1);
  }
  for (double& square : squares) {
    square = std::sqrt(square);
  }
  return squares;
}

std::vector<double> times_at(const FlightPath& path, const std::vector<double>& speeds_mps) {
  std::vector<double> times_s = {0.0};
  times_s.reserve(speeds_mps.size());
  for (std::size_t i = 0; i < path.lengths_m.size(); ++i) {
    times_s.push_back(times_s.back() +
                      2.0 * path.lengths_m[i] / (speeds_mps[i] + speeds_mps[i + 1]));
  }
  return times_s;
}

}  // namespace skyhalo

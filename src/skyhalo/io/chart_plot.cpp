#include "skyhalo/io/chart_plot.hpp"

#include <algorithm>
#include <cmath>

namespace skyhalo {

bool is_drawable(const ChartRange& range) noexcept {
  const double largest = std::max(std::abs(range.first), std::abs(range.last));
  const double span = range.last - range.first;
  return std::isfinite(largest) && std::isfinite(span) && span > 1e-9 * largest;
}

double nice_step(double span, int most) noexcept {
  const double power = std::pow(10.0, std::floor(std::log10(span / most)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (span / (factor * power) <= most + 1e-9) {
      return factor * power;
    }
  }
  return 10.0 * power;
}

std::vector<double> nice_ticks(const ChartRange& range, int most) {
  std::vector<double> ticks;
  if (most < 1 || !is_drawable(range)) {
    return ticks;
  }
  const double step = nice_step(range.last - range.first, most);
  const double first = std::ceil(range.first / step - 1e-9);
  const int count = static_cast<int>(std::floor(range.last / step + 1e-9) - first) + 1;
  for (int i = 0; i < count; ++i) {
    ticks.push_back((first + i) * step);
  }
  return ticks;
}

std::optional<ChartSegment> clipped(const ChartSegment& segment, const ChartPlot& plot) noexcept {
  const Eigen::Vector2d low(plot.left(), plot.top());
  const Eigen::Vector2d high(plot.right(), plot.bottom());
  const Eigen::Vector2d way = segment.second - segment.first;
  double enter = 0.0;
  double leave = 1.0;
  for (int axis = 0; axis < 2; ++axis) {
    const double to_low = low[axis] - segment.first[axis];
    const double to_high = high[axis] - segment.first[axis];
    if (way[axis] == 0.0) {
      if (to_low > 0.0 || to_high < 0.0) {
        return std::nullopt;
      }
      continue;
    }
    enter = std::max(enter, std::min(to_low / way[axis], to_high / way[axis]));
    leave = std::min(leave, std::max(to_low / way[axis], to_high / way[axis]));
  }
  if (enter > leave) {
    return std::nullopt;
  }
  return ChartSegment(segment.first + enter * way, segment.first + leave * way);
}

}  // namespace skyhalo

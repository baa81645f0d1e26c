#pragma once

#include <Eigen/Core>
#include <optional>
#include <utility>
#include <vector>

namespace skyhalo {

/// The part of an axis that is shown.
struct ChartRange {
  double first = 0.0;
  double last = 1.0;
};

/// Whether it can be drawn: first < last, both finite, and farther apart than rounding.
[[nodiscard]] bool is_drawable(const ChartRange& range) noexcept;

/// The smallest of 1, 2 or 5 times a power of ten that covers `span` > 0 in at most `most` > 0
/// steps.
[[nodiscard]] double nice_step(double span, int most) noexcept;

/// The multiples of `nice_step` in the range. Empty unless it is drawable and `most` is above 0.
[[nodiscard]] std::vector<double> nice_ticks(const ChartRange& range, int most);

/// Where the values of an axis lie on the paper.
struct ChartAxis {
  ChartRange range;        ///< drawable
  double first_px = 0.0;   ///< of the range's first value
  double last_px = 100.0;  ///< of its last

  [[nodiscard]] double at(double value) const noexcept {
    return first_px + (value - range.first) / (range.last - range.first) * (last_px - first_px);
  }
};

/// The area of a chart that holds its lines; y on the paper points down.
struct ChartPlot {
  ChartAxis x;  ///< first_px <= last_px
  ChartAxis y;  ///< last_px <= first_px

  [[nodiscard]] double left() const noexcept { return x.first_px; }

  [[nodiscard]] double right() const noexcept { return x.last_px; }

  [[nodiscard]] double top() const noexcept { return y.last_px; }

  [[nodiscard]] double bottom() const noexcept { return y.first_px; }
};

/// From one point of the paper to another.
using ChartSegment = std::pair<Eigen::Vector2d, Eigen::Vector2d>;

/// The part of a segment (finite) that lies in the plot, edges included (Liang and Barsky 1984).
[[nodiscard]] std::optional<ChartSegment> clipped(const ChartSegment& segment,
                                                  const ChartPlot& plot) noexcept;

}  // namespace skyhalo

#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "skyhalo/io/chart_plot.hpp"

namespace skyhalo {

/// One line of a chart.
struct ChartSeries {
  std::string label{};                    ///< in the legend; empty: no entry
  std::vector<Eigen::Vector2d> points{};  ///< (x, y) in the units of the axes; NaN breaks the line
  bool reference = false;                 ///< a thin grey line to compare with, not data
};

/// A line chart. Without a range (or with one that is empty or not finite) an axis shows all
/// points. Text is UTF-8; control characters become blanks.
struct LineChart {
  std::string title{};
  std::string x_label{};  ///< with the unit
  std::string y_label{};  ///< with the unit
  std::optional<ChartRange> x_range{};
  std::optional<ChartRange> y_range{};
  std::vector<ChartSeries> series{};
};

/// The panels side by side as one SVG document on white. The lines end at the edges of their plot;
/// colour-blind eyes and print tell them apart by Okabe and Ito's colours and by their dashes. The
/// same charts give the same bytes, whatever the locale, and no font or file from outside is
/// needed.
[[nodiscard]] std::string svg_of(std::span<const LineChart> panels);

}  // namespace skyhalo

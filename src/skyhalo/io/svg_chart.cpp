#include "skyhalo/io/svg_chart.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <string_view>
#include <utility>

namespace skyhalo {
namespace {

// All lengths in pixels of the picture.
constexpr double kPanelWidth = 640.0;
constexpr double kPanelHeight = 420.0;
constexpr double kLeft = 76.0;
constexpr double kTop = 48.0;
constexpr double kBottom = 64.0;
constexpr double kRight = 24.0;
constexpr double kLegendSwatch = 34.0;
constexpr double kLegendGap = 10.0;
constexpr double kLegendTextGap = 6.0;
constexpr double kLegendPitch = 22.0;
constexpr double kLetterWidth = 7.4;  // a generous mean at the font's size
constexpr int kMostTicks = 8;

// Okabe and Ito's colours that stand out on white.
constexpr std::array<std::string_view, 7> kColours{
    "#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#000000"};
constexpr std::array<std::string_view, 5> kDashes{"none", "9 4", "3 4", "12 4 3 4", "16 5"};

using Line = std::vector<Eigen::Vector2d>;

std::string fixed(double value, int decimals) {
  std::array<char, 400> text{};
  const auto [end, status] = std::to_chars(
      text.data(), text.data() + text.size(), value, std::chars_format::fixed, decimals);
  std::string result(text.data(), end);
  const bool zero = result.find_first_not_of("-0.") == std::string::npos;
  return zero && result.starts_with('-') ? result.substr(1) : result;
}

std::string px(double value) {
  return fixed(value, 2);
}

std::string escaped(std::string_view text) {
  std::string result;
  for (const char letter : text) {
    switch (letter) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '"':
        result += "&quot;";
        break;
      default:
        result += static_cast<unsigned char>(letter) < 0x20 ? ' ' : letter;
    }
  }
  return result;
}

/// Letters of UTF-8 text: the bytes that begin one.
std::size_t letters(std::string_view text) {
  return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char byte) {
    return (static_cast<unsigned char>(byte) & 0xC0U) != 0x80U;
  }));
}

std::string tick_label(double value, double step) {
  if (step >= 1e-4 && step < 1e6) {
    return fixed(value, std::max(0, static_cast<int>(std::ceil(-std::log10(step) - 1e-9))));
  }
  std::array<char, 64> text{};
  const auto [end, status] =
      std::to_chars(text.data(), text.data() + text.size(), value, std::chars_format::general, 4);
  return {text.data(), end};
}

/// All points along one axis (0: x, 1: y), widened to whole steps.
ChartRange range_of(const LineChart& chart, int axis) {
  double first = std::numeric_limits<double>::infinity();
  double last = -first;
  for (const ChartSeries& series : chart.series) {
    for (const Eigen::Vector2d& point : series.points) {
      if (point.allFinite()) {
        first = std::min(first, point[axis]);
        last = std::max(last, point[axis]);
      }
    }
  }
  if (!is_drawable({first, last})) {
    // Nothing, or all the same.
    const double middle = std::isfinite(first) && std::abs(first) < 1e100 ? first : 0.0;
    const double half = std::max(0.5, 0.5 * std::abs(middle));
    return {middle - half, middle + half};
  }
  const double step = nice_step(last - first, kMostTicks);
  return {std::floor(first / step + 1e-9) * step, std::ceil(last / step - 1e-9) * step};
}

ChartRange shown(const std::optional<ChartRange>& wanted, const LineChart& chart, int axis) {
  return wanted && is_drawable(*wanted) ? *wanted : range_of(chart, axis);
}

/// The series on the paper, cut at points without a value. A point alone becomes a dash, so that it
/// is seen.
std::vector<Line> lines_of(const ChartSeries& series, const ChartPlot& plot) {
  std::vector<Line> lines(1);
  for (const Eigen::Vector2d& point : series.points) {
    const Eigen::Vector2d on_paper(plot.x.at(point.x()), plot.y.at(point.y()));
    if (on_paper.allFinite()) {
      lines.back().push_back(on_paper);
    } else if (!lines.back().empty()) {
      lines.emplace_back();
    }
  }
  for (Line& line : lines) {
    if (line.size() == 1) {
      const Eigen::Vector2d half_dash(1.5, 0.0);
      line = {line.front() - half_dash, line.front() + half_dash};
    }
  }
  return lines;
}

std::string path_of(const ChartSeries& series, const ChartPlot& plot) {
  std::string path;
  std::string pen;
  for (const Line& line : lines_of(series, plot)) {
    for (std::size_t i = 1; i < line.size(); ++i) {
      const std::optional<ChartSegment> part = clipped({line[i - 1], line[i]}, plot);
      if (!part) {
        continue;
      }
      const std::string from = px(part->first.x()) + " " + px(part->first.y());
      const std::string to = px(part->second.x()) + " " + px(part->second.y());
      const bool lifted = from != pen;
      path += lifted ? "M" + from : "";
      path += lifted || to != from ? "L" + to : "";
      pen = to;
    }
    pen.clear();
  }
  return path;
}

/// How the line of number `index` is drawn; a reference does not count.
std::string stroke(const ChartSeries& series, std::size_t index) {
  if (series.reference) {
    return R"(stroke="#767676" stroke-width="1.4" stroke-dasharray="2 4")";
  }
  return "stroke=\"" + std::string(kColours[index % kColours.size()]) +
         R"(" stroke-width="2.4" stroke-dasharray=")" +
         std::string(kDashes[index % kDashes.size()]) + "\"";
}

std::string text_at(const Eigen::Vector2d& at, std::string_view more, std::string_view text) {
  return "<text x=\"" + px(at.x()) + "\" y=\"" + px(at.y()) + "\" " + std::string(more) + ">" +
         escaped(text) + "</text>\n";
}

std::string line_at(const Eigen::Vector2d& from, const Eigen::Vector2d& to, std::string_view more) {
  return "<path d=\"M" + px(from.x()) + " " + px(from.y()) + "L" + px(to.x()) + " " + px(to.y()) +
         "\" " + std::string(more) + "/>\n";
}

/// Width of the room for the legend; 0 without one.
double legend_width(const LineChart& chart) {
  std::size_t longest = 0;
  for (const ChartSeries& series : chart.series) {
    longest = std::max(longest, letters(series.label));
  }
  const double wanted = 2.0 * kLegendGap + kLegendSwatch + kLegendTextGap +
                        kLetterWidth * static_cast<double>(longest);
  return longest == 0 ? 0.0 : std::min(wanted, 0.4 * kPanelWidth);
}

std::string grid_svg(const ChartPlot& plot) {
  constexpr std::string_view kGrid = R"(stroke="#e2e2e2" fill="none")";
  std::string svg;
  const std::vector<double> xs = nice_ticks(plot.x.range, kMostTicks);
  const double x_step = nice_step(plot.x.range.last - plot.x.range.first, kMostTicks);
  for (const double value : xs) {
    const double x = plot.x.at(value);
    svg += line_at({x, plot.top()}, {x, plot.bottom()}, kGrid);
    svg += text_at({x, plot.bottom() + 19.0}, "text-anchor=\"middle\"", tick_label(value, x_step));
  }
  const std::vector<double> ys = nice_ticks(plot.y.range, kMostTicks);
  const double y_step = nice_step(plot.y.range.last - plot.y.range.first, kMostTicks);
  for (const double value : ys) {
    const double y = plot.y.at(value);
    svg += line_at({plot.left(), y}, {plot.right(), y}, kGrid);
    svg += text_at({plot.left() - 8.0, y + 5.0}, "text-anchor=\"end\"", tick_label(value, y_step));
  }
  return svg + "<rect x=\"" + px(plot.left()) + "\" y=\"" + px(plot.top()) + "\" width=\"" +
         px(plot.right() - plot.left()) + "\" height=\"" + px(plot.bottom() - plot.top()) +
         "\" fill=\"none\" stroke=\"#767676\"/>\n";
}

std::string labels_svg(const LineChart& chart, const ChartPlot& plot) {
  const double middle_x = 0.5 * (plot.left() + plot.right());
  const double middle_y = 0.5 * (plot.top() + plot.bottom());
  return text_at({plot.left(), 28.0}, "font-size=\"16\" font-weight=\"bold\"", chart.title) +
         text_at({middle_x, plot.bottom() + 46.0}, "text-anchor=\"middle\"", chart.x_label) +
         text_at({20.0, middle_y},
                 "text-anchor=\"middle\" transform=\"rotate(-90 20 " + px(middle_y) + ")\"",
                 chart.y_label);
}

/// The lines, and beside the plot the legend as far as there is room.
std::string series_svg(const LineChart& chart, const ChartPlot& plot) {
  const auto entries = static_cast<std::size_t>(
      std::count_if(chart.series.begin(), chart.series.end(), [](const ChartSeries& series) {
        return !series.label.empty();
      }));
  const auto room = static_cast<std::size_t>((plot.bottom() - plot.top()) / kLegendPitch);
  const std::size_t listed = entries > room ? room - 1 : entries;
  const double swatch_x = plot.right() + kLegendGap;
  const double text_x = swatch_x + kLegendSwatch + kLegendTextGap;
  std::string lines = "<g fill=\"none\" stroke-linejoin=\"round\">\n";
  std::string legend;
  std::size_t data = 0;
  std::size_t entry = 0;
  for (const ChartSeries& series : chart.series) {
    const std::string look = stroke(series, data);
    data += series.reference ? 0 : 1;
    const std::string path = path_of(series, plot);
    if (!path.empty()) {
      lines.append("<path ").append(look).append(" d=\"").append(path).append("\"/>\n");
    }
    const double y = plot.top() + 12.0 + kLegendPitch * static_cast<double>(entry);
    if (!series.label.empty() && entry++ < listed) {
      legend += line_at({swatch_x, y}, {swatch_x + kLegendSwatch, y}, "fill=\"none\" " + look);
      legend += text_at({text_x, y + 5.0}, "", series.label);
    }
  }
  if (listed < entries) {
    const double y = plot.top() + 17.0 + kLegendPitch * static_cast<double>(listed);
    legend += text_at({text_x, y}, "", "and " + std::to_string(entries - listed) + " more");
  }
  return lines + "</g>\n" + legend;
}

std::string panel_svg(const LineChart& chart, std::size_t index) {
  const double right_px = kPanelWidth - std::max(kRight, legend_width(chart));
  const ChartPlot plot{{shown(chart.x_range, chart, 0), kLeft, right_px},
                       {shown(chart.y_range, chart, 1), kPanelHeight - kBottom, kTop}};
  return "<g transform=\"translate(" + px(static_cast<double>(index) * kPanelWidth) + " 0)\">\n" +
         grid_svg(plot) + series_svg(chart, plot) + labels_svg(chart, plot) + "</g>\n";
}

}  // namespace

std::string svg_of(std::span<const LineChart> panels) {
  const auto count = static_cast<double>(std::max<std::size_t>(1, panels.size()));
  const std::string width = fixed(count * kPanelWidth, 0);
  const std::string height = fixed(kPanelHeight, 0);
  std::string svg = R"(<svg xmlns="http://www.w3.org/2000/svg" width=")" + width + "\" height=\"" +
                    height + "\" viewBox=\"0 0 " + width + " " + height +
                    R"(" role="img" font-family="sans-serif" font-size="14" fill="#222222">)" +
                    "\n<rect width=\"" + width + "\" height=\"" + height +
                    "\" fill=\"#ffffff\"/>\n";
  for (std::size_t i = 0; i < panels.size(); ++i) {
    svg += panel_svg(panels[i], i);
  }
  return svg + "</svg>\n";
}

}  // namespace skyhalo

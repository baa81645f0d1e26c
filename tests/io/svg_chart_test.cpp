#include "skyhalo/io/svg_chart.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <regex>

#include "support/xml.hpp"

namespace skyhalo {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::SizeIs;
using testing::xml_fault;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();

/// One line without a label over 0...10 by 0...1. The plot is then 540 x 308 px at (76, 48): x = 0
/// lies at 76 and x = 10 at 616, y = 0 at 356 and y = 1 at 48.
LineChart chart_of(std::vector<Eigen::Vector2d> points) {
  return {.title = "title",
          .x_label = "x (m)",
          .y_label = "y (m)",
          .x_range = ChartRange{0.0, 10.0},
          .y_range = ChartRange{0.0, 1.0},
          .series = {{.points = std::move(points)}}};
}

std::string svg_of_one(const LineChart& chart) {
  return svg_of({&chart, 1});
}

/// The paths of the data.
std::vector<std::string> paths_of(const std::string& svg) {
  const std::string from = svg.substr(svg.find("<g fill=\"none\""));
  const std::string lines = from.substr(0, from.find("</g>"));
  const std::regex path(" d=\"([^\"]*)\"");
  std::vector<std::string> paths;
  for (std::sregex_iterator it(lines.begin(), lines.end(), path), end; it != end; ++it) {
    paths.push_back((*it)[1]);
  }
  return paths;
}

TEST(SvgChartTest, ALineIsDrawnInThePlotsPixels) {
  const std::string svg = svg_of_one(chart_of({{0.0, 0.0}, {5.0, 1.0}, {10.0, 0.5}}));
  EXPECT_EQ(xml_fault(svg), "");
  EXPECT_THAT(paths_of(svg), ElementsAre("M76.00 356.00L346.00 48.00L616.00 202.00"));
}

TEST(SvgChartTest, TitleAndAxesAreWritten) {
  const std::string svg = svg_of_one(chart_of({{0.0, 0.0}, {1.0, 1.0}}));
  EXPECT_THAT(svg, AllOf(HasSubstr(">title</text>"), HasSubstr(">x (m)</text>")));
  EXPECT_THAT(svg, AllOf(HasSubstr(">y (m)</text>"), HasSubstr("fill=\"#ffffff\"")));
  // Eight steps at most: 2 over 10 and 0.2 over 1.
  EXPECT_THAT(svg, AllOf(HasSubstr(">8</text>"), HasSubstr(">10</text>"), Not(HasSubstr(">9<"))));
  EXPECT_THAT(svg, AllOf(HasSubstr(">0.2</text>"), HasSubstr(">1.0</text>")));
}

TEST(SvgChartTest, TextIsEscaped) {
  LineChart chart = chart_of({{0.0, 0.0}, {1.0, 1.0}});
  chart.title = "a < b & \"c\" > d";
  chart.x_label = "tab\there, bell\a";
  chart.series[0].label = "<Δz>";
  const std::string svg = svg_of_one(chart);
  EXPECT_EQ(xml_fault(svg), "");
  EXPECT_THAT(svg, HasSubstr(">a &lt; b &amp; &quot;c&quot; &gt; d</text>"));
  EXPECT_THAT(svg, HasSubstr(">tab here, bell </text>"));
  EXPECT_THAT(svg, HasSubstr(">&lt;Δz&gt;</text>"));
}

TEST(SvgChartTest, APointWithoutAValueBreaksTheLine) {
  const std::string svg =
      svg_of_one(chart_of({{0.0, 0.0}, {1.0, 0.0}, {2.0, kNan}, {3.0, 0.0}, {4.0, 0.0}}));
  EXPECT_THAT(paths_of(svg),
              ElementsAre("M76.00 356.00L130.00 356.00M238.00 356.00L292.00 356.00"));
  EXPECT_THAT(svg, Not(HasSubstr("nan")));
}

TEST(SvgChartTest, InfiniteAndUndrawablyLargeValuesBreakTheLineToo) {
  for (const double value : {kInf, -kInf}) {
    const std::string svg = svg_of_one(chart_of({{0.0, 0.0}, {1.0, 0.0}, {2.0, value}}));
    EXPECT_THAT(paths_of(svg), ElementsAre("M76.00 356.00L130.00 356.00"));
  }
  const std::string svg = svg_of_one(chart_of({{0.0, 0.0}, {1e308, 0.5}, {1.0, 1e308}}));
  EXPECT_THAT(svg, AllOf(Not(HasSubstr("nan")), Not(HasSubstr("inf"))));
}

TEST(SvgChartTest, APointAloneIsSeen) {
  EXPECT_THAT(paths_of(svg_of_one(chart_of({{5.0, 0.5}}))),
              ElementsAre("M344.50 202.00L347.50 202.00"));
}

TEST(SvgChartTest, LinesEndAtTheEdgesOfThePlot) {
  // From (-5, -0.5) to (5, 1.5): y = 0 at x = -2.5, x = 0 at y = 0.5, y = 1 at x = 2.5.
  EXPECT_THAT(paths_of(svg_of_one(chart_of({{-5.0, -0.5}, {5.0, 1.5}}))),
              ElementsAre("M76.00 202.00L211.00 48.00"));
  EXPECT_THAT(paths_of(svg_of_one(chart_of({{0.0, 2.0}, {10.0, 3.0}}))), IsEmpty());
}

TEST(SvgChartTest, ALineThatComesBackStartsAnew) {
  EXPECT_THAT(paths_of(svg_of_one(chart_of({{0.0, 0.0}, {0.0, 2.0}, {10.0, 2.0}, {10.0, 0.0}}))),
              ElementsAre("M76.00 356.00L76.00 48.00M616.00 48.00L616.00 356.00"));
}

TEST(SvgChartTest, WithoutSeriesTheAxesRemain) {
  for (const LineChart& chart : {LineChart{}, chart_of({}), chart_of({{kNan, kNan}})}) {
    EXPECT_EQ(xml_fault(svg_of_one(chart)), "");
    EXPECT_THAT(paths_of(svg_of_one(chart)), IsEmpty());
    EXPECT_THAT(svg_of_one(chart), HasSubstr(">0.0</text>"));
  }
}

TEST(SvgChartTest, NoPanelsAreAnEmptyPicture) {
  EXPECT_EQ(xml_fault(svg_of({})), "");
}

TEST(SvgChartTest, AConstantSeriesRunsThroughTheMiddle) {
  for (const double value : {0.0, 3.0, -7e5, 1e-9}) {
    LineChart chart = chart_of({{0.0, value}, {10.0, value}});
    chart.y_range.reset();
    EXPECT_THAT(paths_of(svg_of_one(chart)), ElementsAre("M76.00 202.00L616.00 202.00")) << value;
  }
}

TEST(SvgChartTest, WithoutRangesAllPointsAreShownBetweenWholeSteps) {
  LineChart chart = chart_of({{0.7, 12.0}, {7.3, 38.0}});
  chart.x_range.reset();
  chart.y_range.reset();
  // x: steps of 1, 0 to 8; y: steps of 5, 10 to 40.
  const std::string svg = svg_of_one(chart);
  EXPECT_THAT(svg, AllOf(HasSubstr(">8</text>"), HasSubstr(">10</text>"), HasSubstr(">40</text>")));
  EXPECT_THAT(paths_of(svg), ElementsAre("M123.25 335.47L568.75 68.53"));
}

TEST(SvgChartTest, ARangeThatCannotBeDrawnIsReplaced) {
  for (const ChartRange bad : {ChartRange{1.0, 1.0}, {2.0, 1.0}, {kNan, 1.0}, {0.0, kInf}}) {
    LineChart chart = chart_of({{0.0, 0.0}, {10.0, 1.0}});
    chart.y_range = bad;
    EXPECT_THAT(paths_of(svg_of_one(chart)), ElementsAre("M76.00 356.00L616.00 48.00"));
  }
}

TEST(SvgChartTest, SeriesDifferInColourAndDashes) {
  LineChart chart = chart_of({});
  chart.series.clear();
  for (int i = 0; i < 8; ++i) {
    chart.series.push_back({std::to_string(i), {{0.0, 0.1 * i}, {10.0, 0.1 * i}}});
  }
  const std::string svg = svg_of_one(chart);
  const std::regex look(R"(<path (stroke="[^"]*" stroke-width="2.4"[^>]*) d=)");
  std::vector<std::string> looks;
  for (std::sregex_iterator it(svg.begin(), svg.end(), look), end; it != end; ++it) {
    looks.push_back((*it)[1]);
  }
  EXPECT_THAT(looks, SizeIs(8));
  std::sort(looks.begin(), looks.end());
  EXPECT_EQ(std::adjacent_find(looks.begin(), looks.end()), looks.end());
}

TEST(SvgChartTest, AReferenceTakesNoColourFromTheData) {
  LineChart chart = chart_of({{0.0, 0.0}, {10.0, 1.0}});
  chart.series.insert(chart.series.begin(), {"limit", {{0.0, 0.5}, {10.0, 0.5}}, true});
  const std::string svg = svg_of_one(chart);
  EXPECT_THAT(paths_of(svg), SizeIs(2));
  EXPECT_THAT(svg, AllOf(HasSubstr("#0072b2"), Not(HasSubstr("#d55e00")), HasSubstr(">limit<")));
}

TEST(SvgChartTest, ALegendThatDoesNotFitSaysHowManyAreLeftOut) {
  LineChart chart = chart_of({});
  chart.series.assign(30, {.label = "line"});
  // 308 px hold 14 entries of 22 px: 13 and the note.
  const std::string svg = svg_of_one(chart);
  EXPECT_EQ(xml_fault(svg), "");
  EXPECT_THAT(svg, HasSubstr(">and 17 more</text>"));
  chart.series.resize(14);
  EXPECT_THAT(svg_of_one(chart), Not(HasSubstr("more</text>")));
}

TEST(SvgChartTest, PanelsStandSideBySide) {
  const std::array panels{chart_of({{0.0, 0.0}, {1.0, 1.0}}), chart_of({})};
  const std::string svg = svg_of(panels);
  EXPECT_EQ(xml_fault(svg), "");
  EXPECT_THAT(svg, HasSubstr("viewBox=\"0 0 1280 420\""));
  EXPECT_THAT(svg, HasSubstr("translate(640.00 0)"));
}

TEST(SvgChartProperty, AnyPointsGiveXmlWithoutOddNumbers) {
  std::mt19937 random(83);
  std::uniform_real_distribution<double> mantissa(-1.0, 1.0);
  std::uniform_int_distribution<int> exponent(-320, 308);
  std::uniform_int_distribution<int> kind(0, 9);
  const auto value = [&] {
    const int k = kind(random);
    return k == 0 ? kNan : k == 1 ? kInf : mantissa(random) * std::pow(10.0, exponent(random));
  };
  for (int round = 0; round < 500; ++round) {
    LineChart chart{.title = "any"};
    for (int i = 0; i < 3; ++i) {
      ChartSeries series{.label = "s"};
      for (int j = 0; j < 5; ++j) {
        series.points.emplace_back(value(), value());
      }
      chart.series.push_back(series);
    }
    const std::string svg = svg_of_one(chart);
    ASSERT_EQ(xml_fault(svg), "");
    ASSERT_THAT(svg, AllOf(Not(HasSubstr("nan")), Not(HasSubstr("inf"))));
    ASSERT_EQ(svg, svg_of_one(chart));
  }
}

// --- the check itself ---

TEST(SvgChartTest, TheXmlCheckSeesFaults) {
  EXPECT_EQ(xml_fault("<a b=\"c &amp; d\"><e/>text</a>\n"), "");
  for (const char* bad : {"",
                          "text",
                          "<a>",
                          "<a></b>",
                          "<a/><b/>",
                          "<a b=c/>",
                          "<a b=\"1\" b=\"2\"/>",
                          "<a b=\"<\"/>",
                          "<a>&nbsp;</a>",
                          "<a>\x01</a>",
                          "<a"}) {
    EXPECT_NE(xml_fault(bad), "") << bad;
  }
}

}  // namespace
}  // namespace skyhalo

#include "skyhalo/io/chart_plot.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace skyhalo {
namespace {

using ::testing::DoubleNear;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::Pointwise;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();

/// 100 by 50 pixels at (10, 20) of the paper.
ChartPlot small_plot() {
  return {{{0.0, 10.0}, 10.0, 110.0}, {{-1.0, 1.0}, 70.0, 20.0}};
}

TEST(ChartPlotTest, TicksAreMultiplesOfOneTwoOrFive) {
  EXPECT_THAT(nice_ticks({0.0, 10.0}, 10), ElementsAre(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10));
  EXPECT_THAT(nice_ticks({0.0, 10.0}, 9), ElementsAre(0, 2, 4, 6, 8, 10));
  EXPECT_THAT(nice_ticks({0.0, 10.0}, 4), ElementsAre(0, 5, 10));
  EXPECT_THAT(nice_ticks({0.0, 10.0}, 1), ElementsAre(0, 10));
}

TEST(ChartPlotTest, TicksLieInsideTheRange) {
  EXPECT_THAT(nice_ticks({1.0, 12.3}, 8), ElementsAre(2, 4, 6, 8, 10, 12));
  EXPECT_THAT(nice_ticks({-3.5, 3.5}, 8), ElementsAre(-3, -2, -1, 0, 1, 2, 3));
}

TEST(ChartPlotTest, BoundsThatAreTicksAreAmongThemInSpiteOfRounding) {
  EXPECT_THAT(nice_ticks({0.1, 0.7}, 6),
              Pointwise(DoubleNear(1e-12), {0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7}));
}

TEST(ChartPlotTest, NothingToDrawHasNoTicks) {
  for (const ChartRange range :
       {ChartRange{1.0, 1.0}, {2.0, 1.0}, {kNan, 1.0}, {0.0, kInf}, {-1e308, 1e308}, {1e9, 1e9}}) {
    EXPECT_FALSE(is_drawable(range)) << range.first << " " << range.last;
    EXPECT_THAT(nice_ticks(range, 5), IsEmpty());
  }
  EXPECT_THAT(nice_ticks({0.0, 1.0}, 0), IsEmpty());
}

TEST(ChartPlotTest, ARangeBelowRoundingIsNotDrawable) {
  EXPECT_FALSE(is_drawable({1e9, std::nextafter(1e9, kInf)}));
  EXPECT_TRUE(is_drawable({0.0, 1e-12}));
}

TEST(ChartPlotTest, AnAxisIsLinear) {
  const ChartPlot plot = small_plot();
  EXPECT_EQ(plot.x.at(0.0), 10.0);
  EXPECT_EQ(plot.x.at(2.5), 35.0);
  EXPECT_EQ(plot.x.at(20.0), 210.0);
  EXPECT_EQ(plot.y.at(1.0), 20.0);
  EXPECT_EQ(plot.y.at(0.0), 45.0);
}

TEST(ChartPlotTest, ASegmentInsideStays) {
  const auto part = clipped({{20.0, 30.0}, {60.0, 50.0}}, small_plot());
  ASSERT_TRUE(part);
  EXPECT_EQ(part->first, Eigen::Vector2d(20.0, 30.0));
  EXPECT_EQ(part->second, Eigen::Vector2d(60.0, 50.0));
}

TEST(ChartPlotTest, ASegmentThroughIsCutAtBothEdges) {
  // y = x / 2 + 20 from x = -30 to 150: enters at x = 10 (y 25), leaves at y = 70 (x 100).
  const auto part = clipped({{-30.0, 5.0}, {150.0, 95.0}}, small_plot());
  ASSERT_TRUE(part);
  EXPECT_TRUE(part->first.isApprox(Eigen::Vector2d(10.0, 25.0)));
  EXPECT_TRUE(part->second.isApprox(Eigen::Vector2d(100.0, 70.0)));
}

TEST(ChartPlotTest, ASegmentOutsideIsGone) {
  EXPECT_FALSE(clipped({{0.0, 30.0}, {0.0, 60.0}}, small_plot()));    // left of it, upright
  EXPECT_FALSE(clipped({{20.0, 80.0}, {60.0, 90.0}}, small_plot()));  // below
  EXPECT_FALSE(clipped({{0.0, 25.0}, {25.0, 0.0}}, small_plot()));    // past the corner
}

TEST(ChartPlotTest, ASegmentOnTheEdgeStays) {
  EXPECT_TRUE(clipped({{10.0, 70.0}, {110.0, 70.0}}, small_plot()));
}

TEST(ChartPlotProperty, TicksAreEvenInsideAndNotTooMany) {
  std::mt19937 random(81);
  std::uniform_real_distribution<double> mantissa(-1.0, 1.0);
  std::uniform_int_distribution<int> exponent(-20, 20);
  for (int round = 0; round < 2000; ++round) {
    const double scale = std::pow(10.0, exponent(random));
    const double a = scale * mantissa(random);
    const double b = scale * mantissa(random);
    const ChartRange range{std::min(a, b), std::max(a, b)};
    if (!is_drawable(range)) {
      continue;
    }
    const double slack = 1e-8 * scale;
    const std::vector<double> ticks = nice_ticks(range, 8);
    ASSERT_GE(ticks.size(), 2U);
    ASSERT_LE(ticks.size(), 9U);
    EXPECT_GE(ticks.front(), range.first - slack);
    EXPECT_LE(ticks.back(), range.last + slack);
    for (std::size_t i = 2; i < ticks.size(); ++i) {
      EXPECT_NEAR(ticks[i] - ticks[i - 1], ticks[1] - ticks[0], slack);
    }
  }
}

TEST(ChartPlotProperty, WhatIsKeptLiesOnTheSegmentAndInThePlot) {
  std::mt19937 random(82);
  std::uniform_real_distribution<double> place(-200.0, 300.0);
  const ChartPlot plot = small_plot();
  int kept = 0;
  for (int round = 0; round < 5000; ++round) {
    const ChartSegment segment{{place(random), place(random)}, {place(random), place(random)}};
    const auto part = clipped(segment, plot);
    if (!part) {
      continue;
    }
    ++kept;
    const Eigen::Vector2d way = segment.second - segment.first;
    for (const Eigen::Vector2d& end : {part->first, part->second}) {
      EXPECT_TRUE(end.x() > 10.0 - 1e-9 && end.x() < 110.0 + 1e-9) << end.x();
      EXPECT_TRUE(end.y() > 20.0 - 1e-9 && end.y() < 70.0 + 1e-9) << end.y();
      const Eigen::Vector2d offset = end - segment.first;
      EXPECT_NEAR(offset.x() * way.y() - offset.y() * way.x(), 0.0, 1e-8);
    }
  }
  EXPECT_GT(kept, 300);
}

}  // namespace
}  // namespace skyhalo

#include "skyhalo/evaluation/metrics.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "reference/naive_metrics.hpp"

namespace skyhalo {
namespace {

struct Case {
  std::vector<LogOdds> map;
  std::vector<std::uint8_t> truth;
};

/// 3 x 3 x 3 cells, all unobserved and free, to be filled.
Case empty_cube() {
  return {std::vector<LogOdds>(27, kUnknown), std::vector<std::uint8_t>(27, 0)};
}

Metrics score_of(const Case& c, double occupied_probability = 0.7) {
  return score(c.map, c.truth, occupied_probability);
}

// ln 4 = 1.386294: p = 0.8; the cell holds 1.386, which is p = 0.79995.
constexpr LogOdds kP80 = 1386;
constexpr LogOdds kP20 = -1386;

/// Two cells are found, one is claimed, one is missed though seen as free, one is missed and never
/// seen; five more are seen as free and are free.
Case worked_case() {
  Case c = empty_cube();
  c.map[0] = c.map[1] = c.map[2] = kP80;
  c.truth[0] = c.truth[1] = 1;
  for (std::size_t i = 3; i < 9; ++i) {
    c.map[i] = kP20;
  }
  c.truth[3] = 1;
  c.truth[20] = 1;
  return c;
}

TEST(MetricsTest, CountsEachCellOnce) {
  const Metrics m = score_of(worked_case());
  EXPECT_EQ(m.tp, 2);
  EXPECT_EQ(m.fp, 1);
  EXPECT_EQ(m.fn, 2);
  EXPECT_EQ(m.tn, 22);  // 27 - 2 - 1 - 2
}

TEST(MetricsTest, OnlyCountedCellsEnter) {
  const Case c = worked_case();
  std::vector<std::uint8_t> counted(27, 0);
  counted[0] = counted[1] = counted[2] = counted[3] = 1;
  const Metrics m = score(c.map, c.truth, 0.7, counted);
  EXPECT_EQ(m.tp, 2);
  EXPECT_EQ(m.fp, 1);
  EXPECT_EQ(m.fn, 1);  // cell 20 is missed too, but not counted
  EXPECT_EQ(m.tn, 0);
  EXPECT_DOUBLE_EQ(m.accuracy, 0.5);
}

TEST(MetricsTest, RatiosFollowFromTheCounts) {
  const Metrics m = score_of(worked_case());
  EXPECT_DOUBLE_EQ(m.accuracy, 24.0 / 27.0);
  EXPECT_DOUBLE_EQ(m.precision, 2.0 / 3.0);
  EXPECT_DOUBLE_EQ(m.recall, 2.0 / 4.0);
  EXPECT_DOUBLE_EQ(m.specificity, 22.0 / 23.0);
  EXPECT_DOUBLE_EQ(m.npv, 22.0 / 24.0);
}

TEST(MetricsTest, TheErrorIsOverTheObservedCells) {
  // Nine observed cells: two found (0.2^2 each), one claimed (0.8^2), one missed (0.8^2), five free
  // (0.2^2): (7 * 0.04 + 2 * 0.64) / 9 = 1.56 / 9.
  EXPECT_NEAR(score_of(worked_case()).error, 1.56 / 9.0, 1e-4);
}

TEST(MetricsTest, TheCorrelationIsOverAllCells) {
  // p: three times 0.8, six times 0.2, 18 times 0: sum 3.6, squares 2.16; t: four of 27; p t: 0.8 +
  // 0.8 + 0.2. cov = 1.8 / 27 - 3.6 * 4 / 27^2 = 0.046914; var p = 2.16 / 27 - (3.6 / 27)^2 =
  // 0.062222; var t = 4 / 27 * 23 / 27 = 0.126200; 0.046914 / sqrt(0.062222 * 0.126200) = 0.529414.
  EXPECT_NEAR(score_of(worked_case()).correlation, 0.529414, 1e-4);
}

TEST(MetricsTest, AnUnobservedCellIsFreeWhateverTheThreshold) {
  // It reads as 0.5, yet nothing is claimed of it.
  const Metrics m = score_of(empty_cube(), 0.3);
  EXPECT_EQ(m.fp, 0);
  EXPECT_EQ(m.tn, 27);
}

TEST(MetricsTest, OccupiedIsAboveTheThresholdNotAtIt) {
  Case c = empty_cube();
  c.map[0] = 0;  // p = 0.5 exactly
  c.map[1] = 1;
  EXPECT_EQ(score_of(c, 0.5).fp, 1);
}

TEST(MetricsTest, AnEmptyMapHasNoPrecision) {
  Case c = empty_cube();
  c.truth[13] = 1;
  const Metrics m = score_of(c);
  EXPECT_EQ(m.tp + m.fp, 0);
  EXPECT_EQ(m.fn, 1);
  EXPECT_EQ(m.recall, 0.0);
  EXPECT_EQ(m.specificity, 1.0);
  EXPECT_TRUE(std::isnan(m.precision));
  EXPECT_TRUE(std::isnan(m.error));
  EXPECT_TRUE(std::isnan(m.correlation));
}

TEST(MetricsTest, WithoutOccupiedTruthThereIsNoRecall) {
  Case c = empty_cube();
  c.map[3] = kP20;
  const Metrics m = score_of(c);
  EXPECT_TRUE(std::isnan(m.recall));
  EXPECT_TRUE(std::isnan(m.precision));
  EXPECT_TRUE(std::isnan(m.correlation));
  EXPECT_EQ(m.accuracy, 1.0);
}

TEST(MetricsTest, NoCellsAtAllHaveNoScore) {
  const Metrics m = score({}, {}, 0.7);
  EXPECT_EQ(m.tp + m.fp + m.tn + m.fn, 0);
  for (const double value :
       {m.accuracy, m.precision, m.recall, m.specificity, m.npv, m.error, m.correlation}) {
    EXPECT_TRUE(std::isnan(value));
  }
}

TEST(MetricsTest, AConstantFieldHasNoCorrelation) {
  Case c = empty_cube();
  c.truth[5] = 1;
  for (LogOdds& cell : c.map) {
    cell = 731;
  }
  EXPECT_TRUE(std::isnan(score_of(c).correlation));
}

TEST(MetricsTest, APerfectMapIsPerfect) {
  Case c = empty_cube();
  for (std::size_t i = 0; i < 27; ++i) {
    c.truth[i] = i % 4 == 0 ? 1 : 0;
    c.map[i] = static_cast<LogOdds>(c.truth[i] == 1 ? 5000 : -5000);
  }
  const Metrics m = score_of(c);
  EXPECT_EQ(m.fp + m.fn, 0);
  for (const double value : {m.accuracy, m.precision, m.recall, m.specificity, m.npv}) {
    EXPECT_EQ(value, 1.0);
  }
  EXPECT_NEAR(m.correlation, 1.0, 1e-9);  // two values, in step with the truth
  // p = 1 / (1 + e^-5) is wrong by 0.0066929 everywhere.
  EXPECT_NEAR(m.error, 0.0066929 * 0.0066929, 1e-8);
}

TEST(MetricsTest, TheExactOppositeIsAllWrong) {
  Case c = empty_cube();
  for (std::size_t i = 0; i < 27; ++i) {
    c.truth[i] = i % 4 == 0 ? 1 : 0;
    c.map[i] = static_cast<LogOdds>(c.truth[i] == 1 ? -5000 : 5000);
  }
  const Metrics m = score_of(c);
  EXPECT_EQ(m.tp + m.tn, 0);
  EXPECT_EQ(m.accuracy, 0.0);
  EXPECT_NEAR(m.correlation, -1.0, 1e-9);
}

TEST(MetricsTest, ExtremeLogOddsAreObserved) {
  // The smallest value but one, which is what `kUnknown` is not.
  Case c = empty_cube();
  c.map[0] = static_cast<LogOdds>(kUnknown + 1);
  c.map[1] = std::numeric_limits<LogOdds>::max();
  c.truth[1] = 1;
  const Metrics m = score_of(c);
  EXPECT_EQ(m.tp, 1);
  EXPECT_NEAR(m.error, 0.0, 1e-12);
  EXPECT_NEAR(m.correlation, 1.0, 1e-9);
}

/// Random maps from nearly empty to full, with truth that follows them more or less.
Case random_case(std::mt19937& random, std::size_t cells) {
  std::uniform_real_distribution share(0.0, 1.0);
  std::uniform_int_distribution value(-5000, 5000);
  const double observed = share(random);
  const double occupied = share(random) * share(random);
  const double agreement = share(random);
  Case c;
  for (std::size_t i = 0; i < cells; ++i) {
    c.truth.push_back(share(random) < occupied ? 1 : 0);
    int units = value(random);
    if (share(random) < agreement) {
      units = c.truth.back() == 1 ? std::abs(units) : -std::abs(units);
    }
    c.map.push_back(share(random) < observed ? static_cast<LogOdds>(units) : kUnknown);
  }
  return c;
}

/// As the reference wants it: NaN for unobserved, else p = 1 / (1 + exp(-l)).
reference::NaiveMetrics naive_score(const Case& c) {
  std::vector<double> probability;
  std::vector<bool> occupied;
  for (std::size_t i = 0; i < c.map.size(); ++i) {
    probability.push_back(c.map[i] == kUnknown ? std::nan("")
                                               : 1.0 / (1.0 + std::exp(-0.001 * c.map[i])));
    occupied.push_back(c.truth[i] != 0);
  }
  return reference::naive_metrics(probability, occupied);
}

void expect_same(double actual, double expected, const char* name) {
  if (std::isnan(expected)) {
    EXPECT_TRUE(std::isnan(actual)) << name;
  } else {
    EXPECT_NEAR(actual, expected, 1e-9) << name;
  }
}

void expect_like_the_reference(const Case& c) {
  const Metrics m = score_of(c);
  const reference::NaiveMetrics n = naive_score(c);
  EXPECT_EQ(m.tp, n.tp);
  EXPECT_EQ(m.fp, n.fp);
  EXPECT_EQ(m.tn, n.tn);
  EXPECT_EQ(m.fn, n.fn);
  expect_same(m.accuracy, n.accuracy, "accuracy");
  expect_same(m.precision, n.precision, "precision");
  expect_same(m.recall, n.recall, "recall");
  expect_same(m.specificity, n.specificity, "specificity");
  expect_same(m.npv, n.npv, "npv");
  expect_same(m.error, n.error, "error");
  expect_same(m.correlation, n.correlation, "correlation");
}

TEST(MetricsReference, RandomMapsScoreAsTheReferenceSays) {
  std::mt19937 random(22);
  for (int round = 0; round < 200; ++round) {
    expect_like_the_reference(random_case(random, 1 + static_cast<std::size_t>(round) * 7));
  }
}

TEST(MetricsReference, ALargeSparseMapScoresAsTheReferenceSays) {
  // As on a drive: few cells observed, few occupied, a million in all.
  std::mt19937 random(23);
  std::uniform_int_distribution<std::size_t> where(0, 999'999);
  std::uniform_int_distribution value(-5000, 5000);
  Case c{std::vector<LogOdds>(1'000'000, kUnknown), std::vector<std::uint8_t>(1'000'000, 0)};
  for (int i = 0; i < 3000; ++i) {
    const std::size_t cell = where(random);
    c.map[cell] = static_cast<LogOdds>(value(random));
    c.truth[cell] = c.map[cell] > 1000 ? 1 : 0;
    c.truth[where(random)] = 1;
  }
  expect_like_the_reference(c);
}

TEST(MetricsReference, OneFaintCellAmongManyHasACorrelation) {
  // A cell seen as free, p = 0.0067, where the truth is occupied: the only one of 10 000.
  Case c{std::vector<LogOdds>(10'000, kUnknown), std::vector<std::uint8_t>(10'000, 0)};
  c.map[77] = -5000;
  c.truth[77] = 1;
  EXPECT_NEAR(score_of(c).correlation, 1.0, 1e-6);
  expect_like_the_reference(c);
}

TEST(MetricsProperty, TheScoresAreConsistent) {
  std::mt19937 random(24);
  for (int round = 0; round < 100; ++round) {
    const Case c = random_case(random, 500);
    const Metrics m = score_of(c);
    EXPECT_EQ(m.tp + m.fp + m.tn + m.fn, 500);
    EXPECT_NEAR(m.accuracy * 500.0, static_cast<double>(m.tp + m.tn), 1e-9);
    EXPECT_TRUE(std::isnan(m.error) || (m.error >= 0.0 && m.error <= 1.0));
    EXPECT_TRUE(std::isnan(m.correlation) || std::abs(m.correlation) <= 1.0 + 1e-9);
  }
}

TEST(MetricsProperty, TheOrderOfTheCellsDoesNotMatter) {
  std::mt19937 random(25);
  Case c = random_case(random, 400);
  const Metrics before = score_of(c);
  for (std::size_t i = c.map.size() - 1; i > 0; --i) {
    const std::size_t other = std::uniform_int_distribution<std::size_t>(0, i)(random);
    std::swap(c.map[i], c.map[other]);
    std::swap(c.truth[i], c.truth[other]);
  }
  const Metrics after = score_of(c);
  EXPECT_EQ(before.tp, after.tp);
  EXPECT_EQ(before.error, after.error);
  EXPECT_EQ(before.correlation, after.correlation);
}

}  // namespace
}  // namespace skyhalo

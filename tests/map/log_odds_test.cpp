#include "skyhalo/map/log_odds.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "reference/naive_occupancy_map.hpp"

namespace skyhalo {
namespace {

TEST(LogOddsTest, KnowsTheLogarithmOfTheOdds) {
  EXPECT_EQ(log_odds(0.5), 0.0);
  EXPECT_NEAR(log_odds(0.75), std::log(3.0), 1e-15);
  EXPECT_NEAR(log_odds(0.25), -std::log(3.0), 1e-15);
  EXPECT_NEAR(log_odds(0.3), std::log(3.0 / 7.0), 1e-15);
}

TEST(LogOddsTest, StaysFiniteAtCertainty) {
  // log(999999) = 13.8155.
  EXPECT_NEAR(log_odds(1.0), 13.815510, 1e-5);
  EXPECT_NEAR(log_odds(0.0), -13.815510, 1e-5);
  EXPECT_EQ(log_odds(1e-9), log_odds(0.0));
  EXPECT_EQ(log_odds(2.0), log_odds(1.0));
}

TEST(LogOddsTest, AUnitIsAThousandth) {
  EXPECT_EQ(log_odds_units(0.0), 0);
  EXPECT_EQ(log_odds_units(1.0), 1000);
  EXPECT_EQ(log_odds_units(std::log(3.0)), 1099);        // 1.0986
  EXPECT_EQ(log_odds_units(std::log(3.0 / 7.0)), -847);  // -0.8473
  EXPECT_EQ(log_odds_units(0.0004), 0);
  EXPECT_EQ(log_odds_units(-0.0004), 0);
  EXPECT_EQ(log_odds_units(-0.0006), -1);
}

TEST(LogOddsTest, ReadsProbabilities) {
  EXPECT_EQ(probability_of(0), 0.5);
  EXPECT_NEAR(probability_of(1000), 1.0 / (1.0 + std::exp(-1.0)), 1e-15);
  EXPECT_NEAR(probability_of(1099), 0.75, 1e-4);
  EXPECT_NEAR(probability_of(-1099), 0.25, 1e-4);
  EXPECT_GT(probability_of(32767), 0.999999);
}

TEST(LogOddsTest, AnUnknownCellReadsAsAHalf) {
  EXPECT_EQ(probability_of(kUnknown), 0.5);
  EXPECT_EQ(kUnknown, -32768);
}

TEST(LogOddsTest, ACellSumsItsMeasurements) {
  EXPECT_EQ(updated(100, 250, 5000), 350);
  EXPECT_EQ(updated(100, -250, 5000), -150);
  EXPECT_EQ(updated(0, 0, 5000), 0);
}

TEST(LogOddsTest, AnUnknownCellStartsAtNothing) {
  EXPECT_EQ(updated(kUnknown, 250, 5000), 250);
  EXPECT_EQ(updated(kUnknown, -250, 5000), -250);
  EXPECT_EQ(updated(kUnknown, 0, 5000), 0);  // and is known from then on
}

TEST(LogOddsTest, ACellStaysWithinItsLimit) {
  EXPECT_EQ(updated(4900, 250, 5000), 5000);
  EXPECT_EQ(updated(-4900, -250, 5000), -5000);
  EXPECT_EQ(updated(kUnknown, 13816, 5000), 5000);
  EXPECT_EQ(updated(32767, 13816, 32767), 32767);
  EXPECT_EQ(updated(-32767, -13816, 32767), -32767);
  EXPECT_NE(updated(-32767, -13816, 32767), kUnknown);
}

TEST(LogOddsTest, ACellCanChangeItsMind) {
  LogOdds cell = 5000;
  for (int i = 0; i < 6; ++i) {
    cell = updated(cell, -847, 5000);
  }
  EXPECT_EQ(cell, -82);  // 5000 - 6 * 847
  EXPECT_LT(probability_of(cell), 0.5);
}

TEST(LogOddsProperty, AProbabilityComesBack) {
  std::mt19937 random(61);
  std::uniform_real_distribution<double> probability(1e-5, 1.0 - 1e-5);
  for (int i = 0; i < 5000; ++i) {
    const double p = probability(random);
    const LogOdds cell = updated(kUnknown, log_odds_units(log_odds(p)), 32767);
    // Half a unit of 0.001 times the steepest slope of the logistic function, 1/4.
    EXPECT_NEAR(probability_of(cell), p, 0.000126);
  }
}

TEST(LogOddsProperty, ProbabilitiesRiseWithTheLogOdds) {
  for (int cell = -32767; cell < 32767; ++cell) {
    EXPECT_LE(probability_of(static_cast<LogOdds>(cell)),
              probability_of(static_cast<LogOdds>(cell + 1)));
  }
  EXPECT_LT(probability_of(-1), probability_of(0));
  EXPECT_LT(probability_of(0), probability_of(1));
}

TEST(LogOddsReference, AgreesOnRandomValues) {
  std::mt19937 random(62);
  std::uniform_real_distribution<double> probability(-0.1, 1.1);
  std::uniform_int_distribution<int> units(-32767, 32767);
  for (int i = 0; i < 5000; ++i) {
    const double p = probability(random);
    EXPECT_NEAR(log_odds_units(log_odds(p)), reference::naive_log_odds_units(p), 1);
    const int cell = units(random);
    EXPECT_NEAR(probability_of(static_cast<LogOdds>(cell)),
                reference::naive_occupancy_probability(cell),
                1e-12);
  }
}

}  // namespace
}  // namespace skyhalo

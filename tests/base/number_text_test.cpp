#include "skyhalo/base/number_text.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <limits>
#include <random>

namespace skyhalo {
namespace {

TEST(NumberTextTest, SpeaksTheWordsOfPrintf) {
  EXPECT_EQ(number_text("%.3f", 1.0 / 3.0), "0.333");
  EXPECT_EQ(number_text("%.1f m", -2.0), "-2.0 m");
  EXPECT_EQ(number_text("%099.1f", 1.0).size(), 63U);
}

TEST(NumberTextTest, AnExactTextIsShort) {
  EXPECT_EQ(exact_number_text(0.1), "0.1");
  EXPECT_EQ(exact_number_text(-3.0), "-3");
  EXPECT_EQ(exact_number_text(0.0), "0");
  EXPECT_EQ(exact_number_text(1e300), "1e+300");
}

TEST(NumberTextProperty, AnExactTextReadsBackToTheLastBit) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> exponent(-300.0, 300.0);
  for (int i = 0; i < 1000; ++i) {
    const double value = std::pow(10.0, exponent(random)) * (i % 2 == 0 ? 1.0 : -1.0);
    EXPECT_EQ(std::strtod(exact_number_text(value).c_str(), nullptr), value);
  }
  const double smallest = std::numeric_limits<double>::denorm_min();
  EXPECT_EQ(std::strtod(exact_number_text(smallest).c_str(), nullptr), smallest);
}

}  // namespace
}  // namespace skyhalo

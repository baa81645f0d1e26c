#include "skyhalo/sim/random_numbers.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace skyhalo {
namespace {

TEST(RandomNumbersTest, TheFirstAreThoseOfSplitmix64) {
  // As published with the generator, for the seed 1234567.
  RandomNumbers random(1234567);
  EXPECT_EQ(random.bits(), 6457827717110365317U);
  EXPECT_EQ(random.bits(), 3203168211198807973U);
  EXPECT_EQ(random.bits(), 9817491932198370423U);
}

TEST(RandomNumbersProperty, TheyHaveTheirMeansAndBounds) {
  RandomNumbers random(1);
  double sum = 0.0;
  double squares = 0.0;
  std::array<int, 5> counts{};
  for (int i = 0; i < 100000; ++i) {
    const float share = random.uniform();
    EXPECT_TRUE(share >= 0.0F && share < 1.0F);
    const auto normal = static_cast<double>(random.normal());
    EXPECT_LE(std::abs(normal), 3.5);
    sum += normal;
    squares += normal * normal;
    ++counts.at(static_cast<std::size_t>(random.below(5)));
  }
  EXPECT_NEAR(sum / 1e5, 0.0, 0.015);
  EXPECT_NEAR(squares / 1e5, 1.0, 0.02);
  for (const int count : counts) {
    EXPECT_NEAR(count, 20000, 600);
  }
}

}  // namespace
}  // namespace skyhalo

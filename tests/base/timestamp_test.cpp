#include "skyhalo/base/timestamp.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <cstdint>

namespace skyhalo {
namespace {

TEST(TimestampTest, TheEpochIsZero) {
  EXPECT_EQ(seconds_since_epoch(Timestamp{}), 0.0);
}

TEST(TimestampTest, CountsSecondsSinceTheEpoch) {
  // 2011-09-26 is 15 243 days after 1970-01-01: 41 years of 365 days, 10 leap days (1972 to 2008)
  // and 268 days of 2011 before it: 14965 + 10 + 268.
  const Timestamp stamp =
      std::chrono::sys_days(std::chrono::year(2011) / 9 / 26) + std::chrono::milliseconds(1500);
  EXPECT_DOUBLE_EQ(seconds_since_epoch(stamp), 15243.0 * 86400.0 + 1.5);
}

TEST(TimestampTest, HoldsNanoseconds) {
  const Timestamp stamp{std::chrono::nanoseconds(1'317'042'145'964'389'445)};
  EXPECT_EQ((stamp + std::chrono::nanoseconds(1) - stamp).count(), 1);
  // A double near 1.3e9 has steps of 2.4e-7.
  EXPECT_NEAR(seconds_since_epoch(stamp), 1317042145.964389445, 2.4e-7);
}

}  // namespace
}  // namespace skyhalo

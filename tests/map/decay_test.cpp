#include "skyhalo/map/decay.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <string>
#include <vector>

#include "support/expect_error.hpp"

namespace skyhalo {
namespace {

using testing::message_of;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();

/// A cell that lives through frames of a length (s).
LogOdds after(LogOdds cell, const DecayConfig& config, double total_s, double frame_s) {
  DecayClock clock(config);
  const int frames = static_cast<int>(std::lround(total_s / frame_s));
  for (int i = 0; i < frames; ++i) {
    cell = decayed(cell, clock.pass(frame_s));
  }
  return cell;
}

/// The time (s) at which a cell first has half of its log odds or less.
double halved_after_s(LogOdds cell, const DecayConfig& config, double frame_s, double give_up_s) {
  DecayClock clock(config);
  const int half = std::abs(int{cell}) / 2;
  double now_s = 0.0;
  while (now_s < give_up_s) {
    cell = decayed(cell, clock.pass(frame_s));
    now_s += frame_s;
    if (std::abs(int{cell}) <= half) {
      return now_s;
    }
  }
  return now_s;
}

/// Expects of a cell after a time what a half-life of 0.98 to 1.02 of the given one leaves, but for
/// a unit of rounding.
void expect_share(LogOdds cell, double half_life_s, double total_s, LogOdds left) {
  const auto exact = [&](double error) {
    return std::abs(int{cell}) * std::exp2(-total_s * (1.0 + error) / half_life_s);
  };
  EXPECT_EQ(left > 0, cell > 0);
  EXPECT_LE(std::abs(int{left}), exact(-0.02) + 1.0);
  EXPECT_GE(std::abs(int{left}), exact(0.02) - 1.0);
}

/// Three half-lives in frames whose lengths (s) take turns: at each step, all that has passed
/// counts.
void expect_half_life(LogOdds first, double half_life_s, const std::vector<double>& frames_s) {
  DecayClock clock({half_life_s, half_life_s});
  LogOdds cell = first;
  double now_s = 0.0;
  double last_step_s = 0.0;
  for (std::size_t i = 0; now_s < 3.0 * half_life_s; ++i) {
    const double frame_s = frames_s[i % frames_s.size()];
    const DecayStep step = clock.pass(frame_s);
    now_s += frame_s;
    cell = decayed(cell, step);
    if (forgets(step)) {
      expect_share(first, half_life_s, now_s, cell);
      last_step_s = now_s;
    }
    ASSERT_LT(now_s - last_step_s, half_life_s / 16.0 * (1.0 + 1e-9)) << "nothing waits longer";
  }
  EXPECT_LT(std::abs(int{cell}), 0.15 * std::abs(int{first}));
}

TEST(DecayTest, AHalfLifeHalvesWhateverTheFrameTimes) {
  const std::vector<std::vector<double>> all_frames_s{{0.001},
                                                      {0.01},
                                                      {1.0 / 30.0},
                                                      {0.1},
                                                      {0.4},
                                                      {0.5},
                                                      {1.0},
                                                      {4.0},
                                                      {8.0},
                                                      {16.0},
                                                      {1.3, 0.02, 0.1, 0.1, 0.02, 0.1},
                                                      {0.0, 0.03, 7.0}};
  for (const std::vector<double>& frames_s : all_frames_s) {
    for (const int first : {32767, 5000, 2000, -32767, -5000, -2000}) {
      SCOPED_TRACE(::testing::Message() << first << " in frames of " << frames_s.front() << " s");
      expect_half_life(static_cast<LogOdds>(first), 8.0, frames_s);
    }
  }
}

TEST(DecayTest, NothingHappensBeforeASixteenthOfAHalfLife) {
  DecayClock clock({16.0, 64.0});
  EXPECT_FALSE(forgets(clock.pass(0.5)));
  EXPECT_FALSE(forgets(clock.pass(0.4)));
  const DecayStep step = clock.pass(0.1);
  EXPECT_TRUE(forgets(step));
  EXPECT_NEAR(step.keep_occupied, 65536 * std::exp2(-1.0 / 16.0), 1.0);
  EXPECT_EQ(step.keep_free, 65536);
  EXPECT_FALSE(forgets(clock.pass(0.9)));
  EXPECT_TRUE(forgets(clock.pass(0.1)));
  const DecayStep later = clock.pass(2.0);
  EXPECT_NEAR(later.keep_occupied, 65536 * std::exp2(-2.0 / 16.0), 1.0);
  EXPECT_NEAR(later.keep_free, 65536 * std::exp2(-4.0 / 64.0), 1.0);
}

TEST(DecayTest, ZeroIsNever) {
  EXPECT_EQ(after(5000, {}, 1e6, 1000.0), 5000);
  EXPECT_EQ(after(-5000, {}, 1e6, 1000.0), -5000);
  EXPECT_EQ(after(60, {0.0, 2.0}, 1000.0, 0.5), 60);
  EXPECT_EQ(after(-60, {2.0, 0.0}, 1000.0, 0.5), -60);
  EXPECT_EQ(after(5000, {2.0, 0.0}, 1000.0, 0.5), kUnknown);
  EXPECT_EQ(after(-5000, {0.0, 2.0}, 1000.0, 0.5), kUnknown);
}

TEST(DecayTest, EachStateHasItsOwnHalfLife) {
  struct Lives {
    double occupied_s;
    double free_s;
  };

  for (const Lives& lives :
       {Lives{4.0, 40.0}, Lives{40.0, 4.0}, Lives{2.0, 600.0}, Lives{600.0, 2.0}}) {
    SCOPED_TRACE(::testing::Message() << lives.occupied_s << " and " << lives.free_s << " s");
    const DecayConfig config{lives.occupied_s, lives.free_s};
    // The step at which it halves comes up to a sixteenth of the shorter half-life late.
    const double step_s = std::min(lives.occupied_s, lives.free_s) / 16.0;
    const double occupied_s = halved_after_s(5000, config, 0.05, 2.0 * lives.occupied_s);
    const double free_s = halved_after_s(-5000, config, 0.05, 2.0 * lives.free_s);
    EXPECT_NEAR(occupied_s, lives.occupied_s, 0.02 * lives.occupied_s + step_s);
    EXPECT_NEAR(free_s, lives.free_s, 0.02 * lives.free_s + step_s);
  }
}

TEST(DecayTest, ACellAlwaysComesNearerToUnknown) {
  for (const int keep : {0, 1, 32768, 62756, 65000, 65535}) {
    const DecayStep step{.keep_occupied = keep, .keep_free = keep};
    for (int value = -32767; value <= 32767; ++value) {
      const auto cell = static_cast<LogOdds>(value);
      const LogOdds left = decayed(cell, step);
      ASSERT_TRUE(left == kUnknown || (std::abs(int{left}) < std::abs(value) &&
                                       (left > 0) == (value > 0) && std::abs(int{left}) >= 50))
          << value << " to " << left << " keeping " << keep;
    }
  }
}

TEST(DecayTest, EveryCellIsUnknownInTheEnd) {
  for (const int cell : {32767, 5000, 100, 50, 49, 1, 0, -1, -50, -5000, -32767}) {
    EXPECT_EQ(after(static_cast<LogOdds>(cell), {1.0, 1.0}, 20.0, 0.1), kUnknown) << cell;
  }
}

TEST(DecayTest, NearZeroIsUnknown) {
  const DecayStep step{.keep_occupied = 32768, .keep_free = 32768, .unknown_below = 50};
  EXPECT_EQ(decayed(100, step), 50);
  EXPECT_EQ(decayed(-100, step), -50);
  EXPECT_EQ(decayed(99, step), kUnknown);
  EXPECT_EQ(decayed(-99, step), kUnknown);
  EXPECT_EQ(decayed(0, step), kUnknown);
  EXPECT_EQ(decayed(kUnknown, step), kUnknown);
}

TEST(DecayTest, NegativeTimeAndNanDoNothing) {
  DecayClock clock({16.0, 16.0});
  EXPECT_FALSE(forgets(clock.pass(0.9)));
  for (const double elapsed_s : {-100.0, kNan, -kInf, 0.0}) {
    EXPECT_FALSE(forgets(clock.pass(elapsed_s)));
  }
  EXPECT_TRUE(forgets(clock.pass(0.11))) << "what had passed before counts";
}

TEST(DecayTest, EndlessTimeForgetsAll) {
  DecayClock clock({16.0, 4.0});
  const DecayStep step = clock.pass(kInf);
  EXPECT_EQ(decayed(32767, step), kUnknown);
  EXPECT_EQ(decayed(-32767, step), kUnknown);
  EXPECT_FALSE(forgets(clock.pass(0.1)));
}

TEST(DecayTest, AStepThatKeepsAllIsNone) {
  EXPECT_FALSE(forgets(DecayStep{}));
  EXPECT_TRUE(forgets({.keep_occupied = 65535}));
  EXPECT_TRUE(forgets({.keep_free = 65535}));
  EXPECT_EQ(decayed(777, {.keep_free = 0}), 777);
  EXPECT_EQ(decayed(-777, {.keep_occupied = 0}), -777);
}

TEST(DecayTest, ManyCellsAreAsManyTimesOne) {
  const DecayStep step{.keep_occupied = 60000, .keep_free = 50000, .unknown_below = 70};
  std::vector<LogOdds> cells;
  for (int value = -32768; value <= 32767; ++value) {
    cells.push_back(static_cast<LogOdds>(value));
  }
  decay(cells, step);
  for (std::size_t i = 0; i < cells.size(); ++i) {
    ASSERT_EQ(cells[i], decayed(static_cast<LogOdds>(static_cast<int>(i) - 32768), step));
  }
}

TEST(DecayTest, RefusesTimesThatAreNone) {
  EXPECT_NO_THROW(check(DecayConfig{}));
  EXPECT_NO_THROW(check(DecayConfig{3600.0, 0.5}));
  for (const double bad : {-1.0, kNan, kInf}) {
    EXPECT_NE(message_of([&] {
                check(DecayConfig{bad, 1.0});
              }).find("half_life_occupied_s"),
              std::string::npos);
    EXPECT_NE(message_of([&] {
                check(DecayConfig{1.0, bad});
              }).find("half_life_free_s"),
              std::string::npos);
  }
}

}  // namespace
}  // namespace skyhalo

#include "skyhalo/stereo/sgm/skew.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

#include "skyhalo/stereo/sgm/aggregation.hpp"
#include "stereo/sgm/planes.hpp"

namespace skyhalo {
namespace {

using testing::for_each_instruction_set;

constexpr std::uint8_t kGuard = 0xA5;

std::size_t size_of(int rows, int stride) {
  return static_cast<std::size_t>(rows) * static_cast<std::size_t>(stride);
}

/// Rows of lanes with room for the shear at both ends.
class Rows {
 public:
  Rows(int lanes, int width)
      : lead_(2 * lanes + 32),
        stride_(lead_ + width + 2 * lanes + 48),
        values_(size_of(lanes, stride_), kGuard) {}

  void fill_at_random(std::mt19937& random) {
    std::uniform_int_distribution<int> any(0, 255);
    std::generate(
        values_.begin(), values_.end(), [&] { return static_cast<std::uint8_t>(any(random)); });
  }

  std::uint8_t& at(int lane, int column) {
    return values_[static_cast<std::size_t>(lane * stride_ + lead_ + column)];
  }

  sgm::LaneRows view() { return {values_.data() + lead_, stride_}; }

  [[nodiscard]] int lead() const { return lead_; }

  [[nodiscard]] int columns() const { return stride_ - lead_; }

 private:
  int lead_;
  int stride_;
  std::vector<std::uint8_t> values_;
};

/// Vectors of lanes, three bytes more apart than they are long.
class Steps {
 public:
  Steps(int lanes, int steps) : stride_(lanes + 3), values_(size_of(steps, stride_), kGuard) {}

  std::uint8_t& at(int step, int lane) {
    return values_[static_cast<std::size_t>(step * stride_ + lane)];
  }

  sgm::LaneSteps view() { return {values_.data(), stride_}; }

 private:
  int stride_;
  std::vector<std::uint8_t> values_;
};

/// Numbers of lanes that the engine works with: the vector's, and the guide's.
std::vector<int> lane_counts() {
  return {sgm::vector_lanes(), sgm::vector_lanes() + 16};
}

TEST(SkewTest, LaneIGetsTheColumnTwoIStepsBack) {
  std::mt19937 random(1);
  for_each_instruction_set([&] {
    for (const int lanes : lane_counts()) {
      Rows rows(lanes, 48);
      rows.fill_at_random(random);
      for (const int first : {0, 16, 32}) {
        Steps steps(lanes, 64);
        sgm::skew(rows.view(), lanes, first, steps.view());
        for (int step = 0; step < 64; ++step) {
          for (int lane = 0; lane < lanes + 3; ++lane) {
            const bool written = lane < lanes && step >= first && step < first + 16;
            ASSERT_EQ(steps.at(step, lane), written ? rows.at(lane, step - 2 * lane) : kGuard)
                << lanes << " lanes, step " << step << ", lane " << lane;
          }
        }
      }
    }
  });
}

TEST(SkewTest, TheWayBackWritesTheColumnTwoIStepsBack) {
  for_each_instruction_set([&] {
    for (const int lanes : lane_counts()) {
      Steps steps(lanes, 32);
      for (int step = 0; step < 32; ++step) {
        for (int lane = 0; lane < lanes; ++lane) {
          steps.at(step, lane) = static_cast<std::uint8_t>(7 * step + 3 * lane);
        }
      }
      Rows rows(lanes, 32);
      sgm::unskew(steps.view(), lanes, 16, rows.view());
      for (int lane = 0; lane < lanes; ++lane) {
        for (int column = -rows.lead(); column < rows.columns(); ++column) {
          const int step = column + 2 * lane;
          const bool written = step >= 16 && step < 32;
          ASSERT_EQ(rows.at(lane, column), written ? steps.at(step, lane) : kGuard)
              << lanes << " lanes, lane " << lane << ", column " << column;
        }
      }
    }
  });
}

TEST(SkewProperty, ThereAndBackGivesTheSameRows) {
  std::mt19937 random(2);
  for_each_instruction_set([&] {
    for (const int lanes : lane_counts()) {
      for (const int width : {1, 17, 48, 101}) {
        const int steps_needed = (width + 2 * lanes + 15) / 16 * 16;
        Rows rows(lanes, width);
        rows.fill_at_random(random);
        Steps steps(lanes, steps_needed);
        Rows back(lanes, width);
        for (int step = 0; step < steps_needed; step += 16) {
          sgm::skew(rows.view(), lanes, step, steps.view());
          sgm::unskew(steps.view(), lanes, step, back.view());
        }
        for (int lane = 0; lane < lanes; ++lane) {
          for (int column = 0; column < width; ++column) {
            ASSERT_EQ(back.at(lane, column), rows.at(lane, column)) << lane << ", " << column;
          }
        }
      }
    }
  });
}

}  // namespace
}  // namespace skyhalo

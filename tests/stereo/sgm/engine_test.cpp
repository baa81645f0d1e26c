#include "skyhalo/stereo/sgm/engine.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numeric>
#include <opencv2/core.hpp>
#include <random>
#include <sstream>
#include <thread>
#include <vector>

#include "reference/naive_sgm.hpp"
#include "stereo/sgm/planes.hpp"
#include "stereo/sgm/sgm_case.hpp"
#include "support/sanitised.hpp"
#include "support/textured_pair.hpp"

namespace skyhalo {
namespace {

using testing::first_difference;
using testing::for_each_instruction_set;
using testing::SgmCase;
using testing::SgmCases;
using testing::TexturedPair;

/// Runs the tasks on several threads, in a random order.
class ShuffledThreads final : public sgm::Executor {
 public:
  ShuffledThreads(int threads, unsigned seed) : threads_(threads), random_(seed) {}

  void for_each(int count, const sgm::Task& task) override {
    std::vector<int> order(static_cast<std::size_t>(count));
    std::iota(order.begin(), order.end(), 0);
    std::shuffle(order.begin(), order.end(), random_);
    std::atomic<std::size_t> next{0};
    const auto work = [&] {
      for (std::size_t i = next++; i < order.size(); i = next++) {
        task(order[i]);
      }
    };
    std::vector<std::thread> others;
    for (int thread = 1; thread < threads_; ++thread) {
      others.emplace_back(work);
    }
    work();
    for (std::thread& other : others) {
      other.join();
    }
  }

 private:
  int threads_;
  std::mt19937 random_;
};

template <class T, class Image>
sgm::ImageRows<T> rows_of(Image& image) {
  return {image[0], static_cast<std::ptrdiff_t>(image.step1())};
}

sgm::Engine engine_for(const SgmCase& of) {
  return {of.config, {of.pair.left.cols, of.pair.left.rows, of.max_disparity_px}};
}

cv::Mat1f matched(sgm::Engine& engine,
                  const TexturedPair& pair,
                  bool align_left,
                  sgm::Executor& executor) {
  cv::Mat1f disparity(pair.left.size(), -5.0F);
  engine.match(
      {rows_of<const std::uint8_t>(pair.left), rows_of<const std::uint8_t>(pair.right), align_left},
      rows_of<float>(disparity),
      executor);
  return disparity;
}

cv::Mat1f matched(const SgmCase& of) {
  sgm::Engine engine = engine_for(of);
  sgm::SerialExecutor executor;
  return matched(engine, of.pair, of.align_left, executor);
}

int count_found(const cv::Mat& disparity) {
  return cv::countNonZero(disparity == disparity);
}

/// What the engine gives with each instruction set, after another pair of the same size went
/// through it, is what the naive matcher gives.
void expect_as_reference(const SgmCase& of, const TexturedPair& before) {
  std::ostringstream description;
  description << of;
  SCOPED_TRACE(description.str());
  const cv::Mat1f expected = reference::naive_sgm(of.pair.left, of.pair.right, naive_settings(of));
  for_each_instruction_set([&] {
    sgm::Engine engine = engine_for(of);
    sgm::SerialExecutor executor;
    (void)matched(engine, before, !of.align_left, executor);
    const cv::Mat1f found = matched(engine, of.pair, of.align_left, executor);
    EXPECT_EQ(first_difference(found, expected), "");
  });
}

TEST(EngineTest, KnowsWhatItWasMadeFor) {
  const sgm::Engine engine({}, {40, 20, 32});
  EXPECT_EQ(engine.size(), (sgm::EngineSize{40, 20, 32}));
  EXPECT_NE(engine.size(), (sgm::EngineSize{41, 20, 32}));
  EXPECT_NE(engine.size(), (sgm::EngineSize{40, 21, 32}));
  EXPECT_NE(engine.size(), (sgm::EngineSize{40, 20, 48}));
  EXPECT_EQ(engine.lanes(), sgm::vector_lanes());
}

TEST(EngineTest, FindsAPlaneUpToTheLastPixelThatBothImagesSee) {
  SgmCase of;
  of.max_disparity_px = 32;
  of.pair = testing::textured_pair({120, 50}, 9, 3);
  for_each_instruction_set([&] {
    const cv::Mat1f disparity = matched(of);
    // The match of column 110 is the left image's last: what lies beyond it, by however small a
    // part of a pixel, is none.
    for (int v = 0; v < disparity.rows; ++v) {
      for (int u = 0; u < 110; ++u) {
        ASSERT_NEAR(disparity(v, u), 9.0F, 0.25F) << u << ", " << v;
      }
    }
    EXPECT_EQ(count_found(disparity.colRange(111, 120)), 0);
  });
}

TEST(EngineTest, FindsADisparityBetweenTwoPixels) {
  // Each right pixel is the mean of the left pixels 6 and 7 px to its right.
  const cv::Mat1b wide = testing::texture({140, 50}, 4);
  SgmCase of;
  of.max_disparity_px = 16;
  of.pair.left = wide.colRange(0, 120).clone();
  of.pair.right = 0.5 * wide.colRange(6, 126) + 0.5 * wide.colRange(7, 127);
  const cv::Mat1f disparity = matched(of);
  const cv::Scalar mean_px = cv::mean(disparity, disparity == disparity);
  EXPECT_GT(count_found(disparity), 113 * 50 * 9 / 10);
  EXPECT_NEAR(mean_px[0], 6.5, 0.1);
}

/// Widths and heights of every kind for a range; costly ones are rare.
cv::Size any_size(SgmCases& cases, int max_disparity_px) {
  const bool wide = cases.draw(0, 2) == 0;
  const int width = max_disparity_px + (wide ? cases.draw(1, 170) : cases.draw(1, 30));
  const int cells = width * max_disparity_px;
  const int most_rows = std::clamp(160'000 / cells, 3, 150);
  return {width, cases.draw(1, most_rows)};
}

TEST(EngineReference, EqualsTheNaiveMatcherOfAnySizeAndSetting) {
  SgmCases cases(1);
  int found = 0;
  for (int round = 0; round < testing::rounds(200); ++round) {
    const int max_disparity_px = 16 * (round % 3 == 0 ? cases.draw(1, 16) : cases.draw(1, 4));
    const SgmCase of = cases.next(any_size(cases, max_disparity_px), max_disparity_px);
    expect_as_reference(of, cases.any_pair(of.pair.left.size(), max_disparity_px));
    found += count_found(matched(of));
  }
  EXPECT_GT(found, testing::rounds(10'000));
}

TEST(EngineReference, EqualsTheNaiveMatcherOfOneToManyRows) {
  // Up to three strips of the longest vectors of x86, and each height around their ends.
  SgmCases cases(2);
  for (const int height : {1, 2, 15, 16, 17, 31, 32, 33, 63, 64, 65, 127, 128, 129, 193}) {
    const SgmCase of = cases.next({cases.draw(17, 40), height}, 16);
    expect_as_reference(of, cases.any_pair(of.pair.left.size(), 16));
  }
}

TEST(EngineReference, EqualsTheNaiveMatcherAroundTheShortestStrip) {
  // A strip lasts 2 lanes + 4 steps at least, whatever the width: 36, 68 and 132 on x86.
  SgmCases cases(3);
  for (const int shortest : {36, 68, 132}) {
    for (int width = shortest - 3; width <= shortest + 2; ++width) {
      const SgmCase of = cases.next({width, cases.draw(1, 70)}, 32);
      expect_as_reference(of, cases.any_pair(of.pair.left.size(), 32));
    }
  }
}

TEST(EngineReference, EqualsTheNaiveMatcherOfImagesJustWideEnough) {
  SgmCases cases(4);
  for (int max_disparity_px = 16; max_disparity_px <= 256; max_disparity_px += 16) {
    for (const int more_px : {1, 2}) {
      const SgmCase of =
          cases.next({max_disparity_px + more_px, cases.draw(1, 4)}, max_disparity_px);
      expect_as_reference(of, cases.any_pair(of.pair.left.size(), max_disparity_px));
    }
  }
}

TEST(EngineReference, EqualsTheNaiveMatcherWithTheLargestSums) {
  SgmCases cases(5);
  for (const int p1 : {0, 20, 51}) {
    for (const bool align_left : {false, true}) {
      SgmCase of = cases.next({60, 40}, 32);
      of.config = SgmConfig();
      of.config.p1 = p1;
      of.config.p2_min = 51;
      of.config.p2_max = 51;
      of.align_left = align_left;
      expect_as_reference(of, cases.any_pair({60, 40}, 32));
    }
  }
}

TEST(EngineProperty, TheSameBitsOnAnyThreadsInAnyOrder) {
  SgmCases cases(6);
  for (unsigned round = 0; round < 12; ++round) {
    SgmCase of = cases.next({150, 90}, 48);
    of.config.texture_min_grey = 0;
    const cv::Mat1f expected = matched(of);
    for (const int threads : {1, 2, 5}) {
      sgm::Engine engine = engine_for(of);
      ShuffledThreads executor(threads, round);
      for (int frame = 0; frame < 2; ++frame) {
        const cv::Mat1f found = matched(engine, of.pair, of.align_left, executor);
        EXPECT_EQ(first_difference(found, expected), "") << threads << " threads";
      }
    }
  }
}

TEST(EngineProperty, OnlyThePixelsOfItsRowsAreWritten) {
  SgmCases cases(7);
  for (int round = 0; round < 10; ++round) {
    const SgmCase of = cases.next({cases.draw(17, 150), cases.draw(1, 70)}, 16);
    const int more_px = cases.draw(1, 70);
    cv::Mat1f memory(of.pair.left.rows + 2, of.pair.left.cols + more_px + 1, 77.0F);
    const cv::Rect at(1, 1, of.pair.left.cols, of.pair.left.rows);
    cv::Mat1f within = memory(at);
    sgm::Engine engine = engine_for(of);
    sgm::SerialExecutor executor;
    engine.match({rows_of<const std::uint8_t>(of.pair.left),
                  rows_of<const std::uint8_t>(of.pair.right),
                  of.align_left},
                 rows_of<float>(within),
                 executor);
    EXPECT_EQ(first_difference(cv::Mat1f(within.clone()), matched(of)), "");
    within = 77.0F;
    EXPECT_EQ(cv::countNonZero(memory != 77.0F), 0);
  }
}

TEST(EngineProperty, RowsMayBeginAnywhereAndBeAnyDistanceApart) {
  SgmCases cases(8);
  for (int round = 0; round < 10; ++round) {
    const SgmCase of = cases.next({cases.draw(17, 150), cases.draw(1, 70)}, 16);
    const cv::Size larger(of.pair.left.cols + cases.draw(0, 20), of.pair.left.rows + 1);
    const cv::Rect at(larger.width - of.pair.left.cols, 1, of.pair.left.cols, of.pair.left.rows);
    SgmCase within = of;
    within.pair.left = testing::texture(larger, 1)(at);
    within.pair.right = testing::texture(larger + cv::Size(7, 0), 2)(at);
    of.pair.left.copyTo(within.pair.left);
    of.pair.right.copyTo(within.pair.right);
    EXPECT_EQ(first_difference(matched(within), matched(of)), "");
  }
}

TEST(EngineProperty, RowsMayStandUpsideDown) {
  SgmCases cases(9);
  const SgmCase of = cases.next({70, 40}, 16);
  TexturedPair flipped;
  cv::flip(of.pair.left, flipped.left, 0);
  cv::flip(of.pair.right, flipped.right, 0);
  const auto from_last = [](auto rows) { return decltype(rows){rows.row(39), -rows.stride}; };
  cv::Mat1f disparity(of.pair.left.size());
  sgm::Engine engine = engine_for(of);
  sgm::SerialExecutor executor;
  engine.match({from_last(rows_of<const std::uint8_t>(flipped.left)),
                from_last(rows_of<const std::uint8_t>(flipped.right)),
                of.align_left},
               from_last(rows_of<float>(disparity)),
               executor);
  cv::Mat1f upright;
  cv::flip(disparity, upright, 0);
  EXPECT_EQ(first_difference(upright, matched(of)), "");
}

TEST(EngineProperty, AlignedLeftIsAlignedRightInAMirror) {
  SgmCases cases(10);
  for (int round = 0; round < 10; ++round) {
    SgmCase of = cases.next({cases.draw(33, 120), cases.draw(1, 70)}, 32);
    of.align_left = false;
    SgmCase mirrored = of;
    mirrored.align_left = true;
    mirrored.pair = {};  // it shares the pixels
    cv::flip(of.pair.right, mirrored.pair.left, 1);
    cv::flip(of.pair.left, mirrored.pair.right, 1);
    cv::Mat1f back;
    cv::flip(matched(mirrored), back, 1);
    EXPECT_EQ(first_difference(back, matched(of)), "");
  }
}

}  // namespace
}  // namespace skyhalo

// Counts what stereo matching allocates from frame to frame: by the operators new, which this
// program replaces, and as the data of images.
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cstddef>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "skyhalo/stereo/matcher.hpp"
#include "support/counted_new.hpp"
#include "support/counting_allocator.hpp"
#include "support/textured_pair.hpp"

namespace skyhalo {
namespace {

using testing::CountingAllocator;

struct Images {
  cv::Mat left;
  cv::Mat right;
};

Images images_of(int type, unsigned seed) {
  const testing::TexturedPair pair = testing::textured_pair({300, 150}, 9, seed);
  Images images;
  pair.left.convertTo(images.left, CV_MAT_DEPTH(type), 1.0, 3.0 * seed);
  pair.right.convertTo(images.right, CV_MAT_DEPTH(type), 1.0, 3.0 * seed);
  if (CV_MAT_CN(type) > 1) {
    const int code = CV_MAT_CN(type) == 3 ? cv::COLOR_GRAY2BGR : cv::COLOR_GRAY2BGRA;
    cv::cvtColor(images.left, images.left, code);
    cv::cvtColor(images.right, images.right, code);
  }
  return images;
}

/// Checks that five frames after the first allocate nothing.
void expect_no_allocation(int type, Alignment alignment) {
  const CountingAllocator images_data;
  MatcherConfig config;
  config.alignment = alignment;
  Matcher matcher(config);
  cv::Mat1f disparity;
  const Images first = images_of(type, 1);
  matcher.match(first.left, first.right, disparity);
  for (unsigned frame = 2; frame < 7; ++frame) {
    const Images images = images_of(type, frame);
    const long before = allocation_count;
    const long before_data = images_data.count();
    matcher.match(images.left, images.right, disparity);
    const long after = allocation_count;
    EXPECT_EQ(after - before, 0) << "frame " << frame;
    EXPECT_EQ(images_data.count() - before_data, 0) << "frame " << frame;
    EXPECT_EQ(disparity.size(), cv::Size(300, 150));
  }
}

void expect_no_allocation_either_way(int type) {
  // TBB allocates for each task that it hands to a thread.
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  expect_no_allocation(type, Alignment::kRight);
  expect_no_allocation(type, Alignment::kLeft);
}

TEST(MatcherAllocationTest, TheCountersCount) {
  const CountingAllocator images_data;
  const long before = allocation_count;
  const auto* const value = new std::vector<int>(100);
  EXPECT_EQ(allocation_count - before, 2);
  delete value;
  const cv::Mat1b image(10, 10);
  EXPECT_EQ(images_data.count(), 1);
}

TEST(MatcherAllocationTest, GreyPairsAllocateNothingPerFrame) {
  expect_no_allocation_either_way(CV_8UC1);
}

TEST(MatcherAllocationTest, WideGreyPairsAllocateNothingPerFrame) {
  expect_no_allocation_either_way(CV_16UC1);
}

TEST(MatcherAllocationTest, ColourPairsAllocateNothingPerFrame) {
  for (const int type : {CV_8UC3, CV_8UC4, CV_16UC3, CV_16UC4}) {
    SCOPED_TRACE(type);
    expect_no_allocation_either_way(type);
  }
}

}  // namespace
}  // namespace skyhalo

// Counts what rectification allocates from frame to frame: by the operators new, which this program
// replaces, and as the data of images.
#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdlib>
#include <new>
#include <opencv2/core.hpp>
#include <opencv2/core/utility.hpp>
#include <opencv2/imgproc.hpp>
#include <string>
#include <thread>
#include <vector>

#include "rectify/raw_scene.hpp"
#include "skyhalo/rectify/rectifier.hpp"
#include "support/counted_new.hpp"
#include "support/counting_allocator.hpp"
#include "support/textured_pair.hpp"

namespace skyhalo {
namespace {

using testing::CountingAllocator;

StereoPair raw_pair(const testing::ExampleLens& lens, PairModelKind kind) {
  testing::RandomRays random(31);
  return testing::stereo_pair(testing::turned_pair(lens, lens, random), {.model = kind});
}

StereoPair pinhole_pair() {
  return raw_pair(testing::radial_tangential_examples()[1], PairModelKind::kPinhole);
}

StereoPair fisheye_pair() {
  return raw_pair(testing::ideal_fisheye(175.0), PairModelKind::kSpherical);
}

/// Both images of the raw size and of an OpenCV type.
StereoImages images_of(const StereoPair& pair, int type) {
  cv::Mat image = testing::texture(left_image_size_px(pair), 1);
  if (CV_MAT_CN(type) == 3) {
    cv::cvtColor(image, image, cv::COLOR_GRAY2BGR);
  } else if (CV_MAT_CN(type) == 4) {
    cv::cvtColor(image, image, cv::COLOR_GRAY2BGRA);
  }
  image.convertTo(image, CV_MAT_DEPTH(type), CV_MAT_DEPTH(type) == CV_16U ? 256.0 : 1.0);
  return {image, image.clone()};
}

/// Lets all of OpenCV's threads take part in a loop at once: each allocates its own state when it
/// first does, whenever that is, and never again.
void wake_threads() {
  const int threads = cv::getNumThreads();
  const auto until = std::chrono::steady_clock::now() + std::chrono::seconds(10);
  std::atomic<int> awake{0};
  cv::parallel_for_(cv::Range(0, threads), [&](const cv::Range&) {
    ++awake;
    while (awake < threads && std::chrono::steady_clock::now() < until) {
      std::this_thread::yield();
    }
  });
}

/// Checks that four frames after the first two allocate nothing.
void expect_no_allocation(const StereoPair& pair, int factor, int type) {
  wake_threads();
  const CountingAllocator images_data;
  const StereoImages images = images_of(pair, type);
  Rectifier rectifier(pair, factor);
  (void)rectifier.rectify(images);
  (void)rectifier.rectify(images);
  for (int frame = 3; frame < 7; ++frame) {
    const long before = allocation_count;
    const long before_data = images_data.count();
    (void)rectifier.rectify(images);
    const long after = allocation_count;
    EXPECT_EQ(after - before, 0) << "frame " << frame;
    EXPECT_EQ(images_data.count() - before_data, 0) << "frame " << frame;
  }
}

const std::array<int, 6> kTypes{CV_8UC1, CV_8UC3, CV_8UC4, CV_16UC1, CV_16UC3, CV_16UC4};

std::string case_name(int factor, int type) {
  return "factor " + std::to_string(factor) + ", " + std::to_string(CV_MAT_CN(type)) +
         " channels of " + (CV_MAT_DEPTH(type) == CV_16U ? "16" : "8") + " bit";
}

void expect_no_allocation_in_any_case(const StereoPair& pair) {
  for (const int factor : {1, 2, 4}) {
    for (const int type : kTypes) {
      SCOPED_TRACE(case_name(factor, type));
      expect_no_allocation(pair, factor, type);
    }
  }
}

TEST(RectifyAllocationTest, TheCountersCount) {
  const CountingAllocator images_data;
  const long before = allocation_count;
  const auto* const value = new std::vector<int>(100);
  EXPECT_EQ(allocation_count - before, 2);
  delete value;
  const cv::Mat1b image(10, 10);
  EXPECT_EQ(images_data.count(), 1);
}

TEST(RectifyAllocationTest, RawPinholePairsAllocateNothingPerFrame) {
  expect_no_allocation_in_any_case(pinhole_pair());
}

TEST(RectifyAllocationTest, RawFisheyePairsAllocateNothingPerFrame) {
  expect_no_allocation_in_any_case(fisheye_pair());
}

TEST(RectifyAllocationTest, RectifiedPairsAllocateNothingPerFrame) {
  StereoPair pair = pinhole_pair();
  pair.raw.reset();
  expect_no_allocation_in_any_case(pair);
}

TEST(RectifyAllocationTest, TheImagesStayInTheirMemory) {
  for (const StereoPair& pair : {pinhole_pair(), fisheye_pair()}) {
    for (const int factor : {1, 2, 4}) {
      const StereoImages images = images_of(pair, CV_8UC1);
      Rectifier rectifier(pair, factor);
      const RectifiedPair& first = rectifier.rectify(images);
      const uchar* const left = first.left.data;
      const uchar* const right = first.right.data;
      for (int frame = 2; frame < 6; ++frame) {
        const RectifiedPair& next = rectifier.rectify(images);
        EXPECT_EQ(next.left.data, left);
        EXPECT_EQ(next.right.data, right);
      }
    }
  }
}

}  // namespace
}  // namespace skyhalo

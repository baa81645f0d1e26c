#pragma once

#include <atomic>
#include <cstddef>
#include <opencv2/core.hpp>

namespace skyhalo::testing {

/// Counts the data of images and leaves the work to OpenCV's own allocator.
class CountingAllocator : public cv::MatAllocator {
 public:
  CountingAllocator() { cv::Mat::setDefaultAllocator(this); }

  ~CountingAllocator() override { cv::Mat::setDefaultAllocator(cv::Mat::getStdAllocator()); }

  CountingAllocator(const CountingAllocator&) = delete;
  CountingAllocator& operator=(const CountingAllocator&) = delete;
  CountingAllocator(CountingAllocator&&) = delete;
  CountingAllocator& operator=(CountingAllocator&&) = delete;

  [[nodiscard]] long count() const { return count_; }

  cv::UMatData* allocate(int dims,  // NOLINT(readability-function-size): OpenCV's interface
                         const int* sizes,
                         int type,
                         void* data,
                         std::size_t* step,
                         cv::AccessFlag flags,
                         cv::UMatUsageFlags usage) const override {
    count_ += data == nullptr ? 1 : 0;
    return cv::Mat::getStdAllocator()->allocate(dims, sizes, type, data, step, flags, usage);
  }

  bool allocate(cv::UMatData* data, cv::AccessFlag flags, cv::UMatUsageFlags usage) const override {
    return cv::Mat::getStdAllocator()->allocate(data, flags, usage);
  }

  void deallocate(cv::UMatData* data) const override {
    cv::Mat::getStdAllocator()->deallocate(data);
  }

 private:
  mutable std::atomic<long> count_{0};
};

}  // namespace skyhalo::testing

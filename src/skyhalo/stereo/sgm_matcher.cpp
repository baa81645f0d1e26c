#include "skyhalo/stereo/sgm_matcher.hpp"

#include <tbb/task_arena.h>

#include <cstddef>
#include <new>
#include <string>

#include "skyhalo/base/error.hpp"
#include "skyhalo/base/for_each_index.hpp"
#include "skyhalo/stereo/sgm/engine.hpp"

namespace skyhalo {
namespace {

class TbbExecutor final : public sgm::Executor {
 public:
  void for_each(int count, const sgm::Task& task) override {
    // A thread that waits here must not begin to match another pair meanwhile.
    tbb::this_task_arena::isolate([&] {
      for_each_index(static_cast<std::size_t>(count),
                     [&task](std::size_t i) { task(static_cast<int>(i)); });
    });
  }
};

template <class T, class Image>
sgm::ImageRows<T> rows_of(Image& image) {
  return {image[0], static_cast<std::ptrdiff_t>(image.step1())};
}

}  // namespace

SgmMatcher::SgmMatcher(const MatcherConfig& config) : config_(config) {}

SgmMatcher::SgmMatcher(SgmMatcher&& other) noexcept = default;
SgmMatcher& SgmMatcher::operator=(SgmMatcher&& other) noexcept = default;
SgmMatcher::~SgmMatcher() = default;

void SgmMatcher::make_engine(int width_px, int height_px) {
  const sgm::EngineSize size{width_px, height_px, config_.max_disparity_px};
  if (engine_ && engine_->size() == size && engine_->lanes() == sgm::vector_lanes()) {
    return;
  }
  engine_.reset();  // its memory first
  try {
    engine_ = std::make_unique<sgm::Engine>(config_.sgm, size);
  } catch (const std::bad_alloc&) {
    throw Error(ErrorKind::kFailure,
                "not enough memory to match " + std::to_string(width_px) + "x" +
                    std::to_string(height_px) + " px with " +
                    std::to_string(config_.max_disparity_px) +
                    " disparities; shrink the images or search fewer");
  }
}

void SgmMatcher::match(const cv::Mat1b& left, const cv::Mat1b& right, cv::Mat1f& disparity) {
  make_engine(left.cols, left.rows);
  disparity.create(left.size());
  TbbExecutor executor;
  engine_->match({rows_of<const std::uint8_t>(left),
                  rows_of<const std::uint8_t>(right),
                  config_.alignment == Alignment::kLeft},
                 rows_of<float>(disparity),
                 executor);
}

}  // namespace skyhalo

#include "skyhalo/stereo/sgm_matcher.hpp"

#include <cstddef>
#include <optional>

#include "skyhalo/base/for_each_index.hpp"
#include "skyhalo/stereo/sgm/engine.hpp"

namespace skyhalo {
namespace {

class TbbExecutor final : public sgm::Executor {
 public:
  void for_each(int count, const sgm::Task& task) override {
    for_each_index(static_cast<std::size_t>(count),
                   [&task](std::size_t i) { task(static_cast<int>(i)); });
  }
};

template <class T, class Image>
sgm::ImageRows<T> rows_of(Image& image) {
  return {image[0], static_cast<std::ptrdiff_t>(image.step1())};
}

}  // namespace

struct SgmMatcher::Memory {
  MatcherConfig config;
  std::optional<sgm::Engine> engine;
};

SgmMatcher::SgmMatcher(const MatcherConfig& config)
    : memory_(std::make_unique<Memory>(Memory{config, {}})) {}

SgmMatcher::SgmMatcher(SgmMatcher&& other) noexcept = default;
SgmMatcher& SgmMatcher::operator=(SgmMatcher&& other) noexcept = default;
SgmMatcher::~SgmMatcher() = default;

void SgmMatcher::match(const cv::Mat1b& left, const cv::Mat1b& right, cv::Mat1f& disparity) {
  const sgm::EngineSize size{left.cols, left.rows, memory_->config.max_disparity_px};
  auto& engine = memory_->engine;
  if (!engine || engine->size() != size || engine->lanes() != sgm::vector_lanes()) {
    engine.reset();  // its memory first
    engine.emplace(memory_->config.sgm, size);
  }
  disparity.create(left.size());
  TbbExecutor executor;
  engine->match({rows_of<const std::uint8_t>(left),
                 rows_of<const std::uint8_t>(right),
                 memory_->config.alignment == Alignment::kLeft},
                rows_of<float>(disparity),
                executor);
}

}  // namespace skyhalo

#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <memory>
#include <opencv2/core.hpp>
#include <opencv2/core/utility.hpp>
#include <span>
#include <vector>

#include "skyhalo/base/error.hpp"
#include "skyhalo/stereo/matcher.hpp"
#include "support/instruction_set.hpp"

namespace {

using skyhalo::MatcherConfig;

/// The fuzzer's bytes one after the other; 0 when there are no more.
class Bytes {
 public:
  explicit Bytes(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

  int next() {
    const int value = bytes_.empty() ? 0 : bytes_.front();
    bytes_ = bytes_.subspan(bytes_.empty() ? 0 : 1);
    return value;
  }

  int below(int end) { return next() % end; }

  [[nodiscard]] std::span<const std::uint8_t> rest() const { return bytes_; }

 private:
  std::span<const std::uint8_t> bytes_;
};

/// An image with exactly the memory that its rows need, for the sanitiser to see any step beyond.
class TightImage {
 public:
  TightImage(const cv::Size& size, int type, int padding)
      : row_(static_cast<std::size_t>(size.width) * CV_ELEM_SIZE(type)),
        stride_(row_ + static_cast<std::size_t>(padding) * CV_ELEM_SIZE1(type)),
        bytes_(std::make_unique<std::uint8_t[]>(  // NOLINT(*-avoid-c-arrays): of that very size
            stride_ * static_cast<std::size_t>(size.height - 1) + row_)),
        image_(size, type, bytes_.get(), stride_) {}

  [[nodiscard]] cv::Mat& image() { return image_; }

  /// Pixels from the bytes again and again, `shift_px` further in the row.
  void fill(std::span<const std::uint8_t> bytes, int shift_px) {
    if (bytes.empty()) {
      return;
    }
    const std::size_t shift = static_cast<std::size_t>(shift_px) * image_.elemSize();
    for (int v = 0; v < image_.rows; ++v) {
      std::uint8_t* const row = image_.ptr(v);
      for (std::size_t i = 0; i < row_; ++i) {
        row[i] = bytes[(static_cast<std::size_t>(v) * 131 + i + shift) % bytes.size()];
      }
    }
  }

 private:
  std::size_t row_;
  std::size_t stride_;
  std::unique_ptr<std::uint8_t[]> bytes_;  // NOLINT(*-avoid-c-arrays)
  cv::Mat image_;
};

double any_length_px(Bytes& bytes) {
  const int value = bytes.next();
  switch (value) {
    case 253:
      return std::numeric_limits<double>::quiet_NaN();
    case 254:
      return std::numeric_limits<double>::infinity();
    case 255:
      return -1.0;
    default:
      return value < 128 ? value / 16.0 : (value - 128) * 2.5;
  }
}

void draw_sgm(Bytes& bytes, skyhalo::SgmConfig& config) {
  config.p1 = bytes.below(20) - 1;
  config.p2_min = config.p1 + bytes.below(20) - 1;
  config.p2_max = config.p2_min + bytes.below(54) - 1;
  config.uniqueness_percent = bytes.below(103) - 1;
  config.left_right_px = any_length_px(bytes);
  config.texture_min_grey = bytes.next() * bytes.below(3) / 2;
  config.median_passes = bytes.below(6);
  config.fill_min_px = bytes.below(28);
  config.speckle_size_px = bytes.next() * bytes.next() - 1;
  config.speckle_step_px = any_length_px(bytes);
  config.edge_step_px = any_length_px(bytes);
}

void draw_opencv(Bytes& bytes, skyhalo::OpencvSgbmConfig& config) {
  constexpr int kPaths[] = {3, 5, 8, 4};  // NOLINT(*-avoid-c-arrays)
  config.block_px = bytes.below(14);
  config.paths = kPaths[bytes.below(4)];
  config.uniqueness_percent = bytes.below(103) - 1;
  config.left_right_px = bytes.below(10);
  config.speckle_size_px = bytes.next() - 1;
  config.speckle_range_px = bytes.below(40) - 1;
}

MatcherConfig draw_config(Bytes& bytes) {
  MatcherConfig config;
  const int kind = bytes.next();
  config.kind = kind % 8 == 7 ? skyhalo::MatcherKind::kOpencv : skyhalo::MatcherKind::kSgm;
  config.alignment = kind < 128 ? skyhalo::Alignment::kRight : skyhalo::Alignment::kLeft;
  const int range = bytes.next();
  config.max_disparity_px = range < 200 ? 16 * (range % 17) : 7 * (range - 220);
  if (bytes.below(3) != 0) {
    draw_sgm(bytes, config.sgm);
    draw_opencv(bytes, config.opencv);
  }
  return config;
}

cv::Size draw_size(Bytes& bytes) {
  const int width = bytes.next();
  const int height = bytes.next();
  return width > 250 ? cv::Size(200 + 20 * (width - 250), 1 + height % 5)
                     : cv::Size(1 + width % 90, 1 + height % 70);
}

/// Every disparity is one of the range, and its match a pixel of the other image.
void check_disparity(const cv::Mat1f& disparity, const MatcherConfig& config) {
  const bool right = config.alignment == skyhalo::Alignment::kRight;
  for (int v = 0; v < disparity.rows; ++v) {
    for (int u = 0; u < disparity.cols; ++u) {
      const float d_px = disparity(v, u);
      const float match_u = static_cast<float>(u) + (right ? d_px : -d_px);
      const bool good = d_px >= 0.0F && d_px < static_cast<float>(config.max_disparity_px) &&
                        match_u >= 0.0F && match_u <= static_cast<float>(disparity.cols - 1);
      if (!std::isnan(d_px) && !good) {
        std::abort();
      }
    }
  }
}

/// All but the one that works without vectors, which takes a second for what others do in a blink.
std::vector<std::int64_t> vector_targets() {
  std::vector<std::int64_t> targets = skyhalo::testing::InstructionSet::all();
  if (targets.size() > 1) {
    targets.pop_back();
  }
  return targets;
}

void match(Bytes& bytes) {
  constexpr int kTypes[] = {// NOLINT(*-avoid-c-arrays)
                            CV_8UC1,
                            CV_8UC1,
                            CV_8UC1,
                            CV_8UC1,
                            CV_16UC1,
                            CV_8UC3,
                            CV_16UC4,
                            CV_32FC1};
  static const std::vector<std::int64_t> targets = vector_targets();
  const skyhalo::testing::InstructionSet in_use(
      targets[static_cast<std::size_t>(bytes.next()) % targets.size()]);
  const MatcherConfig config = draw_config(bytes);
  const cv::Size size = draw_size(bytes);
  const int type = kTypes[bytes.below(8)];
  const bool other_size = bytes.next() == 255;
  TightImage left(size, type, bytes.below(40));
  TightImage right(other_size ? size + cv::Size(1, 0) : size, type, bytes.below(40));
  TightImage own_result(size, CV_32FC1, bytes.below(10));
  const int shift_px = bytes.below(64);
  left.fill(bytes.rest(), 0);
  right.fill(bytes.rest(), shift_px);
  skyhalo::Matcher matcher(config);
  cv::Mat1f disparity = own_result.image();
  matcher.match(left.image(), right.image(), disparity);
  if (disparity.data != own_result.image().data) {
    std::abort();
  }
  check_disparity(disparity, config);
  cv::Mat1f second;
  matcher.match(right.image(), left.image(), second);
  check_disparity(second, config);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  static const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  cv::setNumThreads(0);
  Bytes reader({bytes, size});
  try {
    match(reader);
  } catch (const skyhalo::Error&) {
    return 0;
  }
  return 0;
}

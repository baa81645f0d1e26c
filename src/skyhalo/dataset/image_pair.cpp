#include "skyhalo/dataset/image_pair.hpp"

#include <string>
#include <utility>

#include "skyhalo/base/error.hpp"
#include "skyhalo/io/image_file.hpp"

namespace skyhalo {
namespace {

void check_size(const std::filesystem::path& file, const cv::Size& size, const cv::Size& expected) {
  if (size != expected) {
    throw input_error(file,
                      "has " + std::to_string(size.width) + "x" + std::to_string(size.height) +
                          " pixels, expected " + std::to_string(expected.width) + "x" +
                          std::to_string(expected.height));
  }
}

}  // namespace

ImagePairSource::ImagePairSource(const std::filesystem::path& left,
                                 const std::filesystem::path& right,
                                 StereoPair pair)
    : images_{read_image(left), read_image(right)} {
  if (pair.image_size_px.empty()) {
    pair.image_size_px = images_.left.size();
  }
  check_size(left, images_.left.size(), left_image_size_px(pair));
  check_size(right, images_.right.size(), right_image_size_px(pair));
  rig_.pairs.push_back(std::move(pair));
}

FrameSet ImagePairSource::read(int) const {
  return {.stamp = {}, .pairs = {{images_.left.clone(), images_.right.clone()}}};
}

}  // namespace skyhalo

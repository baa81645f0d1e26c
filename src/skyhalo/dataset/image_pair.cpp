#include "skyhalo/dataset/image_pair.hpp"

#include <utility>

#include "skyhalo/base/error.hpp"
#include "skyhalo/io/image_file.hpp"

namespace skyhalo {

ImagePairSource::ImagePairSource(const std::filesystem::path& left,
                                 const std::filesystem::path& right,
                                 StereoPair pair)
    : images_{read_image(left), read_image(right)} {
  if (images_.left.size() != images_.right.size()) {
    throw input_error(right, "has another size than the left image");
  }
  pair.image_size_px = images_.left.size();
  rig_.pairs.push_back(std::move(pair));
}

FrameSet ImagePairSource::read(int) const {
  return {.stamp = {}, .pairs = {{images_.left.clone(), images_.right.clone()}}};
}

}  // namespace skyhalo

#include "fuzz_file.hpp"
#include "skyhalo/io/image_file.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  return skyhalo::fuzz::as_file(bytes, size, [](const std::filesystem::path& file) {
    const cv::Mat image = skyhalo::read_image(file);
    if (image.empty()) {
      std::abort();
    }
  });
}

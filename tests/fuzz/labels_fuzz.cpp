#include "fuzz_file.hpp"
#include "skyhalo/dataset/kitti_labels.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  return skyhalo::fuzz::as_file(bytes, size, [](const std::filesystem::path& file) {
    const skyhalo::TrackLabels labels(file);
    (void)labels.objects(labels.last_frame());
  });
}

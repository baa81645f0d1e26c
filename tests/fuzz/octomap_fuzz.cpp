#include "fuzz_file.hpp"
#include "skyhalo/io/octomap_file.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  constexpr std::uint64_t kMostBytes = std::uint64_t{64} << 20U;
  for (const skyhalo::OctreeForm form :
       {skyhalo::OctreeForm::kBinary, skyhalo::OctreeForm::kFull}) {
    skyhalo::fuzz::as_file(bytes, size, [form](const std::filesystem::path& file) {
      const skyhalo::SparseMap map = skyhalo::read_octomap(file, form, kMostBytes);
      if (map.memory_bytes() > kMostBytes) {
        std::abort();
      }
    });
  }
  return 0;
}

#include "fuzz_file.hpp"
#include "skyhalo/calibration/key_value_file.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  return skyhalo::fuzz::as_file(bytes, size, [](const std::filesystem::path& file) {
    const skyhalo::KeyValueFile values(file);
    for (const char* key : {"P_rect_00", "R", "T"}) {
      (void)values.numbers(key, 12);
    }
  });
}

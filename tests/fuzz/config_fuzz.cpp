#include "fuzz_file.hpp"
#include "skyhalo/config/config.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  return skyhalo::fuzz::as_file(bytes, size, [](const std::filesystem::path& file) {
    skyhalo::Config config;
    skyhalo::load_config(file, config);
    check(config);
  });
}

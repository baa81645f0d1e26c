#include <zstd.h>

#include <algorithm>
#include <string>
#include <string_view>

#include "fuzz_file.hpp"
#include "io/skymap_bytes.hpp"
#include "skyhalo/io/skymap_file.hpp"

namespace {

using skyhalo::testing::SkymapBytes;

/// The most memory that a map may take (bytes).
constexpr std::uint64_t kMostBytes = std::uint64_t{64} << 20U;

/// The bytes as one block of a file whose check sums are right, or nothing but the sums would be
/// tried: six bytes of counts, then the unpacked or the packed block.
std::string with_checksums(std::string_view bytes) {
  constexpr std::size_t kCounts = 6;
  const auto count = [&](std::size_t i) {
    return i < bytes.size() ? static_cast<unsigned char>(bytes[i]) : 0U;
  };
  const std::string rest(bytes.substr(std::min(kCounts, bytes.size())));
  SkymapBytes file;
  file.bricks = count(0) | count(1) << 8U;
  file.mixed = count(2);
  file.unpacked_bytes = skyhalo::skymap::unpacked_bytes(file.bricks, file.mixed);
  SkymapBytes::Block block{.unpacked = rest, .bricks = count(3) | count(4) << 8U};
  if (count(5) % 2 == 1) {
    block.packed = rest;
  }
  file.blocks.push_back(block);
  return file.bytes();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  const auto read = [](const std::filesystem::path& file) {
    const skyhalo::Skymap map = skyhalo::read_skymap(file, kMostBytes);
    if (map.map.memory_bytes() > kMostBytes) {
      std::abort();
    }
  };
  const std::string made(
      with_checksums(std::string_view(reinterpret_cast<const char*>(bytes), size)));
  skyhalo::fuzz::as_file(reinterpret_cast<const std::uint8_t*>(made.data()), made.size(), read);
  return skyhalo::fuzz::as_file(bytes, size, read);
}

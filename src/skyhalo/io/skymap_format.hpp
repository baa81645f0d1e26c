#pragma once

#include <zlib.h>

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

#include "skyhalo/map/brick.hpp"

// How a `.skymap` file lies on the disk, version 1. All numbers are little-endian.
//
//   header   92 bytes:  start mark (8 bytes), version (u32), bytes of the header (u32),
//                       lattice origin x y z and edge of a cell in metres (4 x f64),
//                       log odds of one unit (f64), limit of the log odds in units (i32),
//                       bricks in a block at most (u32), bricks (u64), bricks with cells of their
//                       own (u64), bytes of all blocks unpacked (u64),
//                       crc32 of all before (u32)
//   blocks              head of 16 bytes: bricks (u32), bytes unpacked (u32), bytes packed (u32),
//                       crc32 of the unpacked bytes (u32); then the packed bytes, one zstd frame:
//                       places (x y z, 3 x i32 each), kinds (u8 each: 0 = one value for all cells,
//                       1 = cells of their own), values (i16: one, or 512 with z fastest, then y)
//   end      28 bytes:  end mark (8 bytes), bricks (u64), bytes of all blocks as they lie in the
//                       file (u64), crc32 of those bytes (u32)
//
// Bricks are sorted by x, then y, then z; only the last block has fewer than the most. Log odds of
// -32768 are unknown; a brick without a known cell is not stored.

namespace skyhalo::skymap {

static_assert(std::endian::native == std::endian::little,
              "numbers are copied as they lie in memory");

/// Its bytes tell a file that was sent as text: a byte above 127, both kinds of line ends, and the
/// end of a text file in DOS.
inline constexpr std::string_view kStart("\x89SKY\r\n\x1a\n", 8);
inline constexpr std::string_view kEnd("\x89YKS\r\n\x1a\n", 8);
inline constexpr std::uint32_t kVersion = 1;
inline constexpr std::size_t kHeaderBytes = 92;
inline constexpr std::size_t kBlockHeadBytes = 16;
inline constexpr std::size_t kEndBytes = 28;

inline constexpr std::uint32_t kMostBricksInBlock = 512;
inline constexpr std::size_t kPlaceBytes = 3 * sizeof(std::int32_t) + 1;  // with its kind
inline constexpr std::size_t kUniformBytes = sizeof(LogOdds);
inline constexpr std::size_t kMixedBytes = kBrickCells * sizeof(LogOdds);
inline constexpr std::size_t kMostBlockBytes = kMostBricksInBlock * (kPlaceBytes + kMixedBytes);

/// Bytes of bricks in unpacked blocks.
constexpr std::uint64_t unpacked_bytes(std::uint64_t bricks, std::uint64_t mixed) noexcept {
  return bricks * kPlaceBytes + (bricks - mixed) * kUniformBytes + mixed * kMixedBytes;
}

inline std::uint32_t checksum(std::string_view bytes, std::uint32_t before = 0) noexcept {
  return static_cast<std::uint32_t>(
      ::crc32_z(before, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

template <class Number>
void append(std::string& bytes, Number value) {
  std::array<char, sizeof(Number)> raw{};
  std::memcpy(raw.data(), &value, raw.size());
  bytes.append(raw.data(), raw.size());
}

/// Takes numbers off the front of bytes, of which there must be enough.
class Taker {
 public:
  explicit Taker(std::string_view bytes) : bytes_(bytes) {}

  template <class Number>
  [[nodiscard]] Number take() noexcept {
    Number value{};
    std::memcpy(&value, bytes_.data(), sizeof(value));
    bytes_.remove_prefix(sizeof(value));
    return value;
  }

  /// The next bytes, as they are.
  [[nodiscard]] std::string_view take_bytes(std::size_t count) noexcept {
    const std::string_view taken = bytes_.substr(0, count);
    bytes_.remove_prefix(count);
    return taken;
  }

 private:
  std::string_view bytes_;
};

}  // namespace skyhalo::skymap

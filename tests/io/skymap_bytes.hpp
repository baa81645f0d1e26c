#pragma once

#include <zstd.h>

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "skyhalo/io/skymap_format.hpp"

namespace skyhalo::testing {

/// A `.skymap` file put together field by field, right or wrong, with right check sums.
struct SkymapBytes {
  struct Block {
    std::string unpacked;
    std::uint32_t bricks = 0;
    std::string packed = {};           ///< instead of the unpacked bytes, packed
    std::uint32_t unpacked_bytes = 0;  ///< claimed; 0: the right number
    std::uint32_t packed_bytes = 0;    ///< claimed; 0: the right number
  };

  std::string start{skymap::kStart};
  std::uint32_t version = 1;
  std::uint32_t header_bytes = 92;
  double origin_m[3] = {0.0, 0.0, 0.0};  // NOLINT(*-avoid-c-arrays)
  double voxel_m = 0.5;
  double unit = 0.001;
  std::int32_t limit = 5000;
  std::uint32_t most_bricks = 512;
  std::uint64_t bricks = 0;
  std::uint64_t mixed = 0;
  std::uint64_t unpacked_bytes = 0;
  std::vector<Block> blocks = {};

  [[nodiscard]] std::string header() const {
    std::string bytes = start;
    skymap::append(bytes, version);
    skymap::append(bytes, header_bytes);
    for (const double x : {origin_m[0], origin_m[1], origin_m[2], voxel_m, unit}) {
      skymap::append(bytes, x);
    }
    skymap::append(bytes, limit);
    skymap::append(bytes, most_bricks);
    skymap::append(bytes, bricks);
    skymap::append(bytes, mixed);
    skymap::append(bytes, unpacked_bytes);
    skymap::append(bytes, skymap::checksum(bytes));
    return bytes;
  }

  [[nodiscard]] static std::string pack(std::string_view unpacked) {
    std::string packed(ZSTD_compressBound(unpacked.size()), '\0');
    packed.resize(ZSTD_compress(packed.data(), packed.size(), unpacked.data(), unpacked.size(), 1));
    return packed;
  }

  [[nodiscard]] std::string bytes() const {
    std::string payload;
    for (const Block& block : blocks) {
      const std::string packed = block.packed.empty() ? pack(block.unpacked) : block.packed;
      skymap::append(payload, block.bricks);
      skymap::append(payload,
                     block.unpacked_bytes != 0 ? block.unpacked_bytes
                                               : static_cast<std::uint32_t>(block.unpacked.size()));
      skymap::append(
          payload,
          block.packed_bytes != 0 ? block.packed_bytes : static_cast<std::uint32_t>(packed.size()));
      skymap::append(payload, skymap::checksum(block.unpacked));
      payload += packed;
    }
    std::string all = header() + payload + std::string(skymap::kEnd);
    skymap::append(all, bricks);
    skymap::append(all, static_cast<std::uint64_t>(payload.size()));
    skymap::append(all, skymap::checksum(payload));
    return all;
  }

  /// One brick's place.
  [[nodiscard]] static std::string place(std::int32_t x, std::int32_t y, std::int32_t z) {
    std::string bytes;
    skymap::append(bytes, x);
    skymap::append(bytes, y);
    skymap::append(bytes, z);
    return bytes;
  }

  [[nodiscard]] static std::string value(LogOdds log_odds) {
    std::string bytes;
    skymap::append(bytes, log_odds);
    return bytes;
  }

  /// A file of one block with uniform bricks at these places.
  [[nodiscard]] static SkymapBytes of_uniform(const std::vector<std::string>& places) {
    const auto count = static_cast<std::uint32_t>(places.size());
    Block block{.unpacked = "", .bricks = count};
    for (const std::string& one : places) {
      block.unpacked += one;
    }
    block.unpacked += std::string(count, '\0');
    for (std::uint32_t i = 0; i < count; ++i) {
      block.unpacked += value(1000);
    }
    SkymapBytes file;
    file.bricks = count;
    file.unpacked_bytes = block.unpacked.size();
    file.blocks.push_back(std::move(block));
    return file;
  }
};

}  // namespace skyhalo::testing

#include <zstd.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "skyhalo/base/error.hpp"
#include "skyhalo/base/number_text.hpp"
#include "skyhalo/io/map_lattice.hpp"
#include "skyhalo/io/skymap_file.hpp"
#include "skyhalo/io/skymap_format.hpp"

namespace skyhalo {
namespace {

using namespace skymap;  // NOLINT(*-using-namespace): the format's own names

struct ContextDeleter {
  void operator()(ZSTD_DCtx* context) const noexcept { ZSTD_freeDCtx(context); }
};

struct BlockHead {
  std::uint32_t bricks = 0;
  std::uint32_t unpacked = 0;
  std::uint32_t packed = 0;
  std::uint32_t checksum = 0;
};

/// Places that a brick of numbered cells can have.
bool is_brick(const Eigen::Vector3i& place) {
  constexpr int kReach = VoxelLattice::kReach / kBrickEdge;
  return (place.array() >= -kReach).all() && (place.array() < kReach).all();
}

class SkymapReader {
 public:
  SkymapReader(const std::filesystem::path& file, std::uint64_t max_bytes)
      : file_(file), max_bytes_(max_bytes), context_(ZSTD_createDCtx()) {
    std::error_code ignored;
    if (!std::filesystem::exists(file, ignored)) {
      throw fault("no such file");
    }
    if (!std::filesystem::is_regular_file(file, ignored)) {
      throw fault("is no regular file, expected a .skymap file");
    }
    stream_.open(file, std::ios::binary);
    if (!stream_) {
      throw fault("cannot be read");
    }
    if (context_ == nullptr) {
      throw std::bad_alloc();
    }
  }

  Skymap read(const Progress& progress) {
    const SkymapHeader header = read_header();
    Skymap result{.map = SparseMap(header.lattice), .info = header.info};
    while (bricks_ < header.bricks) {
      read_block(header, result.map);
      if (progress) {
        progress(static_cast<double>(bricks_) / static_cast<double>(header.bricks));
      }
    }
    read_end(header);
    if (mixed_ != header.mixed || result.map.brick_count() != header.bricks) {
      throw fault("is damaged: its bricks are not those that its header counts");
    }
    return result;
  }

  SkymapHeader read_header() {
    const std::string_view bytes = next(buffer_, kHeaderBytes);
    check_start(bytes);
    Taker taker(bytes);
    (void)taker.take_bytes(kStart.size());
    if (bytes.size() >= kStart.size() + sizeof(kVersion)) {
      if (const auto version = taker.take<std::uint32_t>(); version != kVersion) {
        throw fault("is a .skymap file of version " + std::to_string(version) +
                    ", expected version " + std::to_string(kVersion));
      }
    }
    if (bytes.size() < kHeaderBytes) {
      throw fault("is cut off in its header");
    }
    const std::size_t checked = kHeaderBytes - sizeof(std::uint32_t);
    if (Taker(bytes.substr(checked)).take<std::uint32_t>() != checksum(bytes.substr(0, checked))) {
      throw fault("is damaged: the check sum of its header does not match");
    }
    return parse_header(taker);
  }

 private:
  [[nodiscard]] Error fault(const std::string& what) const { return input_error(file_, what); }

  [[nodiscard]] Error block_fault(const std::string& what) const {
    return fault("is damaged: the block after " + std::to_string(bricks_) + " bricks " + what);
  }

  /// The next bytes of the file.
  std::string_view next(std::string& buffer, std::size_t count) {
    buffer.resize(count);
    stream_.read(buffer.data(), static_cast<std::streamsize>(count));
    const auto got = static_cast<std::size_t>(stream_.gcount());
    if (stream_.bad()) {
      throw fault("cannot be read");
    }
    return std::string_view(buffer).substr(0, got);
  }

  /// The next bytes of the file, all of them.
  std::string_view need(std::string& buffer, std::size_t count) {
    const std::string_view bytes = next(buffer, count);
    if (bytes.size() < count) {
      throw fault("is cut off: it ends after " + std::to_string(bricks_) + " bricks");
    }
    return bytes;
  }

  /// The next bytes of the blocks.
  std::string_view need_checked(std::string& buffer, std::size_t count) {
    const std::string_view bytes = need(buffer, count);
    block_bytes_ += count;
    checksum_ = checksum(bytes, checksum_);
    return bytes;
  }

  void check_start(std::string_view bytes) const {
    if (bytes.starts_with(kStart)) {
      return;
    }
    if (kStart.starts_with(bytes)) {
      throw fault(bytes.empty() ? "is empty, expected a .skymap file" : "is cut off in its header");
    }
    if (bytes.substr(1).starts_with(kStart.substr(1, 3))) {
      throw fault("is damaged: it seems to have been sent as text, with its line ends changed");
    }
    throw fault("is no .skymap file: its first bytes are others");
  }

  SkymapHeader parse_header(Taker& taker) const {
    if (taker.take<std::uint32_t>() != kHeaderBytes) {
      throw fault("has a header of another length than version 1 has");
    }
    SkymapHeader header;
    for (const int axis : {0, 1, 2}) {
      header.lattice.origin_m[axis] = taker.take<double>();
    }
    header.lattice.voxel_m = taker.take<double>();
    if (const std::string what = lattice_fault(header.lattice); !what.empty()) {
      throw fault(what);
    }
    if (const auto unit = taker.take<double>(); unit != kLogOddsPerUnit) {
      throw fault("has log odds in units of " + number_text("%g", unit) + ", expected 0.001");
    }
    header.info.limit_units = taker.take<std::int32_t>();
    if (header.info.limit_units < 1 || header.info.limit_units > -1 - kUnknown) {
      throw fault("limits log odds to " + std::to_string(header.info.limit_units) +
                  " units, expected 1 to 32767");
    }
    if (taker.take<std::uint32_t>() != kMostBricksInBlock) {
      throw fault("has blocks of another size than version 1 has");
    }
    header.bricks = taker.take<std::uint64_t>();
    header.mixed = taker.take<std::uint64_t>();
    if (!fits_in_memory(header.bricks, header.mixed, max_bytes_)) {
      throw fault(too_large_text(max_bytes_));
    }
    if (header.mixed > header.bricks ||
        taker.take<std::uint64_t>() != unpacked_bytes(header.bricks, header.mixed)) {
      throw fault("is damaged: the counts in its header contradict each other");
    }
    return header;
  }

  BlockHead read_head(const SkymapHeader& header) {
    Taker taker(need_checked(buffer_, kBlockHeadBytes));
    BlockHead head;
    head.bricks = taker.take<std::uint32_t>();
    head.unpacked = taker.take<std::uint32_t>();
    head.packed = taker.take<std::uint32_t>();
    head.checksum = taker.take<std::uint32_t>();
    const std::uint64_t expected =
        std::min<std::uint64_t>(kMostBricksInBlock, header.bricks - bricks_);
    if (head.bricks != expected) {
      throw block_fault("counts " + std::to_string(head.bricks) + " bricks, expected " +
                        std::to_string(expected));
    }
    if (head.unpacked > unpacked_bytes(head.bricks, head.bricks) ||
        head.packed > ZSTD_compressBound(head.unpacked)) {
      throw block_fault("claims more bytes than its bricks can have");
    }
    return head;
  }

  void read_block(const SkymapHeader& header, SparseMap& map) {
    const BlockHead head = read_head(header);
    const std::string_view packed = need_checked(buffer_, head.packed);
    unpacked_.resize(head.unpacked);
    const std::size_t size = ZSTD_decompressDCtx(
        context_.get(), unpacked_.data(), unpacked_.size(), packed.data(), packed.size());
    if (ZSTD_isError(size) != 0 || size != head.unpacked) {
      throw block_fault("cannot be unpacked to the bytes that it claims");
    }
    if (checksum(unpacked_) != head.checksum) {
      throw block_fault("does not match its check sum");
    }
    store_bricks(header, head.bricks, map);
  }

  void store_bricks(const SkymapHeader& header, std::uint32_t count, SparseMap& map) {
    const std::string_view bytes = unpacked_;
    if (bytes.size() < count * kPlaceBytes) {
      throw block_fault("is shorter than its bricks");
    }
    Taker places(bytes);
    const std::string_view kinds = bytes.substr(count * (kPlaceBytes - 1), count);
    const auto mixed = static_cast<std::uint64_t>(std::count(kinds.begin(), kinds.end(), '\1'));
    mixed_ += mixed;
    if (std::count(kinds.begin(), kinds.end(), '\0') + static_cast<std::int64_t>(mixed) != count ||
        bytes.size() != unpacked_bytes(count, mixed) || mixed_ > header.mixed) {
      throw block_fault("has bricks of other kinds than it has bytes for");
    }
    Taker values(bytes.substr(count * kPlaceBytes));
    for (const char kind : kinds) {
      const Eigen::Vector3i place = next_place(places);
      if (kind == '\0') {
        store_uniform(place, values.take<LogOdds>(), map);
      } else {
        map.set_brick(place, {values.take<std::array<LogOdds, kBrickCells>>()});
      }
      ++bricks_;
    }
  }

  void store_uniform(const Eigen::Vector3i& place, LogOdds value, SparseMap& map) const {
    if (value == kUnknown) {
      throw block_fault("has a brick without a known cell");
    }
    map.set_uniform(place, value);
  }

  Eigen::Vector3i next_place(Taker& places) {
    Eigen::Vector3i place;
    for (const int axis : {0, 1, 2}) {
      place[axis] = places.take<std::int32_t>();
    }
    if (!is_brick(place)) {
      throw block_fault("has a brick beyond the cells that can be numbered");
    }
    if (bricks_ > 0 && !before(last_place_, place)) {
      throw block_fault("has bricks that are not sorted, or one twice");
    }
    last_place_ = place;
    return place;
  }

  void read_end(const SkymapHeader& header) {
    Taker taker(need(buffer_, kEndBytes));
    if (taker.take_bytes(kEnd.size()) != kEnd || taker.take<std::uint64_t>() != header.bricks ||
        taker.take<std::uint64_t>() != block_bytes_ || taker.take<std::uint32_t>() != checksum_) {
      throw fault("is damaged: its end does not match what comes before");
    }
    if (stream_.peek() != std::ifstream::traits_type::eof()) {
      throw fault("is damaged: bytes follow its end");
    }
  }

  const std::filesystem::path& file_;
  std::uint64_t max_bytes_;
  std::unique_ptr<ZSTD_DCtx, ContextDeleter> context_;
  std::ifstream stream_;
  std::string buffer_;
  std::string unpacked_;
  Eigen::Vector3i last_place_ = Eigen::Vector3i::Zero();
  std::uint64_t bricks_ = 0;
  std::uint64_t mixed_ = 0;
  std::uint64_t block_bytes_ = 0;
  std::uint32_t checksum_ = 0;
};

}  // namespace

Skymap read_skymap(const std::filesystem::path& file,
                   std::uint64_t max_bytes,
                   const Progress& progress) {
  return SkymapReader(file, max_bytes).read(progress);
}

SkymapHeader read_skymap_header(const std::filesystem::path& file, std::uint64_t max_bytes) {
  return SkymapReader(file, max_bytes).read_header();
}

}  // namespace skyhalo

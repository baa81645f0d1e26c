#include <zstd.h>

#include <algorithm>
#include <cerrno>
#include <fstream>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "skyhalo/base/error.hpp"
#include "skyhalo/io/skymap_file.hpp"
#include "skyhalo/io/skymap_format.hpp"

namespace skyhalo {
namespace {

using namespace skymap;  // NOLINT(*-using-namespace): the format's own names

struct ContextDeleter {
  void operator()(ZSTD_CCtx* context) const noexcept { ZSTD_freeCCtx(context); }
};

std::string header_of(const SparseMap& map,
                      const SkymapInfo& info,
                      std::uint64_t bricks,
                      std::uint64_t mixed) {
  std::string header(kStart);
  append(header, kVersion);
  append(header, static_cast<std::uint32_t>(kHeaderBytes));
  for (const double x : {map.lattice().origin_m.x(),
                         map.lattice().origin_m.y(),
                         map.lattice().origin_m.z(),
                         map.lattice().voxel_m,
                         kLogOddsPerUnit}) {
    append(header, x);
  }
  append(header, static_cast<std::int32_t>(info.limit_units));
  append(header, kMostBricksInBlock);
  append(header, bricks);
  append(header, mixed);
  append(header, unpacked_bytes(bricks, mixed));
  append(header, checksum(header));
  return header;
}

/// A brick as it is stored: by its cells, not by how the map holds it.
struct StoredBrick {
  Eigen::Vector3i place;
  std::optional<LogOdds> uniform;  // none: it has cells of its own
};

using Bricks = std::span<const StoredBrick>;

/// The bricks that have a known cell, sorted.
std::vector<StoredBrick> stored_bricks(const SparseMap& map) {
  std::vector<StoredBrick> bricks;
  bricks.reserve(map.brick_count());
  BrickCells cells;  // NOLINT(cppcoreguidelines-pro-type-member-init): filled by the map
  for (const Eigen::Vector3i& place : map.bricks()) {
    std::optional<LogOdds> value = map.uniform(place);
    if (!value) {
      map.copy_brick(place, cells);
      const auto is_first = [&](LogOdds cell) { return cell == cells.cells.front(); };
      if (std::all_of(cells.cells.begin(), cells.cells.end(), is_first)) {
        value = cells.cells.front();
      }
    }
    if (value != kUnknown) {
      bricks.push_back({place, value});
    }
  }
  return bricks;
}

/// The unpacked bytes of a block.
void fill_block(const SparseMap& map, Bricks bricks, std::string& bytes) {
  bytes.clear();
  for (const StoredBrick& brick : bricks) {
    for (const int x : {brick.place.x(), brick.place.y(), brick.place.z()}) {
      append(bytes, static_cast<std::int32_t>(x));
    }
  }
  for (const StoredBrick& brick : bricks) {
    bytes.push_back(brick.uniform ? '\0' : '\1');
  }
  BrickCells cells;  // NOLINT(cppcoreguidelines-pro-type-member-init): filled by the map
  for (const StoredBrick& brick : bricks) {
    if (brick.uniform) {
      append(bytes, *brick.uniform);
    } else {
      map.copy_brick(brick.place, cells);
      append(bytes, cells.cells);
    }
  }
}

/// Writes blocks and counts what it writes.
class BlockWriter {
 public:
  BlockWriter() : context_(ZSTD_createCCtx()), packed_(ZSTD_compressBound(kMostBlockBytes), '\0') {
    if (context_ == nullptr) {
      throw std::bad_alloc();
    }
  }

  void write(const SparseMap& map, Bricks bricks, std::ostream& stream) {
    constexpr int kLevel = 3;
    fill_block(map, bricks, raw_);
    const std::size_t size = ZSTD_compressCCtx(
        context_.get(), packed_.data(), packed_.size(), raw_.data(), raw_.size(), kLevel);
    if (ZSTD_isError(size) != 0) {
      throw Error(ErrorKind::kFailure,
                  std::string("a map cannot be packed: ") + ZSTD_getErrorName(size));
    }
    std::string head;
    append(head, static_cast<std::uint32_t>(bricks.size()));
    append(head, static_cast<std::uint32_t>(raw_.size()));
    append(head, static_cast<std::uint32_t>(size));
    append(head, checksum(raw_));
    write(head, stream);
    write(std::string_view(packed_).substr(0, size), stream);
  }

  [[nodiscard]] std::string end_of(std::uint64_t bricks) const {
    std::string end(kEnd);
    append(end, bricks);
    append(end, written_);
    append(end, checksum_);
    return end;
  }

 private:
  void write(std::string_view bytes, std::ostream& stream) {
    stream.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    written_ += bytes.size();
    checksum_ = checksum(bytes, checksum_);
  }

  std::unique_ptr<ZSTD_CCtx, ContextDeleter> context_;
  std::string raw_;
  std::string packed_;
  std::uint64_t written_ = 0;
  std::uint32_t checksum_ = 0;
};

void check_writable(const std::filesystem::path& file,
                    const SparseMap& map,
                    const SkymapInfo& info) {
  if (const std::string fault = lattice_fault(map.lattice()); !fault.empty()) {
    throw input_error(file, "the map " + fault);
  }
  if (info.limit_units < 1 || info.limit_units > -1 - kUnknown) {
    throw input_error(file,
                      "the limit of the log odds is " + std::to_string(info.limit_units) +
                          " units, expected 1 to 32767");
  }
}

}  // namespace

void write_skymap(const std::filesystem::path& file,
                  const SparseMap& map,
                  const SkymapInfo& info,
                  const Progress& progress,
                  Leftovers leftovers) {
  check_writable(file, map, info);
  const std::vector<StoredBrick> bricks = stored_bricks(map);
  const auto mixed = std::count_if(
      bricks.begin(), bricks.end(), [](const StoredBrick& brick) { return !brick.uniform; });
  UnfinishedFile unfinished(file, leftovers);
  errno = 0;
  std::ofstream stream(unfinished.path(), std::ios::binary);
  stream << header_of(map, info, bricks.size(), static_cast<std::uint64_t>(mixed));
  BlockWriter blocks;
  for (std::size_t from = 0; from < bricks.size() && stream; from += kMostBricksInBlock) {
    const std::size_t count = std::min<std::size_t>(kMostBricksInBlock, bricks.size() - from);
    blocks.write(map, Bricks(bricks).subspan(from, count), stream);
    if (progress) {
      progress(static_cast<double>(from + count) / static_cast<double>(bricks.size()));
    }
  }
  stream << blocks.end_of(bricks.size());
  unfinished.commit(stream);
}

}  // namespace skyhalo

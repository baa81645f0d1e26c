// Its templates print what they do unless told not to.
#define OCTOMAP_NODEBUGOUT
#include <octomap/OcTree.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <istream>
#include <optional>
#include <streambuf>
#include <string>
#include <string_view>
#include <system_error>

#include "skyhalo/base/error.hpp"
#include "skyhalo/io/octomap_file.hpp"

namespace skyhalo {
namespace {

constexpr int kKeyOfZero = 32768;
constexpr unsigned kTreeDepth = 16;

/// Bytes as a stream, without a copy.
class BytesBuffer : public std::streambuf {
 public:
  explicit BytesBuffer(std::string_view bytes) {
    char* const first = const_cast<char*>(bytes.data());  // only ever read
    setg(first, first, first + bytes.size());
  }
};

std::string read_whole(const std::filesystem::path& file, std::uint64_t max_bytes) {
  std::error_code status;
  if (!std::filesystem::exists(file, status)) {
    throw input_error(file, "no such file");
  }
  if (!std::filesystem::is_regular_file(file, status)) {
    throw input_error(file, "is no regular file, expected an OctoMap file");
  }
  const std::uintmax_t size = std::filesystem::file_size(file, status);
  if (status || size > max_bytes) {
    throw input_error(file, status ? "cannot be read" : too_large_text(max_bytes));
  }
  std::string bytes(size, '\0');
  std::ifstream stream(file, std::ios::binary);
  stream.read(bytes.data(), static_cast<std::streamsize>(size));
  if (!stream) {
    throw input_error(file, "cannot be read");
  }
  return bytes;
}

/// Throws if file, octree and map together would take more than `max_bytes`.
void check_memory(const std::filesystem::path& file,
                  const OctreeShape& shape,
                  std::uint64_t file_bytes,
                  std::uint64_t max_bytes) {
  constexpr std::uint64_t kPerNode = 32;   // 16 bytes, and what the allocator adds
  constexpr std::uint64_t kPerInner = 80;  // the list of children
  const std::uint64_t tree = shape.nodes * kPerNode + shape.inner_nodes * kPerInner + file_bytes;
  if (tree > max_bytes ||
      !fits_in_memory(
          shape.uniform_bricks + shape.mixed_bricks, shape.mixed_bricks, max_bytes - tree)) {
    throw input_error(file, too_large_text(max_bytes));
  }
}

LogOdds units_of(float log_odds) {
  constexpr double kMost = -1.0 - kUnknown;
  return static_cast<LogOdds>(
      std::lround(std::clamp(static_cast<double>(log_odds) / kLogOddsPerUnit, -kMost, kMost)));
}

/// Gathers the cells of a brick; an octree's leaves come brick after brick.
class BrickFiller {
 public:
  explicit BrickFiller(SparseMap& map) : map_(map) {}

  /// A cube of equal cells that is smaller than a brick.
  void fill(const Eigen::Vector3i& first, int edge, LogOdds value) {
    if (!brick_ || *brick_ != brick_of(first)) {
      flush();
      brick_ = brick_of(first);
      cells_.cells.fill(kUnknown);
    }
    for (int x = 0; x < edge; ++x) {
      for (int y = 0; y < edge; ++y) {
        auto* const row = cells_.cells.data() + place_in_brick(first + Eigen::Vector3i(x, y, 0));
        std::fill_n(row, edge, value);
      }
    }
  }

  void flush() {
    if (brick_) {
      map_.set_brick(*brick_, cells_);
    }
  }

 private:
  SparseMap& map_;
  std::optional<Eigen::Vector3i> brick_;
  BrickCells cells_{};
};

void fill_bricks(SparseMap& map, const CellBox& bricks, LogOdds value) {
  for (int x = bricks.min.x(); x < bricks.max.x(); ++x) {
    for (int y = bricks.min.y(); y < bricks.max.y(); ++y) {
      for (int z = bricks.min.z(); z < bricks.max.z(); ++z) {
        map.set_uniform({x, y, z}, value);
      }
    }
  }
}

SparseMap to_map(const octomap::OcTree& tree) {
  SparseMap map({.voxel_m = tree.getResolution()});
  BrickFiller filler(map);
  for (auto leaf = tree.begin_leafs(), end = tree.end_leafs(); leaf != end; ++leaf) {
    const octomap::OcTreeKey key = leaf.getIndexKey();
    const Eigen::Vector3i first = Eigen::Vector3i(key[0], key[1], key[2]).array() - kKeyOfZero;
    const int edge = 1 << (kTreeDepth - leaf.getDepth());
    const LogOdds value = units_of(leaf->getLogOdds());
    if (edge < kBrickEdge) {
      filler.fill(first, edge, value);
    } else {
      fill_bricks(map, bricks_touching({first, first.array() + edge}), value);
    }
  }
  filler.flush();
  return map;
}

}  // namespace

SparseMap read_octomap(const std::filesystem::path& file,
                       OctreeForm form,
                       std::uint64_t max_bytes) {
  const std::string bytes = read_whole(file, max_bytes);
  const OctreeShape shape = check_octree(file, bytes, form);
  check_memory(file, shape, bytes.size(), max_bytes);
  octomap::OcTree tree(shape.voxel_m);
  if (shape.nodes > 0) {
    BytesBuffer buffer(std::string_view(bytes).substr(shape.data_from));
    std::istream stream(&buffer);
    form == OctreeForm::kBinary ? tree.readBinaryData(stream) : tree.readData(stream);
    if (!stream || tree.size() != shape.nodes) {
      throw input_error(file, "is damaged: OctoMap does not read the tree that it holds");
    }
  }
  return to_map(tree);
}

}  // namespace skyhalo

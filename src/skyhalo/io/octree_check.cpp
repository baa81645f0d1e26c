#include "skyhalo/io/octree_check.hpp"

#include <array>
#include <bitset>
#include <charconv>
#include <cmath>
#include <cstring>
#include <optional>
#include <string>
#include <vector>

#include "skyhalo/base/error.hpp"
#include "skyhalo/io/map_limits.hpp"
#include "skyhalo/io/text_file.hpp"

namespace skyhalo {
namespace {

constexpr int kMostDepth = 16;
constexpr int kBrickDepth = 13;  // where a node covers 8 x 8 x 8 cells
constexpr int kChildren = 8;

constexpr std::string_view kBinaryStart = "# Octomap OcTree binary file";
constexpr std::string_view kFullStart = "# Octomap OcTree file";

/// What the header's lines say.
struct Header {
  std::optional<std::string> id;
  std::optional<std::uint64_t> size;
  std::optional<double> voxel_m;
};

std::optional<std::uint64_t> parse_count(std::string_view word) {
  std::uint64_t value = 0;
  const auto [end, status] = std::from_chars(word.data(), word.data() + word.size(), value);
  return status == std::errc() && end == word.data() + word.size() ? std::optional(value)
                                                                   : std::nullopt;
}

class HeaderReader {
 public:
  HeaderReader(const std::filesystem::path& file, std::string_view bytes)
      : file_(file), bytes_(bytes) {}

  OctreeShape read(OctreeForm form) {
    check_start(form);
    Header header;
    std::vector<std::string_view> words;
    do {
      words = split_words(next_line());
      store(words, header);
    } while (words.empty() || words.front() != "data");
    return shape_of(header);
  }

 private:
  [[nodiscard]] Error fault(const std::string& what) const {
    return line_ > 0 ? input_error(file_, line_, what) : input_error(file_, what);
  }

  void check_start(OctreeForm form) const {
    const bool binary = form == OctreeForm::kBinary;
    if (bytes_.starts_with(binary ? kBinaryStart : kFullStart)) {
      return;
    }
    if (bytes_.empty()) {
      throw fault("is empty, expected an OctoMap file");
    }
    if (bytes_.starts_with(binary ? kFullStart : kBinaryStart)) {
      throw fault(binary ? "holds a tree with log odds, which is called .ot, not .bt"
                         : "holds a tree without log odds, which is called .bt, not .ot");
    }
    throw fault(std::string("is no OctoMap file: expected the first line \"") +
                std::string(binary ? kBinaryStart : kFullStart) + "\"");
  }

  std::string_view next_line() {
    const std::size_t end = bytes_.find('\n', at_);
    if (end == std::string_view::npos) {
      line_ = 0;
      throw fault("is cut off: the line \"data\" of its header is missing");
    }
    std::string_view line = bytes_.substr(at_, end - at_);
    at_ = end + 1;
    ++line_;
    if (line.ends_with('\r')) {
      line.remove_suffix(1);
    }
    return line;
  }

  template <class Value>
  void store_once(std::string_view key, std::optional<Value> value, std::optional<Value>& to) {
    if (!value) {
      throw fault(std::string(key) + ": expected one number above 0");
    }
    if (to) {
      throw fault(std::string(key) + " is there twice");
    }
    to = value;
  }

  void store(const std::vector<std::string_view>& words, Header& header) {
    if (words.empty() || words.front().starts_with('#')) {
      return;
    }
    const std::string_view key = words.front();
    const std::string_view value = words.size() == 2 ? words[1] : std::string_view();
    if (key == "id") {
      store_once(key, std::optional(std::string(value)), header.id);
    } else if (key == "size") {
      store_once(key, parse_count(value), header.size);
    } else if (key == "res") {
      store_once(key, parse_number(value), header.voxel_m);
    } else if (key != "data") {
      throw fault("expected id, size, res or data");
    }
  }

  OctreeShape shape_of(const Header& header) {
    line_ = 0;
    if (header.id != "OcTree") {
      throw fault(header.id ? "holds a tree of another kind (id " + printable(*header.id) +
                                  "), expected id OcTree"
                            : "does not say what tree it holds, expected id OcTree");
    }
    if (!header.size || !header.voxel_m) {
      throw fault(std::string("its header has no ") + (header.size ? "res" : "size"));
    }
    if (const std::string what = lattice_fault({.voxel_m = *header.voxel_m}); !what.empty()) {
      throw fault(what);
    }
    return {.voxel_m = *header.voxel_m, .data_from = at_, .nodes = *header.size};
  }

  /// A word for a message.
  static std::string printable(std::string_view word) {
    constexpr std::size_t kLongest = 40;
    std::string text(word.substr(0, kLongest));
    for (char& c : text) {
      c = c > ' ' && c <= '~' ? c : '?';
    }
    return text;
  }

  const std::filesystem::path& file_;
  std::string_view bytes_;
  std::size_t at_ = 0;
  int line_ = 0;
};

/// Walks down the nodes in the order in which they lie in the file. No deeper than the octree is.
class NodeWalk {
 public:
  NodeWalk(const std::filesystem::path& file, std::string_view data, OctreeShape& shape)
      : file_(file), data_(data), shape_(shape) {}

  void run(OctreeForm form) {
    const std::uint64_t expected = shape_.nodes;
    shape_.nodes = 0;
    if (expected > 0) {
      count_node();
      form == OctreeForm::kBinary ? walk_binary(0) : walk_full(0);
    }
    if (at_ != data_.size()) {
      throw fault(std::to_string(data_.size() - at_) + " bytes follow the end of the tree");
    }
    if (shape_.nodes != expected) {
      throw fault("the tree has " + std::to_string(shape_.nodes) + " nodes, expected " +
                  std::to_string(expected));
    }
  }

 private:
  [[nodiscard]] Error fault(const std::string& what) const {
    return input_error(file_, "is damaged: " + what);
  }

  const char* take(std::size_t count) {
    if (data_.size() - at_ < count) {
      throw fault("it is cut off after " + std::to_string(shape_.nodes) + " nodes");
    }
    at_ += count;
    return data_.data() + at_ - count;
  }

  void count_node() { ++shape_.nodes; }

  void count_inner(int depth) {
    if (depth >= kMostDepth) {
      throw fault("the tree has more than 16 levels");
    }
    ++shape_.inner_nodes;
    shape_.mixed_bricks += depth == kBrickDepth ? 1 : 0;
  }

  void count_leaf(int depth) {
    if (depth <= kBrickDepth) {
      shape_.uniform_bricks += std::uint64_t{1} << static_cast<unsigned>(3 * (kBrickDepth - depth));
    }
  }

  /// An inner node: two bits for each child, of which both mean that it has children itself.
  void walk_binary(int depth) {  // NOLINT(misc-no-recursion): at most 16 deep
    count_inner(depth);
    const char* const bytes = take(2);
    const unsigned codes = static_cast<unsigned char>(bytes[0]) |
                           static_cast<unsigned>(static_cast<unsigned char>(bytes[1])) << 8U;
    if (codes == 0) {
      throw fault("a node that should have children has none");
    }
    constexpr unsigned kInner = 3;
    for (unsigned child = 0; child < kChildren; ++child) {
      const unsigned code = codes >> (2 * child) & kInner;
      if (code != 0) {
        count_node();
        if (code != kInner) {
          count_leaf(depth + 1);
        }
      }
    }
    for (unsigned child = 0; child < kChildren; ++child) {
      if ((codes >> (2 * child) & kInner) == kInner) {
        walk_binary(depth + 1);
      }
    }
  }

  /// Any node: its log odds, and a bit for each child.
  void walk_full(int depth) {  // NOLINT(misc-no-recursion): at most 16 deep
    float log_odds = 0.0F;
    std::memcpy(&log_odds, take(sizeof(log_odds)), sizeof(log_odds));
    if (!std::isfinite(log_odds)) {
      throw fault("a node's log odds are not finite");
    }
    const std::bitset<kChildren> children(static_cast<unsigned char>(*take(1)));
    if (children.none()) {
      count_leaf(depth);
      return;
    }
    count_inner(depth);
    for (std::size_t child = 0; child < kChildren; ++child) {
      if (children[child]) {
        count_node();
        walk_full(depth + 1);
      }
    }
  }

  const std::filesystem::path& file_;
  std::string_view data_;
  OctreeShape& shape_;
  std::size_t at_ = 0;
};

}  // namespace

OctreeShape check_octree(const std::filesystem::path& file,
                         std::string_view bytes,
                         OctreeForm form) {
  OctreeShape shape = HeaderReader(file, bytes).read(form);
  NodeWalk(file, bytes.substr(shape.data_from), shape).run(form);
  return shape;
}

}  // namespace skyhalo

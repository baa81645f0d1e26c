#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string_view>

namespace skyhalo {

/// The two kinds of OctoMap files: `.bt` says of each leaf whether it is free or occupied, `.ot`
/// has the log odds of every node.
enum class OctreeForm { kBinary, kFull };

/// What an OctoMap file holds, found without building the tree.
struct OctreeShape {
  double voxel_m = 0.0;
  std::size_t data_from = 0;      ///< where the tree begins in the file
  std::uint64_t nodes = 0;        ///< 0: an empty tree
  std::uint64_t inner_nodes = 0;  ///< those with children
  /// Bricks of 8 x 8 x 8 cells that leaves fill as a whole, and those that hold smaller leaves.
  std::uint64_t uniform_bricks = 0;
  std::uint64_t mixed_bricks = 0;
};

/// Goes through an OctoMap file's bytes as OctoMap's readers will, who trust them: header, number
/// of nodes, 16 levels at most, finite values, no byte too few or too many. Throws `Error` (input)
/// naming the file and what is wrong. Takes no memory and a time by the bytes.
[[nodiscard]] OctreeShape check_octree(const std::filesystem::path& file,
                                       std::string_view bytes,
                                       OctreeForm form);

}  // namespace skyhalo

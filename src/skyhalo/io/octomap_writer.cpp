// Its templates print what they do unless told not to.
#define OCTOMAP_NODEBUGOUT
#include <octomap/OcTree.h>

#include <algorithm>
#include <cerrno>
#include <fstream>
#include <iomanip>
#include <limits>
#include <optional>
#include <sstream>
#include <string>
#include <utility>

#include "skyhalo/base/error.hpp"
#include "skyhalo/io/map_lattice.hpp"
#include "skyhalo/io/octomap_file.hpp"
#include "skyhalo/io/unfinished_file.hpp"

namespace skyhalo {
namespace {

constexpr int kKeyOfZero = 32768;
constexpr unsigned kTreeDepth = 16;
constexpr unsigned kBrickDepth = kTreeDepth - kBrickBits;

/// An octree that is built brick by brick, so that equal cells never take a node each.
class BrickTree : public octomap::OcTree {
 public:
  explicit BrickTree(double voxel_m) : octomap::OcTree(voxel_m) {
    // The map has its own limits; the octree must not add tighter ones.
    setClampingThresMin(0.0);
    setClampingThresMax(1.0);
  }

  void add_uniform(const Eigen::Vector3i& brick, LogOdds value) { set(*brick_node(brick), value); }

  void add_cells(const Eigen::Vector3i& brick, const BrickCells& cells) {
    add_children(*brick_node(brick), {Eigen::Vector3i::Zero(), kBrickEdge}, cells);
  }

  /// Joins equal nodes, after reducing them to free or occupied for a binary tree.
  void finish(OctreeForm form) {
    if (root == nullptr) {
      return;
    }
    if (form == OctreeForm::kBinary) {
      toMaxLikelihood();
    }
    join_equal(*root);
    updateInnerOccupancy();
  }

 private:
  /// A cube of cells within a brick.
  struct Cube {
    Eigen::Vector3i first;
    int edge;
  };

  static void set(octomap::OcTreeNode& node, LogOdds value) {
    node.setLogOdds(static_cast<float>(kLogOddsPerUnit * value));
  }

  /// From below upwards. OctoMap's own `prune` stops at the first level where nothing is equal.
  void join_equal(octomap::OcTreeNode& node) {  // NOLINT(misc-no-recursion): at most 16 deep
    for (unsigned child = 0; child < 8; ++child) {
      if (nodeChildExists(&node, child)) {
        join_equal(*getNodeChild(&node, child));
      }
    }
    if (nodeHasChildren(&node)) {
      pruneNode(&node);
    }
  }

  /// The node of a brick, made with all above it.
  octomap::OcTreeNode* brick_node(const Eigen::Vector3i& brick) {
    if (root == nullptr) {
      root = new octomap::OcTreeNode();  // the tree deletes it
      ++tree_size;
    }
    const Eigen::Vector3i key = first_cell(brick).array() + kKeyOfZero;
    octomap::OcTreeNode* node = root;
    for (unsigned depth = 0; depth < kBrickDepth; ++depth) {
      const unsigned child = child_of(key, kTreeDepth - 1 - depth);
      node =
          nodeChildExists(node, child) ? getNodeChild(node, child) : createNodeChild(node, child);
    }
    return node;
  }

  static unsigned child_of(const Eigen::Vector3i& key, unsigned bit) {
    const auto bit_of = [&](int x) { return static_cast<unsigned>(x) >> bit & 1U; };
    return bit_of(key.x()) | bit_of(key.y()) << 1U | bit_of(key.z()) << 2U;
  }

  /// The value of all cells of a cube, if they share one.
  static std::optional<LogOdds> shared_value(const Cube& cube, const BrickCells& cells) {
    const LogOdds value = cells.cells[place_in_brick(cube.first)];
    for (int x = 0; x < cube.edge; ++x) {
      for (int y = 0; y < cube.edge; ++y) {
        const auto* const row =
            cells.cells.data() + place_in_brick(cube.first + Eigen::Vector3i(x, y, 0));
        if (std::any_of(row, row + cube.edge, [&](LogOdds cell) { return cell != value; })) {
          return std::nullopt;
        }
      }
    }
    return value;
  }

  void add_children(octomap::OcTreeNode& node,  // NOLINT(misc-no-recursion): three deep
                    const Cube& cube,
                    const BrickCells& cells) {
    const int half = cube.edge / 2;
    for (int child = 0; child < 8; ++child) {
      const Eigen::Vector3i corner(child & 1, child >> 1 & 1, child >> 2 & 1);
      const Cube part{cube.first + half * corner, half};
      const std::optional<LogOdds> value = shared_value(part, cells);
      if (value == kUnknown) {
        continue;
      }
      octomap::OcTreeNode& made = *createNodeChild(&node, static_cast<unsigned>(child));
      if (value) {
        set(made, *value);
      } else {
        add_children(made, part, cells);
      }
    }
  }
};

Error beyond_octree(const std::filesystem::path& file) {
  return {ErrorKind::kFailure,
          file.string() + ": the map reaches beyond what an octree of this cell can hold"};
}

/// The cells as the octree numbers them, in its own place: the key less that of zero.
SparseMap on_octree_lattice(const std::filesystem::path& file, const SparseMap& map) {
  const VoxelLattice& lattice = map.lattice();
  const Eigen::Array3d offset = (lattice.origin_m / lattice.voxel_m).array().round();
  if (!(offset.abs() <= 2.0 * VoxelLattice::kReach).all()) {
    throw beyond_octree(file);
  }
  std::optional<SparseMap> result =
      moved(map, {.voxel_m = lattice.voxel_m}, offset.matrix().cast<int>());
  if (!result) {
    throw beyond_octree(file);
  }
  return std::move(*result);
}

void fill(BrickTree& tree, const std::filesystem::path& file, const SparseMap& map) {
  constexpr int kReach = kKeyOfZero / kBrickEdge;
  BrickCells cells;  // NOLINT(cppcoreguidelines-pro-type-member-init): filled by the map
  for (const Eigen::Vector3i& brick : map.bricks()) {
    if ((brick.array() < -kReach).any() || (brick.array() >= kReach).any()) {
      throw beyond_octree(file);
    }
    if (const std::optional<LogOdds> value = map.uniform(brick)) {
      tree.add_uniform(brick, *value);
      continue;
    }
    map.copy_brick(brick, cells);
    tree.add_cells(brick, cells);
  }
}

/// As few digits as give the number back.
int digits_of(double value) {
  for (int digits = 6; digits < std::numeric_limits<double>::max_digits10; ++digits) {
    std::ostringstream text;
    text << std::setprecision(digits) << value;
    if (std::stod(text.str()) == value) {
      return digits;
    }
  }
  return std::numeric_limits<double>::max_digits10;
}

/// The file as OctoMap's own `write` and `writeBinary` have it; those print to stderr.
void write_tree(const BrickTree& tree, OctreeForm form, std::ostream& stream) {
  const bool binary = form == OctreeForm::kBinary;
  stream << (binary ? "# Octomap OcTree binary file\n" : "# Octomap OcTree file\n")
         << "# (feel free to add / change comments, but leave the first line as it is!)\n#\n"
         << "id OcTree\nsize " << tree.size() << "\nres "
         << std::setprecision(digits_of(tree.getResolution())) << tree.getResolution()
         << "\ndata\n";
  binary ? tree.writeBinaryData(stream) : tree.writeData(stream);
}

}  // namespace

void write_octomap(const std::filesystem::path& file, const SparseMap& map, OctreeForm form) {
  BrickTree tree(map.lattice().voxel_m);
  fill(tree, file, on_octree_lattice(file, map));
  tree.finish(form);
  UnfinishedFile unfinished(file);
  errno = 0;
  std::ofstream stream(unfinished.path(), std::ios::binary);
  write_tree(tree, form, stream);
  unfinished.commit(stream);
}

}  // namespace skyhalo

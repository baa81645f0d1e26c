#include "map_storage.hpp"

#include <array>
#include <cstdio>
#include <optional>
#include <vector>

#include "map_clock.hpp"
#include "skyhalo/map/cell_map.hpp"
#include "skyhalo/map/scan_integrator.hpp"
#include "skyhalo/map/update_cells.hpp"
#ifdef SKYHALO_HAS_OPENVDB
#include <openvdb/openvdb.h>
#include <openvdb/tree/Tree.h>
#include <openvdb/tree/ValueAccessor.h>
#endif

namespace skyhalo::bench {
namespace {

constexpr int kLimit = 5000;
constexpr std::size_t kBrickRows = std::size_t{kBrickEdge} * kBrickEdge;

/// What a scan adds to a brick; to all its cells the same, or to each its own.
struct BrickChange {
  Eigen::Vector3i brick;
  std::optional<Increment> whole;
  BrickCells increments;
};

using ScanChanges = std::vector<BrickChange>;

/// What the cells of a brick gained; increments of 0 where they stayed.
BrickChange change_of(const SparseMap& before, const SparseMap& after, const Eigen::Vector3i& at) {
  BrickChange change{at, std::nullopt, {}};
  BrickCells old_cells;  // NOLINT(cppcoreguidelines-pro-type-member-init): filled by the map
  BrickCells new_cells;  // NOLINT(cppcoreguidelines-pro-type-member-init): filled by the map
  before.copy_brick(at, old_cells);
  after.copy_brick(at, new_cells);
  bool is_whole = true;
  for (std::size_t i = 0; i < kBrickCells; ++i) {
    const int old_value = old_cells.cells[i] == kUnknown ? 0 : old_cells.cells[i];
    const int new_value = new_cells.cells[i] == kUnknown ? 0 : new_cells.cells[i];
    change.increments.cells[i] = static_cast<Increment>(new_value - old_value);
    is_whole = is_whole && change.increments.cells[i] == change.increments.cells[0];
  }
  if (is_whole) {
    change.whole = change.increments.cells[0];
  }
  return change;
}

/// The changes of all scans of a flight, as a sparse map without limits shows them.
std::vector<ScanChanges> record(const Flight& flight, double voxel_m) {
  SparseMap map(VoxelLattice{Eigen::Vector3d::Zero(), voxel_m});
  ScanIntegrator integrator(
      {.sensor = {}, .limit_units = 32767, .method = IntegrationMethod::kSweep});
  std::vector<ScanChanges> all;
  for (const FlownScan& scan : flight.scans) {
    const SparseMap before = map;
    const std::uint64_t tick = map.tick();
    integrator.integrate(scan.scan, scan.T_map_body, map);
    ScanChanges& changes = all.emplace_back();
    for_each_changed_brick(map, tick, [&](const Eigen::Vector3i& brick) {
      changes.push_back(change_of(before, map, brick));
    });
  }
  return all;
}

class SparseStore {
 public:
  explicit SparseStore(double voxel_m) : map_(VoxelLattice{Eigen::Vector3d::Zero(), voxel_m}) {}

  void apply(const ScanChanges& changes) {
    map_.begin_change();
    for (const BrickChange& change : changes) {
      map_.prepare(change.brick, change.whole.has_value());
      if (change.whole) {
        map_.change_whole(change.brick, *change.whole, kLimit);
      } else {
        map_.change(change.brick, change.increments, kLimit);
      }
    }
  }

  [[nodiscard]] std::size_t memory_bytes() const { return map_.memory_bytes(); }

  [[nodiscard]] LogOdds at(const Eigen::Vector3i& cell) const { return map_.at(cell); }

 private:
  SparseMap map_;
};

#ifdef SKYHALO_HAS_OPENVDB
/// Bricks of equal cells are tiles, the others leaves; both by one accessor, which remembers the
/// nodes it came through.
class VdbStore {  // NOLINT(bugprone-exception-escape): OpenVDB's own
 public:
  explicit VdbStore(double /*voxel_m*/) : tree_(kUnknown) {}

  void apply(const ScanChanges& changes) {
    openvdb::tree::ValueAccessor<Tree> accessor(tree_);
    for (const BrickChange& change : changes) {
      const Eigen::Vector3i first = first_cell(change.brick);
      const openvdb::Coord at(first.x(), first.y(), first.z());
      if (change.whole) {
        if (Tree::LeafNodeType* leaf = accessor.probeLeaf(at)) {
          add_increment(rows_of(*leaf), *change.whole, kLimit);
        } else {
          accessor.addTile(1, at, updated(accessor.getValue(at), *change.whole, kLimit), true);
        }
      } else {
        Tree::LeafNodeType* leaf = accessor.touchLeaf(at);
        leaf->setValuesOn();
        add_increments(rows_of(*leaf), change.increments, kLimit);
      }
    }
  }

  [[nodiscard]] std::size_t memory_bytes() const { return tree_.memUsage(); }

  [[nodiscard]] LogOdds at(const Eigen::Vector3i& cell) const {
    return tree_.getValue(openvdb::Coord(cell.x(), cell.y(), cell.z()));
  }

 private:
  using Tree = openvdb::tree::Tree4<LogOdds, 5, 4, kBrickBits>::Type;

  static std::array<CellRow, kBrickRows> rows_of(Tree::LeafNodeType& leaf) {
    LogOdds* const cells = leaf.buffer().data();  // z fastest, as in a brick
    std::array<CellRow, kBrickRows> rows;
    int place = 0;
    for (CellRow& row : rows) {
      row = {cells + place, place, kBrickEdge};
      place += kBrickEdge;
    }
    return rows;
  }

  Tree tree_;
};
#endif

struct StoreResult {
  std::vector<double> times_ms;
  double memory_mb = 0.0;
};

template <class Store>
Store run_once(const std::vector<ScanChanges>& scans, double voxel_m, StoreResult& result) {
  Store store(voxel_m);
  const double start_ms = process_ms();
  for (const ScanChanges& changes : scans) {
    store.apply(changes);
  }
  result.times_ms.push_back((process_ms() - start_ms) / static_cast<double>(scans.size()));
  result.memory_mb = static_cast<double>(store.memory_bytes()) / 1e6;
  return store;
}

std::string line_of(const char* name, const StoreResult& result) {
  std::array<char, 120> text{};
  std::snprintf(text.data(),
                text.size(),
                "| %s | %.3f | %.1f |\n",
                name,
                median(result.times_ms),
                result.memory_mb);
  return text.data();
}

#ifdef SKYHALO_HAS_OPENVDB
/// How many cells that the recorded changes reach differ between the two.
std::size_t differences(const std::vector<ScanChanges>& scans,
                        const SparseStore& ours,
                        const VdbStore& theirs) {
  std::size_t count = 0;
  for (const BrickChange& change : scans.back()) {
    for (std::size_t place = 0; place < kBrickCells; place += 7) {
      const Eigen::Vector3i cell = cell_in_brick(change.brick, place);
      count += ours.at(cell) == theirs.at(cell) ? 0U : 1U;
    }
  }
  return count;
}
#endif

}  // namespace

std::string storage_table(const Flight& flight, double voxel_m, int repeat) {
  const std::vector<ScanChanges> scans = record(flight, voxel_m);
  std::size_t bricks = 0;
  std::size_t whole = 0;
  for (const ScanChanges& changes : scans) {
    bricks += changes.size();
    for (const BrickChange& change : changes) {
      whole += change.whole ? 1U : 0U;
    }
  }
  StoreResult ours;
  StoreResult theirs;
  std::string text = "The same changes, put into both: per scan " +
                     std::to_string(bricks / scans.size()) + " bricks, of which " +
                     std::to_string(whole / scans.size()) +
                     " as one number; the same code adds up cells.\n";
  for (int turn = 0; turn < repeat; ++turn) {
    const SparseStore store = run_once<SparseStore>(scans, voxel_m, ours);
#ifdef SKYHALO_HAS_OPENVDB
    const VdbStore peer = run_once<VdbStore>(scans, voxel_m, theirs);
    if (turn == 0) {
      text += "Cells that differ: " + std::to_string(differences(scans, store, peer)) + ".\n";
    }
#endif
  }
  text += "\n| store | ms per scan | MB |\n|---|---|---|\n" + line_of("SparseMap", ours);
  return text +
         (theirs.times_ms.empty() ? "| OpenVDB | not built in | |\n" : line_of("OpenVDB", theirs));
}

}  // namespace skyhalo::bench

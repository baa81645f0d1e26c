#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "skyhalo/io/folder_lock.hpp"
#include "skyhalo/io/tile_files.hpp"
#include "skyhalo/map/sparse_map.hpp"

namespace skyhalo {

struct MapTilesConfig {
  std::uint64_t budget_bytes = std::uint64_t{512} << 20U;  ///< that the map's bricks may take
  double reach_m = 40.0;   ///< what is nearer to the drone than this stays in memory, > 0
  int limit_units = 5000;  ///< of the log odds, in [1, 32767]
};

/// A tile that could not be brought back.
struct DamagedTile {
  std::string problem;              ///< names the file and says what is wrong with it
  std::filesystem::path set_aside;  ///< what the file is called now; empty when there was none
};

/// Keeps a sparse map within a memory budget: a folder holds it as tiles of 64 x 64 x 64 cells,
/// each a `.skymap` file. Tiles far from the drone go there and come back when it does. A crash
/// loses at most what came after the last `flush`: each file is replaced as a whole. The folder is
/// one map's; a folder that holds tiles already is that map, saved. A damaged tile does not end a
/// flight: when it is needed, its file is renamed to `NAME.damaged` (`.damaged-2` and so on where
/// that is taken), never removed, and what it held is unknown.
class MapTiles {
 public:
  /// Makes the folder when it is missing, keeps it locked as long as this object lives, and clears
  /// it of what killed programs left of tiles. Throws `Error`: failure when it cannot be written
  /// to, input when another program has it or a setting is outside its domain.
  MapTiles(std::filesystem::path folder, const MapTilesConfig& config);

  /// Before a scan: brings in the tiles within reach of the drone, and, when the map takes more
  /// than the budget, puts out those farthest from it, but none within reach. What a map and a tile
  /// that is brought in both know is added. Throws `Error`: input when a tile is of another
  /// lattice, failure when one cannot be written or a damaged one not be set aside; the map then
  /// lacks nothing that it had.
  void follow(const Eigen::Vector3d& position_m, SparseMap& map);

  /// Writes all tiles that have changed since they were last written, and removes those of which
  /// nothing is known any more. Throws as `follow` does.
  void flush(SparseMap& map);

  /// Brings in all tiles, whatever they take: for saving the whole map. Throws as `follow` does.
  void bring_in_all(SparseMap& map);

  /// What the map's bricks would take after `bring_in_all` (bytes): those in memory, and of the
  /// tiles that are away what the heads of their files say. Right after a `flush`; at other times
  /// what a scan saw of a tile that is away may count twice.
  [[nodiscard]] std::uint64_t whole_bytes(const SparseMap& map) const;

  [[nodiscard]] const std::filesystem::path& folder() const noexcept { return folder_; }

  /// Tiles that are in the folder but not in memory.
  [[nodiscard]] std::size_t away_count() const noexcept;

  /// The damaged tiles that were set aside since this object was made, in that order.
  [[nodiscard]] const std::vector<DamagedTile>& damaged() const noexcept { return damaged_; }

 private:
  /// What is known of a tile that is in the folder or has been in memory.
  struct TileState {
    bool away = false;           // in the folder only
    std::uint64_t saved_at = 0;  // the map's tick when it was written
    std::size_t saved_bricks = 0;
  };

  /// A tile in memory.
  struct Resident {
    std::vector<Eigen::Vector3i> bricks;
    std::uint64_t changed_at = 0;
  };

  using Residents = std::map<Tile, Resident>;

  [[nodiscard]] std::filesystem::path file_of(const Tile& tile) const;
  [[nodiscard]] Residents residents(const SparseMap& map) const;
  void check_lattice(const SparseMap& map);
  [[nodiscard]] std::optional<SparseMap> read_or_set_aside(const Tile& tile);
  void bring_in(const Tile& tile, SparseMap& map);
  void write(const Tile& tile, const Resident& resident, const SparseMap& map);
  void put_out_far(const Eigen::Vector3d& position_m, SparseMap& map);

  std::filesystem::path folder_;
  MapTilesConfig config_;
  FolderLock lock_;
  std::map<Tile, TileState> tiles_;
  std::vector<DamagedTile> damaged_;
  bool checked_ = false;
};

}  // namespace skyhalo

#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <nlohmann/json.hpp>
#include <string>

#include "common_options.hpp"
#include "skyhalo/base/timestamp.hpp"
#include "skyhalo/io/map_tiles.hpp"

namespace skyhalo::app {

/// The tiles of a run's sparse map in a folder: when they are written, what is told of them, and
/// whether the map comes together at the end.
class RunTiles {
 public:
  /// Opens the folder. Throws as `MapTiles` does.
  RunTiles(const std::string& folder, const Config& config);

  /// Before a frame (see `MapTiles`).
  void follow(const Eigen::Vector3d& position_m, SparseMap& map) { tiles_.follow(position_m, map); }

  /// After a frame: writes what has changed, every few seconds of the recording.
  void frame_done(Timestamp stamp, SparseMap& map);

  /// Writes what has changed.
  void flush(SparseMap& map) { tiles_.flush(map); }

  /// After the last frame: writes what has changed, and brings all of the map in when it keeps to
  /// `map.memory_mib` so. Returns whether all of it is in memory.
  bool gather(SparseMap& map);

  /// Prints a warning for each damaged tile and for a map that did not come together.
  void print_warnings(const CommonOptions& options) const;

  /// The folder, how many damaged tiles were set aside and what they are called now, and after
  /// `gather` what the whole map takes and whether it came together.
  [[nodiscard]] nlohmann::json summary() const;

 private:
  [[nodiscard]] std::string command_for_one_file() const;

  MapTiles tiles_;
  int budget_mib_;
  Timestamp flushed_{};
  std::uint64_t whole_bytes_ = 0;
  bool is_whole_ = true;
};

}  // namespace skyhalo::app

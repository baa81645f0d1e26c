#pragma once

#include <span>
#include <vector>

#include "skyhalo/sim/seen_cells.hpp"
#include "skyhalo/sim/simulated_flight.hpp"

namespace skyhalo::app {

/// What is really where a flight goes: the exact cells round it, and those that a camera saw.
class ExactMap {
 public:
  /// For all frames of the flight, which must outlive this. The grid reaches 20 m aside of the
  /// flight, 10 m down and 14 m up.
  ExactMap(const SimulatedFlight& flight, double voxel_m);

  /// Adds what all cameras see in a frame; pairs that do not say are looked at shrunk by
  /// `downscale`.
  void look_from(int frame, int downscale);

  [[nodiscard]] const VoxelGrid& grid() const noexcept { return grid_; }

  /// 1 for cells with something that stands still, by position in the grid's memory.
  [[nodiscard]] std::span<const std::uint8_t> occupied() const noexcept { return occupied_; }

  /// 1 for cells that a camera saw within 15 m.
  [[nodiscard]] std::span<const std::uint8_t> seen() const noexcept { return seen_.seen(); }

 private:
  const SimulatedFlight& flight_;
  VoxelGrid grid_;
  std::vector<std::uint8_t> occupied_;
  SeenCells seen_;
};

}  // namespace skyhalo::app

#pragma once

#include <Eigen/Core>
#include <array>

#include "skyhalo/map/brick.hpp"
#include "skyhalo/map/patch_pyramid.hpp"
#include "skyhalo/map/scan_patches.hpp"

namespace skyhalo {

/// Where the middles of the cells of a cube, and of a brick's eighths, are from the first cell's,
/// in the body's frame (m).
struct BrickOffsets {                               // NOLINT(*-member-init): filled by `find`
  alignas(64) std::array<float, kEighthCells> x_m;  ///< of an eighth's cells, z fastest
  alignas(64) std::array<float, kEighthCells> y_m;
  alignas(64) std::array<float, kEighthCells> z_m;
  std::array<Eigen::Vector3f, kEighths> eighth_m;  ///< first cell of each
  Eigen::Vector3f to_middle_m;                     ///< from an eighth's first cell to its middle

  void find(const CellFrame& frame);
};

/// What the sweep of a brick reads.
struct SweepInput {
  const ScanPatches& patches;
  const BrickOffsets& offsets;
  const IncrementTable& table;
  const Cubes& eighths;  ///< of some bricks, by their cells' middles
  const Verdicts& verdicts;
};

/// Looks each cell of a brick up in a scan: what the patch in its direction adds to it, 0 where
/// nothing is said. `first_m`: the middle of the brick's first cell from the body's origin, in the
/// body's frame; `first_eighth`: of the input's. Returns whether anything is said. Vectors of the
/// best instruction set.
bool sweep_brick(const SweepInput& input,
                 const Eigen::Vector3f& first_m,
                 std::size_t first_eighth,
                 BrickCells& increments) noexcept;

}  // namespace skyhalo

#pragma once

#include <cstdint>
#include <string>

#include "skyhalo/geometry/voxel_lattice.hpp"

namespace skyhalo {

/// How much memory reading a map file may take unless the caller says otherwise (bytes).
inline constexpr std::uint64_t kMapMemoryBytes = std::uint64_t{4} << 30U;

/// Whether a `SparseMap` of this many bricks, `mixed` of them with cells of their own, stays within
/// `max_bytes` while it is filled.
[[nodiscard]] constexpr bool fits_in_memory(std::uint64_t bricks,
                                            std::uint64_t mixed,
                                            std::uint64_t max_bytes) noexcept {
  // The table of bricks and its index, half of them unused, and the old ones while they grow.
  constexpr std::uint64_t kPerBrick = 192;
  // The cells; room for them is made for several bricks at once.
  constexpr std::uint64_t kPerMixed = 1040;
  return bricks <= max_bytes / kPerBrick && mixed <= (max_bytes - bricks * kPerBrick) / kPerMixed;
}

/// What is wrong with a file's lattice, empty for nothing: cells from 0.1 mm to 10 km, an origin
/// within a million kilometres.
[[nodiscard]] std::string lattice_fault(const VoxelLattice& lattice);

/// The text that names a limit on memory that a file would break.
[[nodiscard]] std::string too_large_text(std::uint64_t max_bytes);

}  // namespace skyhalo

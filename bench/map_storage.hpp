#pragma once

#include <string>

#include "map_flight.hpp"

namespace skyhalo::bench {

/// The same changes of bricks, put into a SparseMap and, where the library is there, into an
/// OpenVDB tree of 2-byte leaves of the same size: time per scan and memory, as a table. `repeat`
/// turns.
[[nodiscard]] std::string storage_table(const Flight& flight, double voxel_m, int repeat);

}  // namespace skyhalo::bench

#pragma once

#include "skyhalo/map/sparse_map.hpp"

namespace skyhalo {

/// Adds the log odds of another map's known cells, as if both had seen the place independently.
/// Sums stay within what a cell can hold (+-32.767). Throws `Error` (input) unless the cells of
/// both are the same: equal voxels, origins whole cells apart.
void add_log_odds(SparseMap& map, const SparseMap& other);

/// Keeps all log odds within +-limit (units of 0.001, in [1, 32767]).
void limit_log_odds(SparseMap& map, int limit_units);

}  // namespace skyhalo

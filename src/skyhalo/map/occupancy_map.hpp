#pragma once

#include <variant>

#include "skyhalo/map/dense_map.hpp"
#include "skyhalo/map/local_map.hpp"
#include "skyhalo/map/sparse_map.hpp"

namespace skyhalo {

/// A map of any kind: the global one with bounds, the one that follows the drone, the global one
/// without bounds.
using OccupancyMap = std::variant<DenseMap, LocalMap, SparseMap>;

}  // namespace skyhalo

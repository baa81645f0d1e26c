#pragma once

#include <cstdint>

#include "skyhalo/sim/scene.hpp"

namespace skyhalo {

/// A hall with tall shelves full of boxes; the route goes round through two aisles. With the
/// difficulty (0...1) aisles get narrower and more of the boxes are all the same.
[[nodiscard]] Scene make_warehouse(double difficulty, std::uint64_t seed);

}  // namespace skyhalo

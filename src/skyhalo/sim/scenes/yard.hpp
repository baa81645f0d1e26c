#pragma once

#include <cstdint>

#include "skyhalo/sim/scene.hpp"

namespace skyhalo {

/// A yard between garages, walls and containers, with cars and people on their ways; the route
/// goes round in it over their heads. With the difficulty (0...1) more move, and faster.
[[nodiscard]] Scene make_yard(double difficulty, std::uint64_t seed);

}  // namespace skyhalo

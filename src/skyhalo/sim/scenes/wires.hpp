#pragma once

#include <cstdint>

#include "skyhalo/sim/scene.hpp"

namespace skyhalo {

/// Fields with poles, cables, guy ropes and masts; the route goes round beside and under them. With
/// the difficulty (0...1) the wires get thinner: 6 cm to 8 mm across.
[[nodiscard]] Scene make_wires(double difficulty, std::uint64_t seed);

}  // namespace skyhalo

#pragma once

#include <cstdint>

#include "skyhalo/sim/scene.hpp"

namespace skyhalo {

/// A long bent corridor with lamps, pipes, doors and some crates; the route goes through its
/// middle. With the difficulty (0...1) walls, ceiling and floor get blank: at 1 the walls are
/// perfectly uniform; doors and pipes get fewer.
[[nodiscard]] Scene make_tunnel(double difficulty, std::uint64_t seed);

}  // namespace skyhalo

#pragma once

#include <cstdint>

#include "skyhalo/sim/scene.hpp"

namespace skyhalo {

/// A wood on gentle hills with undergrowth, rocks and fallen trunks; the route winds through it 2.5
/// to 3.5 m over the ground. With the difficulty (0...1) trees and undergrowth get denser, branches
/// thinner and the sun lower.
[[nodiscard]] Scene make_forest(double difficulty, std::uint64_t seed);

}  // namespace skyhalo

#pragma once

#include <cstdint>

#include "skyhalo/sim/scene.hpp"

namespace skyhalo {

/// A street between tall houses, with lamp posts, trees and parked cars; the route goes along it 3
/// to 5 m over the road. With the difficulty (0...1) more fronts are of blank glass, what is on
/// the others gets fainter, and more cars are parked.
[[nodiscard]] Scene make_street(double difficulty, std::uint64_t seed);

}  // namespace skyhalo

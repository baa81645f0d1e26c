#pragma once

#include <cstdint>

#include "skyhalo/sim/scene.hpp"

namespace skyhalo {

/// A lake under clouds, with a jetty, reeds, boats and trees; the water sends no laser light back.
/// The route goes round over water and shore. With the difficulty (0...1) the water gets calmer and
/// reflects more of the sky.
[[nodiscard]] Scene make_water(double difficulty, std::uint64_t seed);

}  // namespace skyhalo

#pragma once

#include <cstdint>

#include "skyhalo/sim/scene.hpp"

namespace skyhalo {

/// A sports ground behind nets, with fences of pales and railings, all of them repetitive; the
/// route goes round it and through gaps. With the difficulty (0...1) nets and fences get finer.
[[nodiscard]] Scene make_fence(double difficulty, std::uint64_t seed);

}  // namespace skyhalo

#pragma once

#include "skyhalo/camera/raw_pair.hpp"

namespace skyhalo {

/// The camera whose images are those of another one shrunk by a whole factor >= 1 by area
/// averaging (METHOD 1): the same lens with larger pixels. Rows and columns beyond a multiple of
/// the factor are left out.
[[nodiscard]] RawCamera downscaled(const RawCamera& camera, int factor);

}  // namespace skyhalo

#pragma once

#include <string>
#include <vector>

#include "skyhalo/calibration/rig_check.hpp"

namespace skyhalo {

/// What looks wrong in a pair as it is described: lengths in millimetres, swapped cameras, inverted
/// extrinsics, numbers of another image size. Internal to this layer.
[[nodiscard]] std::vector<std::string> findings_on(const PairDescription& pair);

/// What looks wrong in what a pair comes to: a camera that looks up or lies on its side, a field
/// that the cameras do not fill.
[[nodiscard]] std::vector<std::string> findings_on(const PairReport& pair);

}  // namespace skyhalo

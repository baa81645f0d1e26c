#pragma once

#include <algorithm>
#include <cmath>

namespace skyhalo {

/// `log(p / (1 - p))`; p is kept within [1e-6, 1 - 1e-6].
[[nodiscard]] inline double log_odds(double probability) noexcept {
  const double p = std::clamp(probability, 1e-6, 1.0 - 1e-6);
  return std::log(p / (1.0 - p));
}

}  // namespace skyhalo

#include "skyhalo/config/config.hpp"

#include <cmath>

#include "skyhalo/base/error.hpp"

namespace skyhalo {
namespace {

void require(bool holds, const char* key, const char* expected) {
  if (!holds) {
    throw Error(ErrorKind::kInput, std::string(key) + ": expected " + expected);
  }
}

bool not_negative(double value) noexcept {
  return value >= 0.0 && std::isfinite(value);
}

}  // namespace

void check(const Config& config) {
  check(config.detector);
  check(config.safety);
  const BoundsConfig& bounds = config.bounds;
  require(not_negative(bounds.ahead_m), "bounds.ahead_m", "a length >= 0 m");
  require(not_negative(bounds.behind_m), "bounds.behind_m", "a length >= 0 m");
  require(
      bounds.side_m > 0.0 && std::isfinite(bounds.side_m), "bounds.side_m", "a length above 0 m");
  require(std::isfinite(bounds.bottom_m) && std::isfinite(bounds.top_m) &&
              bounds.bottom_m < bounds.top_m,
          "bounds.bottom_m",
          "bottom_m below top_m");
  require(config.evaluation.max_range_m > 0.0, "evaluation.max_range_m", "a length above 0 m");
  const double p = config.evaluation.occupied_probability;
  require(p > 0.0 && p < 1.0, "evaluation.occupied_probability", "a probability in (0, 1)");
}

}  // namespace skyhalo

#include "skyhalo/sphere/depth_rule.hpp"

#include <cmath>

#include "skyhalo/base/error.hpp"

namespace skyhalo {
namespace {

void require(bool holds, const std::string& key, const char* expected) {
  if (!holds) {
    throw Error(ErrorKind::kInput, key + ": expected " + expected);
  }
}

bool not_negative(double value) noexcept {
  return value >= 0.0 && std::isfinite(value);
}

}  // namespace

void check(const DepthRule& rule, const std::string& section) {
  require(not_negative(rule.sigma_threshold_m), section + ".sigma_threshold_m", "a length >= 0 m");
  require(not_negative(rule.sigma_factor), section + ".sigma_factor", "a number >= 0");
  require(rule.nearest_count >= 1 && rule.nearest_count <= kMaxNearest,
          section + ".nearest_count",
          "a whole number in 1...8");
  require(rule.quantile >= 0.0 && rule.quantile <= 1.0, section + ".quantile", "a number in 0...1");
  require(not_negative(rule.min_range_m), section + ".min_range_m", "a length >= 0 m");
}

}  // namespace skyhalo

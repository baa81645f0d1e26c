#pragma once

#include <string>

namespace skyhalo {

/// How the ranges in a cell become its depth.
enum class DepthRuleKind {
  kThesis,    ///< `mu - sigma_factor sigma` where sigma is below its threshold, else the minimum
  kMean,      ///< `mu`
  kNearest,   ///< the nearest that `nearest_count` points bear out: the n-th smallest range
  kQuantile,  ///< the range that a share `quantile` of the points does not exceed
};

/// When a cell's points become its depth (thesis eq. 5.4, and what stands beside it).
struct DepthRule {
  DepthRuleKind kind = DepthRuleKind::kNearest;
  double sigma_threshold_m = 0.5;  ///< cells whose deviation is below this are one surface, >= 0
  double sigma_factor = 3.0;       ///< how many deviations in front of the mean, >= 0
  int nearest_count = 5;           ///< n, in [1, kMaxNearest]
  double quantile = 0.1;           ///< in [0, 1]
  double min_range_m = 0.0;  ///< the smallest range that the pair can measure; no depth is less

  friend bool operator==(const DepthRule&, const DepthRule&) = default;
};

/// The largest `DepthRule::nearest_count`: how many ranges a cell may have to remember.
inline constexpr int kMaxNearest = 8;

/// Throws `Error` (input) naming the key of section `section` whose value is outside its domain.
void check(const DepthRule& rule, const std::string& section);

}  // namespace skyhalo

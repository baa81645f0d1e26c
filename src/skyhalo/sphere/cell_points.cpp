#include "skyhalo/sphere/cell_points.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>

#include "skyhalo/sphere/keep_nearest.hpp"

namespace skyhalo {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

}  // namespace

CellPoints::CellPoints(int cell_count, const DepthRule& rule)
    : rule_(rule), sums_(static_cast<std::size_t>(cell_count) + 1) {
  if (rule.kind == DepthRuleKind::kNearest) {
    nearest_m_.resize(sums_.size());
    for (NearestRanges& kept : nearest_m_) {
      kept.range_m.fill(kInfinity);
    }
    farthest_kept_m_.assign(sums_.size(), kInfinity);
    farthest_kept_m_.back() = -kInfinity;  // nothing is remembered of points that are in no cell
  } else if (rule.kind == DepthRuleKind::kQuantile) {
    in_class_.resize(sums_.size());
  }
}

void CellPoints::clear() noexcept {
  sums_.back() = {};
  if (!in_class_.empty()) {
    in_class_.back().fill(0);
  }
  for (std::size_t cell = 0; cell + 1 < sums_.size(); ++cell) {
    if (sums_[cell].count == 0) {
      continue;
    }
    sums_[cell] = {};
    if (!nearest_m_.empty()) {
      nearest_m_[cell].range_m.fill(kInfinity);
      farthest_kept_m_[cell] = kInfinity;
    } else if (!in_class_.empty()) {
      in_class_[cell].fill(0);
    }
  }
}

void CellPoints::add(int cell, double range_m) noexcept {
  const auto at = static_cast<std::size_t>(cell);
  sum_up(at, range_m);
  remember(at, range_m);
}

void CellPoints::add(std::span<const std::int32_t> cells,
                     std::span<const float> ranges_m) noexcept {
  // Neighbours mostly share a cell, whose sums would wait for each other: four stretches of the row
  // take turns instead. Points in no cell go where nobody looks, which is cheaper than asking.
  constexpr std::size_t kStretches = 4;
  const std::size_t stretch = cells.size() / kStretches;
  for (std::size_t i = 0; i < stretch; ++i) {
    for (std::size_t k = i; k < kStretches * stretch; k += stretch) {
      sum_up(static_cast<std::size_t>(cells[k]), ranges_m[k]);
    }
  }
  for (std::size_t i = kStretches * stretch; i < cells.size(); ++i) {
    sum_up(static_cast<std::size_t>(cells[i]), ranges_m[i]);
  }
  if (rule_.kind == DepthRuleKind::kNearest) {
    keep_nearest({cells.data(), ranges_m.data(), static_cast<int>(cells.size())},
                 rule_.nearest_count,
                 nearest_m_.data(),
                 farthest_kept_m_.data());
  } else if (rule_.kind == DepthRuleKind::kQuantile) {
    for (std::size_t i = 0; i < cells.size(); ++i) {
      ++in_class_[static_cast<std::size_t>(cells[i])]
                 [static_cast<std::size_t>(class_of(ranges_m[i]))];
    }
  }
}

void CellPoints::sum_up(std::size_t cell, double range_m) noexcept {
  Sums& sums = sums_[cell];
  sums.sum_m += range_m;
  sums.sum_m2 += range_m * range_m;
  sums.min_m = range_m < sums.min_m ? range_m : sums.min_m;
  ++sums.count;
}

void CellPoints::remember(std::size_t cell, double range_m) noexcept {
  if (rule_.kind == DepthRuleKind::kNearest) {
    insert(cell, static_cast<float>(range_m));
  } else if (rule_.kind == DepthRuleKind::kQuantile) {
    ++in_class_[cell][static_cast<std::size_t>(class_of(static_cast<float>(range_m)))];
  }
}

void CellPoints::insert(std::size_t cell, float range_m) noexcept {
  auto& kept_m = nearest_m_[cell].range_m;
  for (std::size_t place = kept_m.size() - 1; place > 0; --place) {
    kept_m[place] = std::max(kept_m[place - 1], std::min(kept_m[place], range_m));
  }
  kept_m[0] = std::min(kept_m[0], range_m);
  farthest_kept_m_[cell] = kept_m[static_cast<std::size_t>(rule_.nearest_count) - 1];
}

void CellPoints::merge(const CellPoints& other, CellSpan cells) noexcept {
  const auto end = static_cast<std::size_t>(cells.end);
  for (auto cell = static_cast<std::size_t>(cells.begin); cell < end; ++cell) {
    const Sums& theirs = other.sums_[cell];
    if (theirs.count == 0) {
      continue;
    }
    Sums& ours = sums_[cell];
    ours.sum_m += theirs.sum_m;
    ours.sum_m2 += theirs.sum_m2;
    ours.min_m = std::min(ours.min_m, theirs.min_m);
    ours.count += theirs.count;
    if (!nearest_m_.empty()) {
      for (int i = 0; i < rule_.nearest_count; ++i) {
        insert(cell, other.nearest_m_[cell].range_m[static_cast<std::size_t>(i)]);
      }
    } else if (!in_class_.empty()) {
      const auto& counts = other.in_class_[cell];
      std::transform(counts.begin(),
                     counts.end(),
                     in_class_[cell].begin(),
                     in_class_[cell].begin(),
                     std::plus<>());
    }
  }
}

std::optional<CellStatistics> CellPoints::statistics(int cell) const noexcept {
  const Sums& sums = sums_[static_cast<std::size_t>(cell)];
  if (sums.count == 0) {
    return std::nullopt;
  }
  const double mean_m = sums.sum_m / sums.count;
  // Rounding can leave a variance of equal ranges slightly below zero.
  const double variance_m2 = std::max(0.0, sums.sum_m2 / sums.count - mean_m * mean_m);
  return CellStatistics{sums.count, mean_m, std::sqrt(variance_m2), sums.min_m};
}

double CellPoints::depth_m(int cell) const noexcept {
  const std::optional<CellStatistics> s = statistics(cell);
  if (!s) {
    return std::numeric_limits<double>::quiet_NaN();
  }
  double range_m = s->mean_m;
  switch (rule_.kind) {
    case DepthRuleKind::kThesis:
      range_m = s->sigma_m < rule_.sigma_threshold_m ? s->mean_m - rule_.sigma_factor * s->sigma_m
                                                     : s->min_m;
      break;
    case DepthRuleKind::kMean:
      break;
    case DepthRuleKind::kNearest:
      range_m = nearest_m(static_cast<std::size_t>(cell));
      break;
    case DepthRuleKind::kQuantile:
      range_m = std::max(quantile_m(static_cast<std::size_t>(cell)), s->min_m);
      break;
  }
  // In this order a NaN stays one.
  return range_m < rule_.min_range_m ? rule_.min_range_m : range_m;
}

double CellPoints::nearest_m(std::size_t cell) const noexcept {
  const float range_m = farthest_kept_m_[cell];
  return range_m < kInfinity ? range_m : std::numeric_limits<double>::quiet_NaN();
}

double CellPoints::quantile_m(std::size_t cell) const noexcept {
  const double target = rule_.quantile * sums_[cell].count;
  int before = 0;
  int range_class = 0;
  const auto& counts = in_class_[cell];
  const auto in = [&](int k) { return counts[static_cast<std::size_t>(k)]; };
  while (range_class + 1 < kClasses &&
         (in(range_class) == 0 || before + in(range_class) < target)) {
    before += in(range_class);
    ++range_class;
  }
  const double begin_m = class_begin_m(range_class);
  const double share = in(range_class) > 0 ? (target - before) / in(range_class) : 0.0;
  return begin_m + share * (class_begin_m(range_class + 1) - begin_m);
}

int CellPoints::class_of(float range_m) noexcept {
  // The exponent of a float and the first four bits of its mantissa count the classes.
  constexpr int kShift = std::numeric_limits<float>::digits - 1 - 4;
  constexpr int kFirst =
      (std::numeric_limits<float>::max_exponent - 1 + kFirstOctave) * kClassesPerOctave;
  const auto bits = std::bit_cast<std::int32_t>(range_m);
  return std::clamp((bits >> kShift) - kFirst, 0, kClasses - 1);
}

double CellPoints::class_begin_m(int range_class) noexcept {
  const int octave = range_class / kClassesPerOctave;
  const int step = range_class % kClassesPerOctave;
  return std::ldexp(1.0 + static_cast<double>(step) / kClassesPerOctave, octave + kFirstOctave);
}

}  // namespace skyhalo

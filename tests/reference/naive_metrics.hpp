#pragma once

#include <cmath>
#include <cstddef>
#include <limits>
#include <stdexcept>
#include <vector>

namespace skyhalo::reference {

/// A cell counts as occupied above this probability (thesis eq. 8.1).
inline constexpr double kOccupiedAbove = 0.7;

/// Scores of a map against its ground truth, no units; NaN where a score is undefined.
struct NaiveMetrics {
  long tp = 0;
  long fp = 0;
  long tn = 0;
  long fn = 0;
  double accuracy = std::numeric_limits<double>::quiet_NaN();
  double precision = std::numeric_limits<double>::quiet_NaN();
  double recall = std::numeric_limits<double>::quiet_NaN();
  double specificity = std::numeric_limits<double>::quiet_NaN();
  double npv = std::numeric_limits<double>::quiet_NaN();
  double error = std::numeric_limits<double>::quiet_NaN();
  double correlation = std::numeric_limits<double>::quiet_NaN();
};

/// Quotient of two counts, NaN when the denominator is 0.
inline double naive_ratio(long numerator, long denominator) {
  if (denominator == 0) {
    return std::numeric_limits<double>::quiet_NaN();
  }
  return static_cast<double>(numerator) / static_cast<double>(denominator);
}

/// True when all values are the same (also of an empty list).
inline bool naive_is_constant(const std::vector<double>& values) {
  for (const double value : values) {
    if (value != values.front()) {
      return false;
    }
  }
  return true;
}

/// Arithmetic mean of a list that is not empty.
inline double naive_mean(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) {
    sum += value;
  }
  return sum / static_cast<double>(values.size());
}

/// Pearson's coefficient of two lists of one length, in two passes (thesis eq. 8.8-8.9); NaN if
/// either is constant or empty.
inline double naive_pearson(const std::vector<double>& a, const std::vector<double>& b) {
  if (naive_is_constant(a) || naive_is_constant(b)) {
    return std::numeric_limits<double>::quiet_NaN();
  }
  const double mean_a = naive_mean(a);
  const double mean_b = naive_mean(b);
  double sum_ab = 0.0;
  double sum_aa = 0.0;
  double sum_bb = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    sum_ab += (a[i] - mean_a) * (b[i] - mean_b);
    sum_aa += (a[i] - mean_a) * (a[i] - mean_a);
    sum_bb += (b[i] - mean_b) * (b[i] - mean_b);
  }
  return sum_ab / std::sqrt(sum_aa * sum_bb);
}

/// Mean squared difference of map and ground-truth probability over the observed cells
/// (thesis eq. 8.7); NaN if no cell is observed.
inline double naive_squared_error(const std::vector<double>& map_probability,
                                  const std::vector<bool>& truth_occupied) {
  double sum = 0.0;
  long observed = 0;
  for (std::size_t i = 0; i < map_probability.size(); ++i) {
    if (std::isnan(map_probability[i])) {
      continue;
    }
    const double truth = truth_occupied[i] ? 1.0 : 0.0;
    sum += (map_probability[i] - truth) * (map_probability[i] - truth);
    ++observed;
  }
  if (observed == 0) {
    return std::numeric_limits<double>::quiet_NaN();
  }
  return sum / static_cast<double>(observed);
}

/// Counts TP, FP, TN and FN with a cell occupied iff its probability is above 0.7; an unobserved
/// (NaN) cell is free (thesis eq. 8.1). The scores stay NaN.
inline NaiveMetrics naive_counts(const std::vector<double>& map_probability,
                                 const std::vector<bool>& truth_occupied) {
  NaiveMetrics metrics;
  for (std::size_t i = 0; i < map_probability.size(); ++i) {
    const bool occupied = !std::isnan(map_probability[i]) && map_probability[i] > kOccupiedAbove;
    const bool truth = truth_occupied[i];
    metrics.tp += (occupied && truth) ? 1 : 0;
    metrics.fp += (occupied && !truth) ? 1 : 0;
    metrics.tn += (!occupied && !truth) ? 1 : 0;
    metrics.fn += (!occupied && truth) ? 1 : 0;
  }
  return metrics;
}

/// All scores of a map (probability per cell, NaN = unobserved) against the ground truth on the
/// same cells (thesis eq. 8.1-8.9). In the correlation an unobserved cell counts as 0.
/// Throws std::invalid_argument if the lists differ in length.
inline NaiveMetrics naive_metrics(const std::vector<double>& map_probability,
                                  const std::vector<bool>& truth_occupied) {
  if (map_probability.size() != truth_occupied.size()) {
    throw std::invalid_argument("naive_metrics: map and ground truth differ in length");
  }
  NaiveMetrics metrics = naive_counts(map_probability, truth_occupied);
  metrics.accuracy =
      naive_ratio(metrics.tp + metrics.tn, metrics.tp + metrics.fp + metrics.tn + metrics.fn);
  metrics.precision = naive_ratio(metrics.tp, metrics.tp + metrics.fp);
  metrics.recall = naive_ratio(metrics.tp, metrics.tp + metrics.fn);
  metrics.specificity = naive_ratio(metrics.tn, metrics.fp + metrics.tn);
  metrics.npv = naive_ratio(metrics.tn, metrics.tn + metrics.fn);
  metrics.error = naive_squared_error(map_probability, truth_occupied);

  std::vector<double> map_field;
  std::vector<double> truth_field;
  for (std::size_t i = 0; i < map_probability.size(); ++i) {
    map_field.push_back(std::isnan(map_probability[i]) ? 0.0 : map_probability[i]);
    truth_field.push_back(truth_occupied[i] ? 1.0 : 0.0);
  }
  metrics.correlation = naive_pearson(map_field, truth_field);
  return metrics;
}

}  // namespace skyhalo::reference

#include "skyhalo/evaluation/metrics.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace skyhalo {
namespace {

constexpr int kFirstValue = std::numeric_limits<LogOdds>::min();
constexpr std::size_t kValues = 65536;

/// How many cells hold each value, free ones and occupied ones apart. Every score follows from it,
/// exactly and with one exponential per value instead of one per cell.
using Histogram = std::vector<std::array<std::int64_t, 2>>;

Histogram count_values(std::span<const LogOdds> cells,
                       std::span<const std::uint8_t> truth,
                       std::span<const std::uint8_t> counted) {
  Histogram histogram(kValues, {0, 0});
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (!counted.empty() && counted[i] == 0) {
      continue;
    }
    const auto value = static_cast<std::size_t>(cells[i] - kFirstValue);
    ++histogram[value][truth[i] != 0 ? 1 : 0];
  }
  return histogram;
}

double ratio(double part, double whole) noexcept {
  return whole > 0.0 ? part / whole : std::numeric_limits<double>::quiet_NaN();
}

/// Sums over all cells of the map's probability p and the truth t.
struct Sums {
  double n = 0.0;
  double p = 0.0;
  double pp = 0.0;
  double t = 0.0;
  double pt = 0.0;
  double observed = 0.0;
  double squared_error = 0.0;

  void add(double cells, double probability, double truth) noexcept {
    n += cells;
    p += cells * probability;
    pp += cells * probability * probability;
    t += cells * truth;
    pt += cells * probability * truth;
  }

  /// Pearson's coefficient (thesis eq. 8.8).
  [[nodiscard]] double correlation() const noexcept {
    const double covariance = pt / n - (p / n) * (t / n);
    const double variance_p = pp / n - (p / n) * (p / n);
    const double variance_t = t / n - (t / n) * (t / n);  // t is 0 or 1
    // Below this a field is constant but for rounding.
    constexpr double kConstant = 1e-15;
    if (!(variance_p > kConstant && variance_t > kConstant)) {
      return std::numeric_limits<double>::quiet_NaN();
    }
    return covariance / std::sqrt(variance_p * variance_t);
  }
};

}  // namespace

Metrics score(std::span<const LogOdds> map_cells,
              std::span<const std::uint8_t> truth,
              double occupied_probability,
              std::span<const std::uint8_t> counted) {
  const Histogram histogram = count_values(map_cells, truth, counted);
  Metrics m;
  Sums sums;
  for (std::size_t i = 0; i < kValues; ++i) {
    const auto value = static_cast<LogOdds>(static_cast<int>(i) + kFirstValue);
    const bool observed = value != kUnknown;
    const double p = probability_of(value);
    const bool called_occupied = observed && p > occupied_probability;
    const auto [free, occupied] = histogram[i];
    (called_occupied ? m.tp : m.fn) += occupied;
    (called_occupied ? m.fp : m.tn) += free;
    const auto free_cells = static_cast<double>(free);
    const auto occupied_cells = static_cast<double>(occupied);
    sums.add(free_cells, observed ? p : 0.0, 0.0);
    sums.add(occupied_cells, observed ? p : 0.0, 1.0);
    if (observed) {
      sums.observed += free_cells + occupied_cells;
      sums.squared_error += free_cells * p * p + occupied_cells * (1.0 - p) * (1.0 - p);
    }
  }
  const auto tp = static_cast<double>(m.tp);
  const auto fp = static_cast<double>(m.fp);
  const auto tn = static_cast<double>(m.tn);
  const auto fn = static_cast<double>(m.fn);
  m.accuracy = ratio(tp + tn, sums.n);
  m.precision = ratio(tp, tp + fp);
  m.recall = ratio(tp, tp + fn);
  m.specificity = ratio(tn, tn + fp);
  m.npv = ratio(tn, tn + fn);
  m.error = ratio(sums.squared_error, sums.observed);
  m.correlation = sums.correlation();
  return m;
}

}  // namespace skyhalo

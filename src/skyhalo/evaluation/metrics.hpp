#pragma once

#include <cstdint>
#include <span>

#include "skyhalo/map/log_odds.hpp"

namespace skyhalo {

/// Scores of a map against the ground truth on the same grid (thesis eq. 8.1 to 8.9). A ratio whose
/// denominator is zero is NaN.
struct Metrics {
  std::int64_t tp = 0;  ///< called occupied, and is
  std::int64_t fp = 0;  ///< called occupied, but is free
  std::int64_t tn = 0;
  std::int64_t fn = 0;
  double accuracy = 0.0;     ///< (tp + tn) / all
  double precision = 0.0;    ///< tp / (tp + fp)
  double recall = 0.0;       ///< tp / (tp + fn)
  double specificity = 0.0;  ///< tn / (tn + fp)
  double npv = 0.0;          ///< tn / (tn + fn)
  double error = 0.0;        ///< mean squared difference of probability over the observed cells
  double correlation = 0.0;  ///< Pearson's, over all cells; an unobserved cell counts as 0
};

/// Scores the cells of a map against the truth (1 occupied, 0 free, same order and length). A cell
/// is called occupied iff its probability is above `occupied_probability`; everything else,
/// unobserved too, is free. With `counted` (same length), only cells that are not 0 there enter.
[[nodiscard]] Metrics score(std::span<const LogOdds> map_cells,
                            std::span<const std::uint8_t> truth,
                            double occupied_probability,
                            std::span<const std::uint8_t> counted = {});

}  // namespace skyhalo

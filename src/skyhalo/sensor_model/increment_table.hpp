#pragma once

#include <cstdint>
#include <vector>

#include "skyhalo/sensor_model/inverse_sensor_model.hpp"

namespace skyhalo {

/// What the inverse sensor model (thesis eq. 6.4 to 6.6) adds to the log odds of a cell, worked out
/// once for all measurements: in whole units, by the measurement's uncertainty (a row) and the
/// cell's offset from the measurement along the ray (a column). Columns go from four deviations in
/// front, where a cell is merely crossed, over the measurement itself to four widths behind it,
/// where nothing is said. With the default settings values are within 0.025 of the model's log
/// odds.
class IncrementTable {
 public:
  static constexpr int kRows = 256;
  static constexpr int kStepsPerWidth = 64;
  static constexpr int kWidths = 4;
  static constexpr int kCentre = kWidths * kStepsPerWidth;  ///< column of the measurement itself
  static constexpr int kCols = 2 * kCentre + 1;

  /// Rows are looked up by steps of this many per metre of uncertainty, up to `kUncertainties`.
  static constexpr int kUncertaintiesPerM = 1024;
  static constexpr int kUncertainties = 8192;

  /// Settings inside their domain (see `check`); `log_odds_per_unit` > 0.
  IncrementTable(const SensorModelConfig& config, double log_odds_per_unit);

  /// The row of an uncertainty (m, > 0).
  [[nodiscard]] int row_of(double delta_z_m) const noexcept {
    const double place = delta_z_m * kUncertaintiesPerM + 0.5;
    return row_of_[place < kUncertainties ? static_cast<std::size_t>(place) : kUncertainties - 1];
  }

  /// The width behind a measurement, c of eq. 6.6, as a multiple of the uncertainty.
  [[nodiscard]] double width_ratio(int row) const noexcept {
    return width_ratio_[static_cast<std::size_t>(row)];
  }

  /// What a cell at `offset_m` behind (in front: below 0) the measurement gets.
  [[nodiscard]] int increment(int row, double delta_z_m, double offset_m) const noexcept {
    const double width_m = offset_m < 0.0 ? delta_z_m : width_ratio(row) * delta_z_m;
    const double steps = kStepsPerWidth * offset_m / width_m;
    // Without a width there is nothing behind; at the measurement itself 0/0 is no step.
    const double clamped = steps < -kCentre ? -kCentre : (steps < kCentre ? steps : kCentre);
    const int column = offset_m == 0.0 ? 0 : static_cast<int>(std::lround(clamped));
    return increments_[place_of(row, column)];
  }

  /// What the measurement's own cell gets.
  [[nodiscard]] int peak(int row) const noexcept { return increments_[place_of(row, 0)]; }

  /// What a cell gets that is merely crossed.
  [[nodiscard]] int crossed() const noexcept { return increments_.front(); }

  /// Rows of `kCols` values.
  [[nodiscard]] const std::int32_t* increments() const noexcept { return increments_.data(); }

  [[nodiscard]] const std::int32_t* rows() const noexcept { return row_of_.data(); }

  [[nodiscard]] const float* width_ratios() const noexcept { return width_ratio_.data(); }

 private:
  /// `column`: from the measurement itself on.
  [[nodiscard]] static std::size_t place_of(int row, int column) noexcept {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(kCols) +
           static_cast<std::size_t>(kCentre + column);
  }

  std::vector<std::int32_t> increments_;
  std::vector<std::int32_t> row_of_;
  std::vector<float> width_ratio_;
};

}  // namespace skyhalo

#include "skyhalo/sensor_model/increment_table.hpp"

#include <algorithm>
#include <cmath>

#include "skyhalo/sensor_model/probability.hpp"

namespace skyhalo {

IncrementTable::IncrementTable(const SensorModelConfig& config, double log_odds_per_unit) {
  const auto units = [&](double probability) {
    return static_cast<std::int32_t>(std::lround(log_odds(probability) / log_odds_per_unit));
  };
  increments_.reserve(std::size_t{kRows} * kCols);
  width_ratio_.reserve(kRows);
  for (int row = 0; row < kRows; ++row) {
    // The shape depends on exp(-delta_z) alone, and rows are its equal steps: in the last one the
    // measurement is exact, in the first it marks nothing.
    const double share = std::max(static_cast<double>(row) / (kRows - 1), 1e-9);
    const double delta_z_m = std::max(-std::log(share), 1e-9);
    const InverseSensorModel model(config, 0.0, delta_z_m);  // offsets alone matter
    width_ratio_.push_back(row == 0 ? 0.0F
                                    : static_cast<float>(model.width_behind_m() / delta_z_m));
    increments_.push_back(units(config.p_free));
    for (int column = 1 - kCentre; column < kCentre; ++column) {
      const double width_m = column < 0 ? delta_z_m : model.width_behind_m();
      increments_.push_back(units(model.probability(column * width_m / kStepsPerWidth)));
    }
    increments_.push_back(0);
  }
  row_of_.reserve(kUncertainties);
  for (int i = 0; i < kUncertainties; ++i) {
    const double delta_z_m = static_cast<double>(i) / kUncertaintiesPerM;
    row_of_.push_back(static_cast<std::int32_t>(std::lround((kRows - 1) * std::exp(-delta_z_m))));
  }
}

}  // namespace skyhalo

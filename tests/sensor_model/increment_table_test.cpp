#include "skyhalo/sensor_model/increment_table.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <functional>
#include <random>
#include <string>

#include "skyhalo/sensor_model/probability.hpp"

namespace skyhalo {
namespace {

constexpr double kPerUnit = 0.001;
/// What the header promises, and the rounding to a whole unit.
constexpr double kAllowedUnits = 40.5;

/// The model's log odds (units) at an offset (m) from a measurement.
double model_units(const SensorModelConfig& config, double delta_z_m, double offset_m) {
  constexpr double kZM = 1000.0;
  return log_odds(InverseSensorModel(config, kZM, delta_z_m).probability(kZM + offset_m)) /
         kPerUnit;
}

double width_behind_m(const SensorModelConfig& config, double delta_z_m) {
  return InverseSensorModel(config, 1000.0, delta_z_m).width_behind_m();
}

double table_units(const IncrementTable& table, double delta_z_m, double offset_m) {
  return table.increment(table.row_of(delta_z_m), delta_z_m, offset_m);
}

const std::int32_t* row_of_values(const IncrementTable& table, int row) {
  return table.increments() + std::ptrdiff_t{row} * IncrementTable::kCols;
}

TEST(IncrementTableTest, FarInFrontIsCrossed) {
  const SensorModelConfig config;
  const IncrementTable table(config, kPerUnit);
  const auto crossed = static_cast<int>(std::lround(1000.0 * std::log(0.3 / 0.7)));
  EXPECT_EQ(crossed, -847);
  EXPECT_EQ(table.crossed(), crossed);
  for (const double delta_z_m : {1e-4, 0.01, 0.3, 2.0, 9.0, 100.0}) {
    EXPECT_EQ(table_units(table, delta_z_m, -4.01 * delta_z_m), crossed) << delta_z_m;
    EXPECT_EQ(table_units(table, delta_z_m, -1e6), crossed) << delta_z_m;
  }
}

TEST(IncrementTableTest, FarBehindNothingIsSaid) {
  for (const SensorModelConfig& config :
       {SensorModelConfig{}, SensorModelConfig{.k = 0.5, .p_unknown = 0.6, .p_free = 0.4}}) {
    const IncrementTable table(config, kPerUnit);
    for (const double delta_z_m : {1e-4, 0.01, 0.3, 2.0, 9.0, 100.0}) {
      // The row's width differs a little from the measurement's own.
      EXPECT_EQ(table_units(table, delta_z_m, 4.1 * width_behind_m(config, delta_z_m) + 1e-9), 0)
          << delta_z_m;
      EXPECT_EQ(table_units(table, delta_z_m, 1e6), 0) << delta_z_m;
    }
  }
}

TEST(IncrementTableTest, AMeasurementsOwnCellGetsThePeak) {
  const IncrementTable table(SensorModelConfig{}, kPerUnit);
  // A sure measurement: 0.5 + 0.75 * 0.5.
  EXPECT_NEAR(table_units(table, 1e-4, 0.0), 1000.0 * std::log(0.875 / 0.125), 5.0);
  for (const double delta_z_m : {1e-4, 0.01, 0.3, 2.0, 9.0}) {
    EXPECT_EQ(table.peak(table.row_of(delta_z_m)), table_units(table, delta_z_m, 0.0));
  }
  // One that could be anywhere marks nothing, and divides nothing by zero.
  EXPECT_EQ(table_units(table, 50.0, 0.0), 0);
  EXPECT_EQ(table_units(table, 50.0, 1.0), 0);
  EXPECT_EQ(table.width_ratio(table.row_of(50.0)), 0.0);
}

TEST(IncrementTableTest, WorksInOtherUnits) {
  const IncrementTable fine(SensorModelConfig{}, 0.001);
  const IncrementTable coarse(SensorModelConfig{}, 0.01);
  for (double offset_m = -1.0; offset_m < 1.0; offset_m += 0.013) {
    const double units = table_units(fine, 0.2, offset_m);
    EXPECT_NEAR(table_units(coarse, 0.2, offset_m), units / 10.0, 0.56) << offset_m;
  }
}

TEST(IncrementTableTest, ATableOfTheSizeThatItSays) {
  const IncrementTable table(SensorModelConfig{}, kPerUnit);
  for (int row = 0; row < IncrementTable::kRows; ++row) {
    const std::int32_t* const values = row_of_values(table, row);
    EXPECT_EQ(values[0], table.crossed());
    EXPECT_EQ(values[IncrementTable::kCentre], table.peak(row));
    EXPECT_EQ(values[IncrementTable::kCols - 1], 0);
    EXPECT_EQ(static_cast<double>(table.width_ratios()[row]), table.width_ratio(row));
  }
  for (int i = 0; i < IncrementTable::kUncertainties; ++i) {
    EXPECT_GE(table.rows()[i], 0);
    EXPECT_LT(table.rows()[i], IncrementTable::kRows);
  }
}

TEST(IncrementTableProperty, IsWithinFourHundredthsOfTheModel) {
  const SensorModelConfig config;
  const IncrementTable table(config, kPerUnit);
  double worst_units = 0.0;
  double worst_delta_m = 0.0;
  double worst_offset_m = 0.0;
  for (double delta_z_m = 1e-4; delta_z_m < 12.0; delta_z_m *= 1.011) {
    const double behind_m = width_behind_m(config, delta_z_m);
    for (int i = -500; i <= 500; ++i) {
      const double offset_m = i / 100.0 * (i < 0 ? delta_z_m : behind_m);
      const double error = std::abs(table_units(table, delta_z_m, offset_m) -
                                    model_units(config, delta_z_m, offset_m));
      if (error > worst_units) {
        worst_units = error;
        worst_delta_m = delta_z_m;
        worst_offset_m = offset_m;
      }
    }
  }
  EXPECT_LE(worst_units, kAllowedUnits)
      << "of an uncertainty of " << worst_delta_m << " m, " << worst_offset_m << " m behind";
  RecordProperty("worst_units", std::to_string(worst_units));
}

TEST(IncrementTableProperty, FallsBehindTheMeasurementAndRisesInFront) {
  const IncrementTable table(SensorModelConfig{}, kPerUnit);
  for (int row = 0; row < IncrementTable::kRows; ++row) {
    const std::int32_t* const values = row_of_values(table, row);
    EXPECT_TRUE(std::is_sorted(values, values + IncrementTable::kCentre + 1)) << row;
    EXPECT_TRUE(std::is_sorted(
        values + IncrementTable::kCentre, values + IncrementTable::kCols, std::greater<>()))
        << row;
    EXPECT_GE(table.peak(row), 0);
  }
}

TEST(IncrementTableProperty, SurerMeasurementsMarkMore) {
  const IncrementTable table(SensorModelConfig{}, kPerUnit);
  int last = table.peak(table.row_of(1e-4));
  for (double delta_z_m = 1e-3; delta_z_m < 20.0; delta_z_m += 1e-3) {
    const int peak = table.peak(table.row_of(delta_z_m));
    ASSERT_LE(peak, last) << delta_z_m;
    last = peak;
  }
  EXPECT_EQ(last, 0);
}

TEST(IncrementTableProperty, OfAnySettingsTheEndsAreTheModels) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> share(0.0, 1.0);
  for (int round = 0; round < 50; ++round) {
    SensorModelConfig config;
    config.k = 0.02 + 0.96 * share(random);
    config.p_free = 0.01 + 0.48 * share(random);
    config.p_unknown = config.p_free + (0.99 - config.p_free) * (0.05 + 0.9 * share(random));
    ASSERT_NO_THROW(check(config));
    const IncrementTable table(config, kPerUnit);
    const double crossed = log_odds(config.p_free) / kPerUnit;
    EXPECT_NEAR(table.crossed(), crossed, 0.51);
    for (const double delta_z_m : {0.001, 0.2, 1.5}) {
      const double peak = model_units(config, delta_z_m, 0.0);
      const double next = model_units(config, delta_z_m + 0.02, 0.0);
      EXPECT_NEAR(table_units(table, delta_z_m, 0.0), peak, 1.0 + std::abs(peak - next));
      EXPECT_NEAR(table_units(table, delta_z_m, -5.0 * delta_z_m), crossed, 0.51);
    }
  }
}

}  // namespace
}  // namespace skyhalo

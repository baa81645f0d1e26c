#include "skyhalo/pipeline/halo_scan.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <random>
#include <vector>

#include "reference/naive_sensor_model.hpp"
#include "skyhalo/geometry/angle.hpp"

namespace skyhalo {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr int kRows = 18;

/// Steps of 10 deg.
Halo coarse_halo() {
  return Halo(rad_from_deg(10.0));
}

/// A pinhole pair of 0.5 m and 400 px, and a spherical one of 0.3 m and 0.002 rad a pixel.
std::vector<RangeModel> range_models() {
  return {
      {.pair = PinholePair{.focal_px = 400.0, .baseline_m = 0.5}, .delta_d_px = 0.5},
      {.pair = SphericalPair{.delta_theta_u_rad = 0.002, .baseline_m = 0.3}, .delta_d_px = 0.25}};
}

std::size_t place_of(GridCell cell) {
  return static_cast<std::size_t>(cell.row) * 2 * kRows + static_cast<std::size_t>(cell.col);
}

/// What a scan says of a direction: its range, or else how far it is free; neither when unseen.
struct Said {
  std::optional<float> z_m;
  std::optional<float> delta_z_m;
  float free_to_m = 0.0F;
};

Said said_of(const RangeScan& scan, GridCell cell) {
  const std::size_t at = place_of(cell);
  if (scan.z_m()[at] > 0.0F) {
    return {scan.z_m()[at], scan.delta_z_m()[at]};
  }
  EXPECT_TRUE(std::isnan(scan.z_m()[at]));
  return {std::nullopt, std::nullopt, scan.free_to_m()[at]};
}

int count_seen(const RangeScan& scan) {
  int seen = 0;
  for (int row = 0; row < scan.rows(); ++row) {
    for (int col = 0; col < scan.cols(); ++col) {
      const Said said = said_of(scan, {row, col});
      seen += said.z_m || said.free_to_m > 0.0F ? 1 : 0;
    }
  }
  return seen;
}

TEST(HaloScanTest, AnEmptyHaloSaysNothing) {
  RangeScan scan(kRows);
  fill_scan(coarse_halo(), range_models(), scan);
  EXPECT_EQ(count_seen(scan), 0);
}

TEST(HaloScanTest, DepthsHaveTheUncertaintyOfThePairTheyComeFrom) {
  Halo halo = coarse_halo();
  halo.set({5, 7}, 6.0F, 6.0F, 0);
  halo.set({9, 30}, 6.0F, 6.0F, 1);
  RangeScan scan(kRows);
  fill_scan(halo, range_models(), scan);
  const Said pinhole = said_of(scan, {5, 7});
  EXPECT_EQ(pinhole.z_m, 6.0F);
  EXPECT_NEAR(pinhole.delta_z_m.value_or(0.0F), 36.0 * 0.5 / (0.5 * 400.0), 1e-6);  // eq. 6.9
  const Said spherical = said_of(scan, {9, 30});
  EXPECT_EQ(spherical.z_m, 6.0F);
  EXPECT_NEAR(spherical.delta_z_m.value_or(0.0F),
              reference::naive_spherical_delta_z_m(6.0, 0.3, 0.002, 0.25),
              1e-6);
  EXPECT_EQ(count_seen(scan), 2);
}

TEST(HaloScanTest, ADirectionWithoutADepthIsFreeAsFarAsItWasSeen) {
  Halo halo = coarse_halo();
  halo.set({0, 0}, kNan, 20.0F);
  halo.set({17, 35}, kNan, 3.5F, 1);
  halo.set({8, 8}, 4.0F, 2.0F);  // free to nearer than its depth
  halo.set({8, 9}, kNan, 0.0F);
  RangeScan scan(kRows);
  fill_scan(halo, range_models(), scan);
  EXPECT_EQ(said_of(scan, {0, 0}).free_to_m, 20.0F);
  EXPECT_EQ(said_of(scan, {17, 35}).free_to_m, 3.5F);
  EXPECT_EQ(said_of(scan, {8, 8}).z_m, 4.0F);
  EXPECT_EQ(said_of(scan, {8, 9}).free_to_m, 0.0F) << "unseen is not free";
  EXPECT_EQ(count_seen(scan), 3);
}

TEST(HaloScanTest, DepthsOfNoPairAreLeftOut) {
  Halo halo = coarse_halo();
  halo.set({5, 7}, 4.0F, 4.0F, 2);
  halo.set({5, 8}, 4.0F, 4.0F, Halo::kNoSource);
  RangeScan scan(kRows);
  fill_scan(halo, range_models(), scan);
  EXPECT_EQ(count_seen(scan), 0);
  fill_scan(halo, {}, scan);
  EXPECT_EQ(count_seen(scan), 0);
}

TEST(HaloScanTest, NothingOfTheLastScanStays) {
  Halo halo = coarse_halo();
  for (int row = 0; row < kRows; ++row) {
    for (int col = 0; col < 2 * kRows; ++col) {
      const float range_m = 5.0F + static_cast<float>(col);
      halo.set({row, col}, row % 2 == 0 ? range_m : kNan, range_m);
    }
  }
  RangeScan scan(kRows);
  fill_scan(halo, range_models(), scan);
  EXPECT_EQ(count_seen(scan), 2 * kRows * kRows);
  EXPECT_EQ(scan.farthest_m(), 40.0);
  fill_scan(coarse_halo(), range_models(), scan);
  EXPECT_EQ(count_seen(scan), 0);
  EXPECT_EQ(scan.farthest_m(), 0.0);
}

TEST(HaloScanTest, DirectionsOfBothAreTheSame) {
  const Halo halo = coarse_halo();
  const RangeScan scan(kRows);
  ASSERT_EQ(halo.geometry().rows, scan.rows());
  ASSERT_EQ(halo.geometry().cols, scan.cols());
  for (int row = 0; row < kRows; ++row) {
    for (int col = 0; col < 2 * kRows; ++col) {
      const Eigen::Vector3d of_halo = halo.geometry().center_direction({row, col});
      EXPECT_LT((scan.direction(row, col) - of_halo).norm(), 1e-12) << row << ", " << col;
    }
  }
}

TEST(HaloScanReference, EveryCellOfRandomHalos) {
  std::mt19937 random(71);
  std::uniform_real_distribution<float> range_m(0.3F, 30.0F);
  const std::vector<RangeModel> models = range_models();
  RangeScan scan(kRows);
  for (int round = 0; round < 20; ++round) {
    Halo halo = coarse_halo();
    for (int i = 0; i < 500; ++i) {
      const GridCell cell{static_cast<int>(random() % kRows), static_cast<int>(random() % 36U)};
      const float to_m = range_m(random);
      halo.set(cell,
               random() % 2U == 0 ? to_m : kNan,
               random() % 4U == 0 ? 0.0F : to_m,
               static_cast<std::uint8_t>(random() % 3U));
    }
    fill_scan(halo, models, scan);
    for (int i = 0; i < halo.geometry().cell_count(); ++i) {
      const GridCell cell{i / (2 * kRows), i % (2 * kRows)};
      const std::optional<double> depth_m = halo.depth_m(cell);
      const bool has_model = halo.source(cell).value_or(2) < models.size();
      const Said said = said_of(scan, cell);
      ASSERT_EQ(said.z_m.has_value(), depth_m.has_value() && has_model);
      if (said.z_m) {
        const double expected_m =
            halo.source(cell) == 0U
                ? reference::naive_pinhole_delta_z_m(*depth_m, 0.5, 400.0, 0.5)
                : reference::naive_spherical_delta_z_m(*depth_m, 0.3, 0.002, 0.25);
        ASSERT_EQ(static_cast<double>(*said.z_m), *depth_m);
        ASSERT_NEAR(said.delta_z_m.value_or(0.0F), expected_m, 1e-5 * expected_m + 1e-4);
      } else if (!depth_m) {
        ASSERT_EQ(static_cast<double>(said.free_to_m), halo.free_to_m(cell));
      } else {
        ASSERT_EQ(said.free_to_m, 0.0F);
      }
    }
  }
}

}  // namespace
}  // namespace skyhalo

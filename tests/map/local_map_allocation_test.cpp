// Counts the allocations of a local map's flight. This program replaces the global operators new
// and delete.
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cstddef>
#include <vector>

#include "map/local_map_flight.hpp"
#include "skyhalo/map/local_map.hpp"
#include "skyhalo/map/scan_integrator.hpp"
#include "support/counted_new.hpp"

namespace skyhalo {
namespace {

constexpr double kVoxelM = 0.25;

TEST(LocalMapAllocationTest, TheCounterCounts) {
  const long before = allocation_count;
  auto* const value = new std::vector<int>(100);
  EXPECT_EQ(allocation_count - before, 2);
  delete value;
}

TEST(LocalMapAllocationTest, AKilometreOfFlightAllocatesNothing) {
  const std::vector<Eigen::Vector3d> flight = testing::winding_flight(1000.0, kVoxelM);
  LocalMap map(local_map_cells({8.0, 8.0, 5.0}, kVoxelM), kVoxelM);
  const long before = allocation_count;
  for (const Eigen::Vector3d& position_m : flight) {
    map.follow(position_m);
    map.set(map.bounds().min, 5);
  }
  EXPECT_EQ(allocation_count - before, 0);
  EXPECT_EQ(map.at(map.bounds().min), 5);
}

/// A wall 3 m ahead, the rest seen free to 2 m, and nothing below.
RangeScan wall_scan() {
  RangeScan scan(90);
  for (int row = 0; row < 60; ++row) {
    for (int col = 0; col < scan.cols(); ++col) {
      const double ahead = scan.direction(row, col).x();
      if (ahead > 0.5) {
        scan.set_depth(row, col, static_cast<float>(3.0 / ahead), 0.1F);
      } else {
        scan.set_free(row, col, 2.0F);
      }
    }
  }
  return scan;
}

/// Occupied cells of the level of the drone, in front of it.
int occupied_ahead(const LocalMap& map) {
  const Eigen::Vector3i drone = map.bounds().min + map.bounds().size() / 2;
  int occupied = 0;
  for (int x = 0; drone.x() + x < map.bounds().max.x(); ++x) {
    for (int y = -5; y <= 5; ++y) {
      occupied += map.at(drone + Eigen::Vector3i(x, y, 0)) > 0 ? 1 : 0;
    }
  }
  return occupied;
}

class LocalMapAllocationByMethodTest : public ::testing::TestWithParam<IntegrationMethod> {};

TEST_P(LocalMapAllocationByMethodTest, NorDoScansAfterTheFirst) {
  // TBB's own memory for tasks is not the library's.
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  const std::vector<Eigen::Vector3d> flight = testing::winding_flight(1000.0, kVoxelM);
  const RangeScan scan = wall_scan();
  LocalMap map(local_map_cells({8.0, 8.0, 5.0}, kVoxelM), kVoxelM);
  IntegrationConfig config;
  config.method = GetParam();
  ScanIntegrator integrator(config);
  const auto fly_to = [&](const Eigen::Vector3d& position_m) {
    Pose T_map_body = Pose::Identity();
    T_map_body.translation() = position_m;
    map.follow(position_m);
    (void)integrator.integrate(scan, T_map_body, map);
  };
  fly_to(flight.front());
  int scans = 0;
  int walls = 0;
  const long before = allocation_count;
  for (std::size_t i = 1; i < flight.size(); i += 10) {
    fly_to(flight[i]);
    ASSERT_EQ(allocation_count - before, 0) << "position " << i;
    ++scans;
    walls += occupied_ahead(map) > 3 ? 1 : 0;  // not at once where it was free for long
  }
  EXPECT_GT(walls, scans / 2);
}

INSTANTIATE_TEST_SUITE_P(All,
                         LocalMapAllocationByMethodTest,
                         ::testing::Values(IntegrationMethod::kRays,
                                           IntegrationMethod::kSweep,
                                           IntegrationMethod::kAuto));

}  // namespace
}  // namespace skyhalo

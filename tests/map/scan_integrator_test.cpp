#include "skyhalo/map/scan_integrator.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace skyhalo {
namespace {

class ScanIntegratorByMethodTest : public ::testing::TestWithParam<IntegrationMethod> {
 protected:
  [[nodiscard]] static ScanIntegrator integrator() {
    return ScanIntegrator({.sensor = {}, .method = GetParam()});
  }
};

/// One thing ahead, slightly to the left and below, off the borders of directions.
RangeScan scan_of(float z_m) {
  RangeScan scan(90);
  scan.set_depth(45, 90, z_m, 0.02F);
  return scan;
}

Eigen::Vector3d end_m(double z_m) {
  return z_m * RangeScan(90).direction(45, 90);
}

TEST_P(ScanIntegratorByMethodTest, AThingIsMarkedAndTheWayToItIsFree) {
  SparseMap map({.voxel_m = 0.25});
  const IntegrationReport report = integrator().integrate(scan_of(5.0F), Pose::Identity(), map);
  EXPECT_EQ(report.things, 1);
  EXPECT_EQ(report.free, 0);
  EXPECT_GT(map.at(map.lattice().cell_of(end_m(5.0))), 1000);
  EXPECT_EQ(map.at(map.lattice().cell_of(end_m(6.0))), kUnknown);
}

TEST_P(ScanIntegratorByMethodTest, AnAbsurdRangeIsBounded) {
  SparseMap map({.voxel_m = 0.5});
  RangeScan scan = scan_of(5.0F);
  scan.set_depth(30, 20, 1e9F, 0.02F);
  scan.set_free(31, 20, 1e9F);
  (void)integrator().integrate(scan, Pose::Identity(), map);
  EXPECT_GT(map.at(map.lattice().cell_of(end_m(5.0))), 1000);
  const CellBox known = map.known_bounds();
  EXPECT_LE(known.size().maxCoeff(), 2 * kMostReachCells + 2 * kBrickEdge);
}

TEST_P(ScanIntegratorByMethodTest, AFarRangeDoesNotMoveTheEndsOfNearOnes) {
  SparseMap map({.voxel_m = 0.05});
  RangeScan scan = scan_of(3.0F);
  scan.set_depth(30, 20, 1e6F, 0.02F);
  (void)integrator().integrate(scan, Pose::Identity(), map);
  EXPECT_GT(map.at(map.lattice().cell_of(end_m(3.0))), 1000);
}

TEST_P(ScanIntegratorByMethodTest, APoseBeyondAllCellsChangesNothing) {
  for (const double x_m : {1e20, -1e20, 1e8, std::numeric_limits<double>::quiet_NaN()}) {
    SparseMap sparse({.voxel_m = 0.25});
    LocalMap local({32, 32, 20}, 0.25);
    Pose T_map_body = Pose::Identity();
    T_map_body.translation().x() = x_m;
    (void)integrator().integrate(scan_of(5.0F), T_map_body, sparse);
    local.follow(T_map_body.translation());
    (void)integrator().integrate(scan_of(5.0F), T_map_body, local);
    EXPECT_EQ(sparse.brick_count(), 0U) << x_m;
  }
}

TEST_P(ScanIntegratorByMethodTest, AFarPoseStillMarks) {
  SparseMap map({.voxel_m = 0.25});
  Pose T_map_body = Pose::Identity();
  T_map_body.translation() = Eigen::Vector3d(1e6, -2e5, 3e3);
  (void)integrator().integrate(scan_of(5.0F), T_map_body, map);
  EXPECT_GT(map.at(map.lattice().cell_of(T_map_body.translation() + end_m(5.0))), 1000);
}

TEST_P(ScanIntegratorByMethodTest, ScansOfTheFewestAndOfManyDirections) {
  for (const int rows : {2, 3, 700}) {
    SparseMap map({.voxel_m = 0.25});
    RangeScan scan(rows);
    for (int row = 0; row < rows; ++row) {
      for (int col = 0; col < 2 * rows; ++col) {
        scan.set_depth(row, col, 3.0F, 0.02F);
      }
    }
    (void)integrator().integrate(scan, Pose::Identity(), map);
    const Eigen::Vector3d point_m = 3.0 * scan.direction(rows / 2, rows);
    EXPECT_GT(map.at(map.lattice().cell_of(point_m)), 1000) << rows;
    EXPECT_LT(map.at(map.lattice().cell_of(0.4 * point_m)), 0) << rows;
  }
}

TEST_P(ScanIntegratorByMethodTest, NothingSeenChangesNothing) {
  SparseMap map({.voxel_m = 0.25});
  (void)integrator().integrate(RangeScan(90), Pose::Identity(), map);
  EXPECT_EQ(map.brick_count(), 0U);
}

INSTANTIATE_TEST_SUITE_P(Methods,
                         ScanIntegratorByMethodTest,
                         ::testing::Values(IntegrationMethod::kRays, IntegrationMethod::kSweep));

}  // namespace
}  // namespace skyhalo

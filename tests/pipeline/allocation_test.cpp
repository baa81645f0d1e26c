// Counts the allocations of the per-frame code between stereo matching and the map. This program
// replaces the global operators new and delete.
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdlib>
#include <limits>
#include <new>
#include <random>
#include <vector>

#include "skyhalo/geometry/angle.hpp"
#include "skyhalo/map/scan_integrator.hpp"
#include "skyhalo/pipeline/halo_scan.hpp"
#include "skyhalo/safety/velocity_limiter.hpp"
#include "skyhalo/sphere/accumulate.hpp"
#include "skyhalo/sphere/halo.hpp"
#include "support/counted_new.hpp"

namespace skyhalo {
namespace {

/// A random disparity image with 10 % of the pixels missing.
cv::Mat1f random_disparity(unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> unit(0.0F, 1.0F);
  cv::Mat1f disparity(60, 80);
  for (float& value : disparity) {
    value =
        unit(random) < 0.1F ? std::numeric_limits<float>::quiet_NaN() : 2.0F + 20.0F * unit(random);
  }
  return disparity;
}

Pose forward_camera() {
  Eigen::Matrix3d R_body_camera;
  R_body_camera << 0, 0, 1,  //
      -1, 0, 0,              //
      0, -1, 0;
  return make_pose(R_body_camera, Eigen::Vector3d::Zero());
}

TEST(AllocationTest, TheCounterCounts) {
  const long before = allocation_count;
  auto* const value = new std::vector<int>(100);
  EXPECT_EQ(allocation_count - before, 2);
  delete value;
}

class AllocationByRuleTest : public ::testing::TestWithParam<DepthRuleKind> {};

TEST_P(AllocationByRuleTest, FramesAfterTheFirstAllocateNothingBetweenMatchingAndMap) {
  // TBB's own memory for tasks is not the library's.
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  const GridGeometry geometry = make_grid_geometry({.theta_min_rad = rad_from_deg(40.0),
                                                    .theta_max_rad = rad_from_deg(140.0),
                                                    .phi_min_rad = rad_from_deg(-50.0),
                                                    .phi_max_rad = rad_from_deg(50.0),
                                                    .step_rad = rad_from_deg(2.0)});
  const PairGeometry pair{.model = PinholePair{.focal_px = 80.0,
                                               .principal_u_px = 39.5,
                                               .principal_v_px = 29.5,
                                               .baseline_m = 0.5,
                                               .disparity_offset_px = 0.0},
                          .T_body_camera = forward_camera(),
                          .max_range_m = 30.0};
  const std::vector<RangeModel> models{{.pair = pair.model}};
  SphericalGrid grid(geometry, {.kind = GetParam(), .nearest_count = 1});
  Accumulator accumulator(pair, cv::Size(80, 60), geometry, grid.rule());
  Halo halo(geometry.theta_step_rad);
  VelocityLimiter limiter({}, halo);
  RangeScan scan(halo.geometry().rows);
  ScanIntegrator integrator({});
  LocalMap map({40, 40, 40}, 0.5);
  int sent = 0;
  const auto process = [&](const cv::Mat1f& disparity) {
    grid.clear();
    (void)accumulator.accumulate(disparity, grid);
    const std::array<PairGrid, 1> grids{{{&grid, Timestamp()}}};
    halo.stitch(grids);
    (void)limiter.limit(halo, {.desired_mps = {5.0, 1.0, 0.0}});
    fill_scan(halo, models, scan);
    sent = integrator.integrate(scan, Pose::Identity(), map).things;
  };
  process(random_disparity(1));
  for (unsigned frame = 2; frame < 6; ++frame) {
    const cv::Mat1f disparity = random_disparity(frame);
    const long before = allocation_count;
    process(disparity);
    EXPECT_EQ(allocation_count - before, 0) << "frame " << frame;
    EXPECT_GT(sent, 100);
  }
}

INSTANTIATE_TEST_SUITE_P(All,
                         AllocationByRuleTest,
                         ::testing::Values(DepthRuleKind::kThesis,
                                           DepthRuleKind::kMean,
                                           DepthRuleKind::kNearest,
                                           DepthRuleKind::kQuantile));

}  // namespace
}  // namespace skyhalo

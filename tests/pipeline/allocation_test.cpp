// Counts the allocations of the per-frame code between stereo matching and the map. This program
// replaces the global operators new and delete.
#include <gtest/gtest.h>

#include <atomic>
#include <cstddef>
#include <cstdlib>
#include <limits>
#include <new>
#include <random>
#include <vector>

#include "skyhalo/geometry/angle.hpp"
#include "skyhalo/pipeline/grid_rays.hpp"
#include "skyhalo/sphere/accumulate.hpp"
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

TEST(AllocationTest, FramesAfterTheFirstAllocateNothingBetweenMatchingAndMap) {
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
  RangeModel model;
  model.pair = pair.model;
  SphericalGrid grid(geometry);
  const GridRays rays(geometry);
  DenseMap map(
      make_voxel_grid({Eigen::Vector3d::Constant(-10.0), Eigen::Vector3d::Constant(10.0)}, 0.5));
  int sent = 0;
  const auto process = [&](const cv::Mat1f& disparity) {
    grid.clear();
    (void)accumulate(disparity, pair, grid);
    sent = rays.integrate(grid, model, Pose::Identity(), map);
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

}  // namespace
}  // namespace skyhalo

#include <benchmark/benchmark.h>

#include <opencv2/core.hpp>

#include "skyhalo/geometry/angle.hpp"
#include "skyhalo/sphere/accumulate.hpp"

namespace skyhalo {
namespace {

/// A full 640x360 disparity image into a grid of 1 degree.
void accumulate_image(benchmark::State& state) {
  Eigen::Matrix3d R_body_camera;
  R_body_camera << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  const PairGeometry pair{.model = PinholePair{320.0, 319.5, 179.5, 0.2},
                          .T_body_camera = make_pose(R_body_camera, Eigen::Vector3d::Zero()),
                          .max_range_m = 33.0};
  SphericalGrid grid(make_grid_geometry({.theta_min_rad = rad_from_deg(40.0),
                                         .theta_max_rad = rad_from_deg(140.0),
                                         .phi_min_rad = rad_from_deg(-50.0),
                                         .phi_max_rad = rad_from_deg(50.0),
                                         .step_rad = rad_from_deg(1.0)}));
  cv::Mat1f disparity(360, 640);
  cv::RNG(1).fill(disparity, cv::RNG::UNIFORM, 4.0, 60.0);
  while (state.KeepRunning()) {
    grid.clear();
    benchmark::DoNotOptimize(accumulate(disparity, pair, grid));
  }
}

BENCHMARK(accumulate_image)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace skyhalo

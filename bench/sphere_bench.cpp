// From disparities to the halo and the velocities that it allows. Each row names what it does;
// threads are one unless the row says otherwise.
#include <benchmark/benchmark.h>
#include <tbb/global_control.h>

#include <array>
#include <cmath>
#include <limits>
#include <opencv2/core.hpp>

#include "skyhalo/geometry/angle.hpp"
#include "skyhalo/safety/velocity_limiter.hpp"
#include "skyhalo/sphere/accumulate.hpp"
#include "skyhalo/sphere/halo.hpp"
#include "skyhalo/sphere/halo_query.hpp"

namespace skyhalo {
namespace {

const cv::Size kSize(640, 360);
constexpr double kStepDeg = 2.0;

Eigen::Matrix3d forward_camera() {
  Eigen::Matrix3d R_body_camera;
  R_body_camera << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  return R_body_camera;
}

/// A pair 0.2 m beside the body origin, turned to the left: 91 degrees across as a pinhole, 170 as
/// a spherical pair.
PairGeometry pair_of(bool spherical, double yaw_deg) {
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(rad_from_deg(yaw_deg), Eigen::Vector3d::UnitZ()).toRotationMatrix();
  PairGeometry pair{
      .model = PinholePair{.focal_px = 314.0,
                           .principal_u_px = 319.5,
                           .principal_v_px = 179.5,
                           .baseline_m = 0.15},
      .T_body_camera = make_pose(turn * forward_camera(), turn * Eigen::Vector3d(0.2, -0.05, 0.05)),
      .max_range_m = 33.0};
  if (spherical) {
    pair.model = SphericalPair{.delta_theta_u_rad = rad_from_deg(170.0 / 640.0),
                               .delta_theta_v_rad = rad_from_deg(95.0 / 360.0),
                               .principal_u_px = 319.5,
                               .principal_v_px = 179.5,
                               .baseline_m = 0.15};
  }
  return pair;
}

/// Walls and ground with a third of a pixel of noise, a fifth of the pixels without disparity.
cv::Mat1f scene_disparity() {
  cv::RNG random(7);
  cv::Mat1f disparity(kSize);
  for (int v = 0; v < kSize.height; ++v) {
    for (int u = 0; u < kSize.width; ++u) {
      const double wall = 4.0 + 10.0 * (u / 160 % 2) + 0.01 * u;
      const double ground = 0.12 * (v - 180);
      const double d = std::max(wall, ground) + random.gaussian(0.33);
      disparity(v, u) = random.uniform(0.0, 1.0) < 0.2 ? std::numeric_limits<float>::quiet_NaN()
                                                       : static_cast<float>(d);
    }
  }
  return disparity;
}

GridGeometry grid_of(const PairGeometry& pair, double step_deg) {
  GridBounds bounds{0.0, rad_from_deg(180), rad_from_deg(-180), rad_from_deg(180), 0.0};
  bounds.step_rad = rad_from_deg(step_deg);
  return grid_of_view(pair, kSize, bounds, 0.5);
}

constexpr SeenRule kSeen{.near_m = 1.5};

/// A grid, as the pipeline fills it.
class Filler {
 public:
  Filler(const PairGeometry& pair, double step_deg, DepthRuleKind kind)
      : grid(grid_of(pair, step_deg), {.kind = kind}),
        accumulator_(pair, kSize, grid.geometry(), grid.rule(), kSeen) {}

  PixelCounts fill(const cv::Mat1f& disparity) {
    grid.clear();
    return accumulator_.accumulate(disparity, grid);
  }

  SphericalGrid grid;

 private:
  Accumulator accumulator_;
};

void accumulate_640x360(benchmark::State& state, bool spherical, DepthRuleKind kind, int threads) {
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                  static_cast<std::size_t>(threads));
  const cv::Mat1f disparity = scene_disparity();
  Filler filler(pair_of(spherical, 0.0), kStepDeg, kind);
  while (state.KeepRunning()) {
    benchmark::DoNotOptimize(filler.fill(disparity));
  }
  state.counters["cells_with_depth"] = filler.grid.occupied_cell_count();
}

/// The reference platform's four pairs: ahead, left, right and below.
struct FourPairs {
  FourPairs() {
    const cv::Mat1f disparity = scene_disparity();
    PairGeometry down = pair_of(false, 0.0);
    down.T_body_camera.linear() =
        Eigen::AngleAxisd(rad_from_deg(90.0), Eigen::Vector3d::UnitY()).toRotationMatrix() *
        forward_camera();
    for (const PairGeometry& pair :
         {pair_of(false, 0.0), pair_of(true, 100.0), pair_of(true, -100.0), down}) {
      fillers.emplace_back(pair, kStepDeg, DepthRuleKind::kNearest);
      (void)fillers.back().fill(disparity);
    }
    for (const Filler& filler : fillers) {
      grids.push_back({&filler.grid, Timestamp()});
    }
    halo.stitch(grids);
  }

  std::vector<Filler> fillers;
  std::vector<PairGrid> grids;
  Halo halo{rad_from_deg(kStepDeg)};
};

void stitch4(benchmark::State& state) {
  FourPairs pairs;
  while (state.KeepRunning()) {
    pairs.halo.stitch(pairs.grids);
    benchmark::DoNotOptimize(pairs.halo.depths_m().data());
  }
}

void velocity(benchmark::State& state, double speed_mps) {
  const FourPairs pairs;
  VelocityLimiter limiter({}, pairs.halo);
  const Motion motion{.desired_mps = speed_mps * Eigen::Vector3d(1.0, 0.3, -0.1).normalized(),
                      .velocity_mps = {1.0, 0.0, 0.0}};
  while (state.KeepRunning()) {
    benchmark::DoNotOptimize(limiter.limit(pairs.halo, motion));
  }
}

/// Things all round at less than 3 m: every cell limits.
void velocity_in_a_box(benchmark::State& state) {
  Halo halo(rad_from_deg(kStepDeg));
  for (int i = 0; i < halo.geometry().cell_count(); ++i) {
    const Eigen::Vector3f ray = halo.directions()[static_cast<std::size_t>(i)];
    const float range_m = 1.5F / ray.cwiseAbs().maxCoeff();
    halo.set({i / halo.geometry().cols, i % halo.geometry().cols}, range_m, range_m);
  }
  VelocityLimiter limiter({}, halo);
  const Motion motion{.desired_mps = {6.0, 5.0, 4.0}, .velocity_mps = {1.0, 0.0, 0.0}};
  while (state.KeepRunning()) {
    benchmark::DoNotOptimize(limiter.limit(halo, motion));
  }
}

void ring(benchmark::State& state) {
  const FourPairs pairs;
  while (state.KeepRunning()) {
    benchmark::DoNotOptimize(ring_of(
        pairs.halo, {rad_from_deg(-10.0), rad_from_deg(10.0)}, Eigen::Matrix3d::Identity()));
  }
}

void tube(benchmark::State& state) {
  const FourPairs pairs;
  while (state.KeepRunning()) {
    benchmark::DoNotOptimize(view_along_tube(pairs.halo, {.radius_m = 0.5, .distance_m = 10.0}));
  }
}

using enum DepthRuleKind;
constexpr auto kMs = benchmark::kMillisecond;
BENCHMARK_CAPTURE(accumulate_640x360, pinhole, false, kNearest, 1)->Unit(kMs);
BENCHMARK_CAPTURE(accumulate_640x360, spherical, true, kNearest, 1)->Unit(kMs);
BENCHMARK_CAPTURE(accumulate_640x360, pinhole_thesis, false, kThesis, 1)->Unit(kMs);
BENCHMARK_CAPTURE(accumulate_640x360, spherical_thesis, true, kThesis, 1)->Unit(kMs);
BENCHMARK_CAPTURE(accumulate_640x360, pinhole_quantile, false, kQuantile, 1)->Unit(kMs);
BENCHMARK_CAPTURE(accumulate_640x360, spherical_quantile, true, kQuantile, 1)->Unit(kMs);
BENCHMARK_CAPTURE(accumulate_640x360, pinhole_two_threads, false, kNearest, 2)
    ->Unit(kMs)
    ->UseRealTime();
BENCHMARK_CAPTURE(accumulate_640x360, spherical_two_threads, true, kNearest, 2)
    ->Unit(kMs)
    ->UseRealTime();
BENCHMARK(stitch4)->Unit(kMs);
BENCHMARK_CAPTURE(velocity, at_5_mps, 5.0)->Unit(kMs);
BENCHMARK_CAPTURE(velocity, at_15_mps, 15.0)->Unit(kMs);
BENCHMARK(velocity_in_a_box)->Unit(kMs);
BENCHMARK(ring)->Unit(kMs);
BENCHMARK(tube)->Unit(kMs);

}  // namespace
}  // namespace skyhalo

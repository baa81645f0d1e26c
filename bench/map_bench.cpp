#include <benchmark/benchmark.h>
#include <octomap/OcTree.h>

#include <vector>

#include "skyhalo/camera/pinhole_pair.hpp"
#include "skyhalo/geometry/angle.hpp"
#include "skyhalo/geometry/spherical.hpp"
#include "skyhalo/map/integrate.hpp"

namespace skyhalo {
namespace {

/// A scan of a 20 x 20 x 6 m room from its middle: 16 200 rays, 2 degrees apart over the whole
/// sphere.
std::vector<Eigen::Vector3d> room_scan() {
  std::vector<Eigen::Vector3d> points_m;
  const Eigen::Vector3d half_m(10.0, 10.0, 3.0);
  for (int row = 0; row < 90; ++row) {
    for (int col = 0; col < 180; ++col) {
      const Eigen::Vector3d ray =
          direction(rad_from_deg(2.0 * row + 1.0), rad_from_deg(2.0 * col - 179.0));
      points_m.push_back(ray * (half_m.array() / ray.array().abs()).minCoeff());
    }
  }
  return points_m;
}

/// Cells of `range(0)` cm.
double voxel_m(const benchmark::State& state) {
  return static_cast<double>(state.range(0)) * 0.01;
}

void room_dense(benchmark::State& state) {
  const std::vector<Eigen::Vector3d> points_m = room_scan();
  const Eigen::AlignedBox3d bounds(Eigen::Vector3d(-11, -11, -4), Eigen::Vector3d(11, 11, 4));
  DenseMap map(make_voxel_grid(bounds, voxel_m(state)));
  const PinholePair pair{.focal_px = 320.0, .baseline_m = 0.2};
  const SensorModelConfig sensor;
  while (state.KeepRunning()) {
    for (const Eigen::Vector3d& point_m : points_m) {
      const double z_m = point_m.norm();
      const InverseSensorModel model(sensor, z_m, delta_z_m(pair, z_m, sensor.delta_d_px));
      integrate({Eigen::Vector3d::Zero(), point_m / z_m}, model, 5000, map);
    }
  }
}

void room_octomap(benchmark::State& state) {
  octomap::Pointcloud cloud;
  for (const Eigen::Vector3d& point_m : room_scan()) {
    cloud.push_back(static_cast<float>(point_m.x()),
                    static_cast<float>(point_m.y()),
                    static_cast<float>(point_m.z()));
  }
  octomap::OcTree tree(voxel_m(state));
  while (state.KeepRunning()) {
    tree.insertPointCloud(cloud, octomap::point3d(0, 0, 0));
  }
}

BENCHMARK(room_dense)->ArgName("voxel_cm")->Arg(25)->Arg(10)->Unit(benchmark::kMillisecond);
BENCHMARK(room_octomap)->ArgName("voxel_cm")->Arg(25)->Arg(10)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace skyhalo

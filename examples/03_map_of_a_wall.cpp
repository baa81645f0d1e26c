// Ranges with a stereo sensor model become an occupancy map, which is asked at points and saved.

#include <cstdio>

#include "skyhalo/camera/pinhole_pair.hpp"
#include "skyhalo/io/map_file.hpp"
#include "skyhalo/io/ply.hpp"
#include "skyhalo/map/scan_integrator.hpp"

namespace {

const char* word_for(skyhalo::LogOdds cell) {
  if (cell == skyhalo::kUnknown) {
    return "unknown";
  }
  return skyhalo::probability_of(cell) > 0.7 ? "occupied" : "free";
}

}  // namespace

int main() {
  const Eigen::AlignedBox3d bounds(Eigen::Vector3d(0, -4, -2), Eigen::Vector3d(8, 4, 2));
  skyhalo::DenseMap map(skyhalo::make_voxel_grid(bounds, 0.25));

  // A wall 5.1 m ahead, seen from the origin by a pair with f 400 px and a baseline of 0.2 m.
  const skyhalo::PinholePair pair{.focal_px = 400, .baseline_m = 0.2};
  const skyhalo::SensorModelConfig sensor;
  skyhalo::RangeScan scan(180);  // directions of 1 degree
  for (int row = 70; row < 110; ++row) {
    for (int col = 160; col < 200; ++col) {
      const double z_m = 5.1 / scan.direction(row, col).x();
      const double uncertainty_m = delta_z_m(pair, z_m, sensor.delta_d_px);
      scan.set_depth(row, col, static_cast<float>(z_m), static_cast<float>(uncertainty_m));
    }
  }
  skyhalo::ScanIntegrator({.sensor = sensor}).integrate(scan, skyhalo::Pose::Identity(), map);

  for (const double x_m : {2.0, 5.1, 7.0}) {
    std::printf("%.0f m ahead: %s\n", x_m, word_for(map.at_point({x_m, 0.1, 0.05})));
  }
  skyhalo::write_ply("wall.ply", skyhalo::occupied_points(map, 0.7));
  return 0;
}

#include "map_flight.hpp"

#include <algorithm>
#include <cmath>

#include "skyhalo/geometry/angle.hpp"

namespace skyhalo::bench {
namespace {

constexpr double kStepM = 0.5;

/// Along x, level, with 2 degrees of turn from scan to scan.
Pose pose_of(const std::string& scene_name, int scan) {
  const double height_m = scene_name == "room" ? 1.52 : 2.02;
  const Eigen::Vector3d position_m(kStepM * scan - 5.77, 0.31, height_m);
  const Eigen::AngleAxisd turn(rad_from_deg(2.0 * scan), Eigen::Vector3d::UnitZ());
  return make_pose(turn.toRotationMatrix(), position_m);
}

double uncertainty_m(Sensor sensor, double z_m) {
  return sensor == Sensor::kLaser ? 0.01 : std::max(0.01, 0.5 * z_m * z_m / 64.0);
}

octomap::point3d point_of(const Eigen::Vector3d& p_m) {
  return {static_cast<float>(p_m.x()), static_cast<float>(p_m.y()), static_cast<float>(p_m.z())};
}

FlownScan scan_from(const testing::MapScene& scene,
                    const Pose& T_map_body,
                    int rows,
                    Sensor sensor) {
  FlownScan flown{RangeScan(rows), T_map_body, {}, {}};
  for (int row = 0; row < flown.scan.rows(); ++row) {
    for (int col = 0; col < flown.scan.cols(); ++col) {
      const Ray ray{T_map_body.translation(), T_map_body.linear() * flown.scan.direction(row, col)};
      const double z_m = scene.range_m(ray);
      const bool is_hit = z_m <= kRangeM;
      const Eigen::Vector3d end_m = ray.origin_m + (is_hit ? z_m : kRangeM + 0.5) * ray.direction;
      flown.cloud.push_back(point_of(end_m));
      if (is_hit) {
        flown.scan.set_depth(
            row, col, static_cast<float>(z_m), static_cast<float>(uncertainty_m(sensor, z_m)));
        flown.ends_m.push_back(end_m);
      } else {
        flown.scan.set_free(row, col, static_cast<float>(kRangeM));
      }
    }
  }
  return flown;
}

/// The box of the scene that a sensor on the way can see, and half a metre more.
Eigen::AlignedBox3d bounds_of(const Flight& flight) {
  Eigen::AlignedBox3d seen_m;
  for (const FlownScan& scan : flight.scans) {
    const Eigen::Vector3d reach_m = Eigen::Vector3d::Constant(kRangeM);
    seen_m.extend(scan.T_map_body.translation() - reach_m);
    seen_m.extend(scan.T_map_body.translation() + reach_m);
  }
  if (flight.scene.room_m) {
    seen_m = seen_m.intersection(*flight.scene.room_m);
  }
  if (flight.scene.ground_m) {
    seen_m.min().z() = *flight.scene.ground_m;
  }
  const Eigen::Vector3d min_m = (2.0 * (seen_m.min().array() - 0.5)).floor() / 2.0;
  const Eigen::Vector3d max_m = (2.0 * (seen_m.max().array() + 0.5)).ceil() / 2.0;
  return {min_m, max_m};
}

}  // namespace

Flight fly(const std::string& scene_name, int rows, int scan_count, Sensor sensor) {
  Flight flight;
  flight.scene_name = scene_name;
  flight.scene = scene_name == "room" ? testing::room_scene() : testing::open_scene();
  for (int scan = 0; scan < scan_count; ++scan) {
    flight.scans.push_back(scan_from(flight.scene, pose_of(scene_name, scan), rows, sensor));
  }
  flight.bounds_m = bounds_of(flight);
  return flight;
}

}  // namespace skyhalo::bench

#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <optional>
#include <vector>

#include "support/solids.hpp"

namespace skyhalo::testing {

/// A made-up world to map: a hollow room or open ground, with solid pillars and boxes in it. What
/// is outside the room or below the ground is solid. All in m, in the map frame.
struct MapScene {
  std::optional<Eigen::AlignedBox3d> room_m = {};
  std::optional<double> ground_m = {};
  std::vector<Pillar> pillars = {};
  std::vector<Eigen::AlignedBox3d> boxes_m = {};

  /// Where a ray from free space first meets a surface (m); infinite when it meets none.
  [[nodiscard]] double range_m(const Ray& ray) const;

  /// True inside a solid.
  [[nodiscard]] bool is_solid(const Eigen::Vector3d& point_m) const;

  /// True when a surface passes through a cube, or touches it.
  [[nodiscard]] bool has_surface(const Eigen::AlignedBox3d& cube_m) const;
};

inline double MapScene::range_m(const Ray& ray) const {
  double nearest_m = kNowhereM;
  if (room_m) {
    nearest_m = std::max(0.0, inside_of(ray, *room_m).leave_m);
  }
  if (ground_m && ray.direction.z() < 0.0) {
    nearest_m = std::min(nearest_m, (*ground_m - ray.origin_m.z()) / ray.direction.z());
  }
  for (const Pillar& pillar : pillars) {
    nearest_m = std::min(nearest_m, range_to(inside_of(ray, pillar)));
  }
  for (const Eigen::AlignedBox3d& box_m : boxes_m) {
    nearest_m = std::min(nearest_m, range_to(inside_of(ray, box_m)));
  }
  return nearest_m;
}

inline bool MapScene::is_solid(const Eigen::Vector3d& point_m) const {
  return (room_m && !room_m->contains(point_m)) || (ground_m && point_m.z() < *ground_m) ||
         std::any_of(pillars.begin(),
                     pillars.end(),
                     [&](const Pillar& pillar) {
                       return (point_m.head<2>() - pillar.middle_m).norm() < pillar.radius_m &&
                              point_m.z() > pillar.bottom_m && point_m.z() < pillar.top_m;
                     }) ||
         std::any_of(boxes_m.begin(), boxes_m.end(), [&](const Eigen::AlignedBox3d& box_m) {
           return box_m.contains(point_m);
         });
}

inline bool MapScene::has_surface(const Eigen::AlignedBox3d& cube_m) const {
  const auto cuts_cube = [&](const auto& thing) { return cuts(thing, cube_m); };
  return (room_m && cuts(*room_m, cube_m)) ||
         (ground_m && cube_m.min().z() <= *ground_m && cube_m.max().z() >= *ground_m) ||
         std::any_of(pillars.begin(), pillars.end(), cuts_cube) ||
         std::any_of(boxes_m.begin(), boxes_m.end(), cuts_cube);
}

/// A room of 20 x 20 x 6 m with eight pillars from floor to ceiling. Its walls run through the
/// middles of cells of 0.1 m, and near those of 0.25 m, of a lattice that begins at the origin: so
/// no cell is both free and nearer to a wall than a sensor can tell.
inline MapScene room_scene() {
  MapScene scene;
  scene.room_m = Eigen::AlignedBox3d(Eigen::Vector3d(-10.15, -10.15, -0.15),
                                     Eigen::Vector3d(9.85, 9.85, 5.85));
  for (const double x_m : {-6.0, -2.0, 2.0, 6.0}) {
    for (const double y_m : {-4.0, 5.0}) {
      scene.pillars.push_back({{x_m, y_m}, 0.25, -0.15, 5.85});
    }
  }
  return scene;
}

/// Open ground with sixteen pillars, 5 m high; in the middle of cells as the room's floor.
inline MapScene open_scene() {
  MapScene scene;
  scene.ground_m = -0.15;
  for (const double x_m : {-12.0, -4.0, 4.0, 12.0}) {
    for (const double y_m : {-11.0, -4.0, 5.0, 12.0}) {
      scene.pillars.push_back({{x_m, y_m}, 0.25, -0.15, 4.85});
    }
  }
  return scene;
}

}  // namespace skyhalo::testing

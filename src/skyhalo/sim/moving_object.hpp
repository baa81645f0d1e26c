#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "skyhalo/geometry/pose.hpp"
#include "skyhalo/sim/triangle_mesh.hpp"

namespace skyhalo {

/// A way along straight lines, gone at one speed. A closed one begins again at its end; an open one
/// is gone there and back.
struct Route {
  std::vector<Eigen::Vector3d> points_m;  ///< at least two, scene frame
  double speed_mps = 1.0;                 ///< >= 0
  double start_m = 0.0;                   ///< how far along the route the object is at t = 0
  bool closed = false;
};

/// A car, a person or another thing that keeps its shape and follows a route.
struct MovingObject {
  std::string type;   ///< as in KITTI's labels: Car, Pedestrian, Cyclist, Misc, ...
  int track = 0;      ///< its number
  TriangleMesh mesh;  ///< x forward, z up, origin in the middle of its underside
  Eigen::Vector3d size_m = Eigen::Vector3d::Ones();  ///< length, width, height of its box
  Route route;
};

/// Where the object is at a time (s): its axes to the scene's. It heads along its route and rounds
/// the route's corners over its own length.
[[nodiscard]] Pose T_scene_object(const MovingObject& object, double t_s);

}  // namespace skyhalo

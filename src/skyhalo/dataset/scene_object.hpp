#pragma once

#include <string>

#include "skyhalo/geometry/oriented_box.hpp"
#include "skyhalo/geometry/pose.hpp"

namespace skyhalo {

/// A thing that is followed from frame to frame and whose box is known.
struct SceneObject {
  int track = 0;                                     ///< >= 0, the same in every frame
  std::string type;                                  ///< one word: Car, Pedestrian, ...
  Eigen::Vector3d size_m = Eigen::Vector3d::Ones();  ///< length (x), width (y), height (z), > 0
  Pose T_map_object = Pose::Identity();  ///< origin at the bottom's centre, x forward, z up
  int occluded = 0;  ///< 0 wholly seen, 1 partly hidden, 2 largely hidden, 3 unknown
};

/// The box of an object (m) in the frame that `T_frame_object` leads to.
[[nodiscard]] OrientedBox box_of(const SceneObject& object, const Pose& T_frame_object);

/// Throws `Error` (input) naming the frame and the object when its track is below 0, its type is
/// not one word, its size is not above 0, its pose is not finite or rigid, or `occluded` is not in
/// 0...3.
void check(const SceneObject& object, int frame);

}  // namespace skyhalo

#include "skyhalo/dataset/scene_object.hpp"

#include <algorithm>
#include <string_view>

#include "skyhalo/dataset/frame_checks.hpp"

namespace skyhalo {
namespace {

bool is_one_word(std::string_view text) {
  return !text.empty() && std::all_of(text.begin(), text.end(), [](char c) {
    return c > ' ' && c != ',' && c != '\x7f';
  });
}

}  // namespace

OrientedBox box_of(const SceneObject& object, const Pose& T_frame_object) {
  const Eigen::Vector3d corner_m(-object.size_m.x() / 2.0, -object.size_m.y() / 2.0, 0.0);
  return {T_frame_object * corner_m, T_frame_object.linear() * object.size_m.asDiagonal()};
}

void check(const SceneObject& object, int frame) {
  const std::string which = "object " + std::to_string(object.track);
  if (object.track < 0) {
    throw frame_error(frame, which + ": expected a track >= 0");
  }
  if (!is_one_word(object.type)) {
    throw frame_error(frame, which + ": expected a type of one word, found '" + object.type + "'");
  }
  if (!object.size_m.allFinite() || object.size_m.minCoeff() <= 0.0) {
    throw frame_error(frame, which + ": expected a length, width and height above 0 m");
  }
  if (object.occluded < 0 || object.occluded > 3) {
    throw frame_error(frame, which + ": occluded: expected 0, 1, 2 or 3");
  }
  check_rigid(object.T_map_object, frame, which);
}

}  // namespace skyhalo

#include "skyhalo/geometry/oriented_box.hpp"

#include <Eigen/Geometry>
#include <algorithm>

namespace skyhalo {
namespace {

bool between_faces(const Eigen::Vector3d& normal,
                   const Eigen::Vector3d& edge_m,
                   const Eigen::Vector3d& offset_m) noexcept {
  const double end = normal.dot(edge_m);
  const double at = normal.dot(offset_m);
  return std::min(0.0, end) <= at && at <= std::max(0.0, end);
}

}  // namespace

bool contains(const OrientedBox& box, const Eigen::Vector3d& point_m) noexcept {
  const Eigen::Vector3d to_p1 = box.edges_m.col(0);
  const Eigen::Vector3d to_p3 = box.edges_m.col(1);
  const Eigen::Vector3d to_p4 = box.edges_m.col(2);
  const Eigen::Vector3d offset_m = point_m - box.corner_m;
  return between_faces(to_p3.cross(to_p4), to_p1, offset_m) &&
         between_faces(to_p1.cross(to_p4), to_p3, offset_m) &&
         between_faces(to_p1.cross(to_p3), to_p4, offset_m);
}

}  // namespace skyhalo

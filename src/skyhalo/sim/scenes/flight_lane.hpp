#pragma once

#include <Eigen/Core>
#include <functional>
#include <numbers>
#include <vector>

namespace skyhalo {

/// How near to its route a scene lets a solid come (m). A flight that rounds the route's corners
/// still finds 1.2 m.
constexpr float kLaneM = 1.6F;

/// The way that a scene keeps clear for a flight.
class FlightLane {
 public:
  /// At least two points in the scene frame.
  FlightLane(std::vector<Eigen::Vector3d> points_m, bool closed);

  [[nodiscard]] const std::vector<Eigen::Vector3d>& points_m() const noexcept { return points_m_; }

  [[nodiscard]] bool closed() const noexcept { return closed_; }

  /// From a point to the nearest one of the way.
  [[nodiscard]] float distance_m(const Eigen::Vector3f& point_m) const noexcept;

  /// The same seen from above.
  [[nodiscard]] float distance_on_map_m(const Eigen::Vector3f& point_m) const noexcept;

 private:
  std::vector<Eigen::Vector3d> points_m_;
  std::vector<Eigen::Vector3f> corners_m_;  // the first again at the end of a closed way
  bool closed_;
};

/// `count` points of a closed curve; `at` is given the angle in 0...2 pi.
[[nodiscard]] std::vector<Eigen::Vector3d> closed_curve(
    int count, const std::function<Eigen::Vector3d(double angle_rad)>& at);

/// `count` points, at least 2, of an open curve; `at` is given 0...1.
[[nodiscard]] std::vector<Eigen::Vector3d> open_curve(
    int count, const std::function<Eigen::Vector3d(double share)>& at);

}  // namespace skyhalo

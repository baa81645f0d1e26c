#include "skyhalo/sim/scenes/flight_lane.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace skyhalo {
namespace {

float square_distance(const Eigen::Vector3f& point,
                      const Eigen::Vector3f& from,
                      const Eigen::Vector3f& to) noexcept {
  const Eigen::Vector3f along = to - from;
  const float share = (point - from).dot(along) / std::max(along.squaredNorm(), 1e-9F);
  return (point - from - std::clamp(share, 0.0F, 1.0F) * along).squaredNorm();
}

Eigen::Vector3f flat(const Eigen::Vector3f& point) noexcept {
  return {point.x(), point.y(), 0.0F};
}

}  // namespace

FlightLane::FlightLane(std::vector<Eigen::Vector3d> points_m, bool closed)
    : points_m_(std::move(points_m)), closed_(closed) {
  for (const Eigen::Vector3d& point_m : points_m_) {
    corners_m_.push_back(point_m.cast<float>());
  }
  if (closed_) {
    corners_m_.push_back(corners_m_.front());
  }
}

float FlightLane::distance_m(const Eigen::Vector3f& point_m) const noexcept {
  float nearest = 1e12F;
  for (std::size_t i = 1; i < corners_m_.size(); ++i) {
    nearest = std::min(nearest, square_distance(point_m, corners_m_[i - 1], corners_m_[i]));
  }
  return std::sqrt(nearest);
}

float FlightLane::distance_on_map_m(const Eigen::Vector3f& point_m) const noexcept {
  float nearest = 1e12F;
  for (std::size_t i = 1; i < corners_m_.size(); ++i) {
    nearest = std::min(
        nearest, square_distance(flat(point_m), flat(corners_m_[i - 1]), flat(corners_m_[i])));
  }
  return std::sqrt(nearest);
}

std::vector<Eigen::Vector3d> closed_curve(
    int count, const std::function<Eigen::Vector3d(double angle_rad)>& at) {
  std::vector<Eigen::Vector3d> points;
  points.reserve(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) {
    points.push_back(at(2.0 * std::numbers::pi * i / count));
  }
  return points;
}

std::vector<Eigen::Vector3d> open_curve(int count,
                                        const std::function<Eigen::Vector3d(double share)>& at) {
  std::vector<Eigen::Vector3d> points;
  points.reserve(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) {
    points.push_back(at(static_cast<double>(i) / (count - 1)));
  }
  return points;
}

}  // namespace skyhalo

#include "skyhalo/sim/moving_object.hpp"

#include <algorithm>
#include <cmath>

namespace skyhalo {
namespace {

constexpr double kShortestM = 1e-3;

/// A route as a ring: an open one is gone there and back.
class Ring {
 public:
  explicit Ring(const Route& route) : points_m_(route.points_m) {
    if (!route.closed && points_m_.size() > 2) {
      points_m_.insert(points_m_.end(), route.points_m.rbegin() + 1, route.points_m.rend() - 1);
    }
    ends_m_.reserve(points_m_.size());
    for (std::size_t i = 0; i < points_m_.size(); ++i) {
      length_m_ += (after(i) - points_m_[i]).norm();
      ends_m_.push_back(length_m_);
    }
  }

  /// True when there is a way at all.
  [[nodiscard]] bool leads() const { return length_m_ > kShortestM && std::isfinite(length_m_); }

  [[nodiscard]] double length_m() const { return length_m_; }

  /// The point `s_m` along the ring.
  [[nodiscard]] Eigen::Vector3d at(double s_m) const {
    const double s = within(s_m);
    const std::size_t i = piece(s);
    const double begin_m = i == 0 ? 0.0 : ends_m_[i - 1];
    const double piece_m = ends_m_[i] - begin_m;
    const double share = piece_m > 0.0 ? std::clamp((s - begin_m) / piece_m, 0.0, 1.0) : 0.0;
    return points_m_[i] + share * (after(i) - points_m_[i]);
  }

  /// The mean of all points within `half_m` of `s_m`, exactly: in pieces on which it is straight.
  [[nodiscard]] Eigen::Vector3d mean(double s_m, double half_m) const {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    double from_m = s_m - half_m;
    const double to_m = s_m + half_m;
    while (from_m < to_m) {
      const double here = within(from_m);
      const double rest_m = ends_m_[piece(here)] - here;
      const double next_m = std::min(to_m, from_m + std::max(rest_m, 1e-6));
      sum += (next_m - from_m) * 0.5 * (at(from_m) + at(next_m));
      from_m = next_m;
    }
    return sum / (2.0 * half_m);
  }

 private:
  [[nodiscard]] const Eigen::Vector3d& after(std::size_t i) const {
    return points_m_[(i + 1) % points_m_.size()];
  }

  [[nodiscard]] double within(double s_m) const {
    return s_m - length_m_ * std::floor(s_m / length_m_);
  }

  [[nodiscard]] std::size_t piece(double s_m) const {
    const auto end = std::upper_bound(ends_m_.begin(), ends_m_.end(), s_m);
    return std::min(static_cast<std::size_t>(end - ends_m_.begin()), ends_m_.size() - 1);
  }

  std::vector<Eigen::Vector3d> points_m_;
  std::vector<double> ends_m_;
  double length_m_ = 0.0;
};

/// How far along an open route's ring it is to the nearer turning point, signed: negative before.
double past_turn_m(double s_m, double ring_m) {
  const double half_m = 0.5 * ring_m;
  return s_m - half_m * std::round(s_m / half_m);
}

/// The way it heads (m, not normalised). The mean position's velocity; where an open route turns
/// back, that passes zero, and the object turns about to its left instead.
Eigen::Vector3d heading(const Ring& ring, double s_m, double half_m, bool closed) {
  Eigen::Vector3d way = ring.at(s_m + half_m) - ring.at(s_m - half_m);
  const double past_m = past_turn_m(s_m, ring.length_m());
  if (!closed && std::abs(past_m) < half_m) {
    const double turn_m = s_m - past_m;
    const Eigen::Vector3d inwards = ring.at(turn_m - half_m) - ring.at(turn_m);
    const Eigen::Vector3d left(inwards.y(), -inwards.x(), 0.0);
    way += 2.0 * (1.0 - past_m * past_m / (half_m * half_m)) * left;
  }
  return way;
}

}  // namespace

Pose T_scene_object(const MovingObject& object, double t_s) {
  const Route& route = object.route;
  Pose T = Pose::Identity();
  if (route.points_m.empty()) {
    return T;
  }
  const Ring ring(route);
  double s_m = route.start_m + route.speed_mps * t_s;
  s_m = std::isfinite(s_m) ? s_m : 0.0;
  if (!ring.leads()) {
    T.translation() = route.points_m.front();
    return T;
  }
  s_m -= ring.length_m() * std::floor(s_m / ring.length_m());
  const double longest_m = std::max(kShortestM, 0.25 * ring.length_m());
  const double half_m = std::max(kShortestM, std::min(longest_m, 0.5 * object.size_m.x()));
  T.translation() = ring.mean(s_m, half_m);
  const Eigen::Vector3d way = heading(ring, s_m, half_m, route.closed);
  T.linear() =
      Eigen::AngleAxisd(std::atan2(way.y(), way.x()), Eigen::Vector3d::UnitZ()).toRotationMatrix();
  return T;
}

}  // namespace skyhalo

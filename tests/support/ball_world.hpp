#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <random>
#include <span>
#include <variant>
#include <vector>

#include "skyhalo/geometry/angle.hpp"
#include "skyhalo/sphere/halo.hpp"

namespace skyhalo::testing {

constexpr double kSightM = 30.0;  ///< how far the cameras of a `BallWorld` see

struct Ball {
  Eigen::Vector3d center_m;
  double radius_m;
};

struct Box {
  Eigen::Vector3d center_m;
  Eigen::Vector3d half_m;
};

/// Solid where `normal . p >= offset_m`.
struct Wall {
  Eigen::Vector3d normal;
  double offset_m;
};

/// Something in the way; cameras find no range of what has no texture.
struct Thing {
  std::variant<Ball, Box, Wall> shape;
  bool textured = true;
};

using BallWorld = std::vector<Thing>;

/// The point of the thing that is nearest to `p_m`, which is `p_m` itself inside.
inline Eigen::Vector3d nearest_point(const Thing& thing, const Eigen::Vector3d& p_m) {
  if (const auto* ball = std::get_if<Ball>(&thing.shape)) {
    const Eigen::Vector3d out = p_m - ball->center_m;
    return out.norm() <= ball->radius_m ? p_m : ball->center_m + ball->radius_m * out.normalized();
  }
  if (const auto* box = std::get_if<Box>(&thing.shape)) {
    return p_m.cwiseMax(box->center_m - box->half_m).cwiseMin(box->center_m + box->half_m);
  }
  const auto& wall = std::get<Wall>(thing.shape);
  return p_m + std::max(0.0, wall.offset_m - wall.normal.dot(p_m)) * wall.normal;
}

inline double distance_m(const Thing& thing, const Eigen::Vector3d& p_m) {
  return (nearest_point(thing, p_m) - p_m).norm();
}

/// Range at which a ray (unit direction) from outside the thing meets it; infinity if it does not.
inline double hit_m(const Thing& thing, const Eigen::Vector3d& p_m, const Eigen::Vector3d& ray) {
  constexpr double kMiss = std::numeric_limits<double>::infinity();
  if (const auto* ball = std::get_if<Ball>(&thing.shape)) {
    const Eigen::Vector3d to_center = ball->center_m - p_m;
    const double along_m = to_center.dot(ray);
    const double aside_m = (to_center - along_m * ray).norm();
    const double half_chord2 = ball->radius_m * ball->radius_m - aside_m * aside_m;
    return along_m > 0.0 && half_chord2 >= 0.0 ? along_m - std::sqrt(half_chord2) : kMiss;
  }
  if (const auto* box = std::get_if<Box>(&thing.shape)) {
    double enter_m = 0.0;
    double leave_m = kMiss;
    for (int i = 0; i < 3; ++i) {
      const double to_center_m = box->center_m[i] - p_m[i];
      const double one_m = (to_center_m - box->half_m[i]) / ray[i];
      const double other_m = (to_center_m + box->half_m[i]) / ray[i];
      enter_m = std::max(enter_m, std::min(one_m, other_m));
      leave_m = std::min(leave_m, std::max(one_m, other_m));
    }
    return enter_m <= leave_m ? enter_m : kMiss;
  }
  const auto& wall = std::get<Wall>(thing.shape);
  const double approach = wall.normal.dot(ray);
  return approach > 0.0 ? (wall.offset_m - wall.normal.dot(p_m)) / approach : kMiss;
}

/// What the cameras look at: `|phi| < phi_max`, `|theta - 90 deg| < elevation_max`.
struct View {
  double phi_max_rad = std::numbers::pi;
  double elevation_max_rad = 0.5 * std::numbers::pi;

  [[nodiscard]] bool holds(const Eigen::Vector3d& p_body_m) const {
    const double elevation_rad = std::asin(std::clamp(p_body_m.normalized().z(), -1.0, 1.0));
    return std::abs(std::atan2(p_body_m.y(), p_body_m.x())) <= phi_max_rad &&
           std::abs(elevation_rad) <= elevation_max_rad;
  }
};

inline View all_round() {
  return {};
}

inline View four_pairs() {
  return {.elevation_max_rad = rad_from_deg(50.0)};
}

inline View front_only() {
  return {.phi_max_rad = rad_from_deg(50.0), .elevation_max_rad = rad_from_deg(40.0)};
}

/// Ideal cameras: what they see of a world, by `rays_per_side` squared rays through each cell. A
/// cell in which a ray meets something without texture is not free; it has a depth if another ray
/// meets something with texture before that.
class HaloCaster {
 public:
  HaloCaster(double step_rad, int rays_per_side, const View& view)
      : halo_(step_rad),
        rays_per_cell_(static_cast<std::size_t>(rays_per_side * rays_per_side)),
        half_diagonal_rad_(step_rad / std::numbers::sqrt2) {
    const GridGeometry& grid = halo_.geometry();
    for (int i = 0; i < grid.cell_count(); ++i) {
      const GridCell cell{i / grid.cols, i % grid.cols};
      if (!view.holds(grid.center_direction(cell))) {
        continue;
      }
      cells_.push_back(cell);
      centers_body_.push_back(grid.center_direction(cell));
      for (int ray = 0; ray < rays_per_side * rays_per_side; ++ray) {
        const double down = (ray / rays_per_side + 0.5) / rays_per_side;
        const double left = (ray % rays_per_side + 0.5) / rays_per_side;
        rays_body_.push_back(direction(grid.theta_min_rad + (cell.row + down) * step_rad,
                                       grid.phi_min_rad + (cell.col + left) * step_rad));
      }
    }
    hits_.resize(rays_body_.size());
  }

  const Halo& look(const BallWorld& world,
                   const Eigen::Matrix3d& R_map_body,
                   const Eigen::Vector3d& p_map_m) {
    std::fill(hits_.begin(), hits_.end(), Hit{});
    for (const Thing& thing : world) {
      look_at(thing, R_map_body, p_map_m);
    }
    points_map_m_.clear();
    for (std::size_t i = 0; i < cells_.size(); ++i) {
      settle(i, R_map_body, p_map_m);
    }
    return halo_;
  }

  [[nodiscard]] const Halo& halo() const { return halo_; }

  /// Where the nearest rays of the cells with a depth met something (map).
  [[nodiscard]] std::span<const Eigen::Vector3d> points_map_m() const { return points_map_m_; }

 private:
  struct Hit {
    double range_m = kSightM;
    bool textured = true;
  };

  /// Only the cells that the thing can be in.
  void look_at(const Thing& thing, const Eigen::Matrix3d& R_map_body, const Eigen::Vector3d& p_m) {
    Eigen::Vector3d toward_body = Eigen::Vector3d::UnitX();
    double cosine = -1.0;
    if (const auto* wall = std::get_if<Wall>(&thing.shape)) {
      toward_body = R_map_body.transpose() * wall->normal;
      cosine = std::cos(std::min(std::acos(0.0) + half_diagonal_rad_, std::numbers::pi));
    } else {
      const auto* box = std::get_if<Box>(&thing.shape);
      const Eigen::Vector3d center = box ? box->center_m : std::get<Ball>(thing.shape).center_m;
      const double round_m = box ? box->half_m.norm() : std::get<Ball>(thing.shape).radius_m;
      const double range_m = (center - p_m).norm();
      if (range_m - round_m > kSightM) {
        return;
      }
      if (round_m < range_m) {
        toward_body = R_map_body.transpose() * (center - p_m) / range_m;
        cosine =
            std::cos(std::min(std::asin(round_m / range_m) + half_diagonal_rad_, std::numbers::pi));
      }
    }
    for (std::size_t i = 0; i < cells_.size(); ++i) {
      if (centers_body_[i].dot(toward_body) >= cosine) {
        look_into_cell(i, thing, R_map_body, p_m);
      }
    }
  }

  void look_into_cell(std::size_t cell,
                      const Thing& thing,
                      const Eigen::Matrix3d& R_map_body,
                      const Eigen::Vector3d& p_m) {
    for (std::size_t i = cell * rays_per_cell_; i < (cell + 1) * rays_per_cell_; ++i) {
      const double range_m = hit_m(thing, p_m, R_map_body * rays_body_[i]);
      if (range_m < hits_[i].range_m) {
        hits_[i] = {range_m, thing.textured};
      }
    }
  }

  void settle(std::size_t cell, const Eigen::Matrix3d& R_map_body, const Eigen::Vector3d& p_m) {
    const std::span<const Hit> hits(&hits_[cell * rays_per_cell_], rays_per_cell_);
    double depth_m = kSightM;
    double plain_m = kSightM;
    std::size_t nearest = 0;
    for (std::size_t i = 0; i < hits.size(); ++i) {
      if (!hits[i].textured) {
        plain_m = std::min(plain_m, hits[i].range_m);
      } else if (hits[i].range_m < depth_m) {
        depth_m = hits[i].range_m;
        nearest = cell * rays_per_cell_ + i;
      }
    }
    const bool has_depth = depth_m < plain_m;
    halo_.set(cells_[cell],
              has_depth ? static_cast<float>(depth_m) : std::numeric_limits<float>::quiet_NaN(),
              plain_m < kSightM ? 0.0F : static_cast<float>(kSightM));
    if (has_depth) {
      points_map_m_.push_back(p_m + depth_m * (R_map_body * rays_body_[nearest]));
    }
  }

  Halo halo_;
  std::size_t rays_per_cell_;
  double half_diagonal_rad_;
  std::vector<GridCell> cells_;  // those in view, and for each its middle, rays and hits
  std::vector<Eigen::Vector3d> centers_body_;
  std::vector<Eigen::Vector3d> rays_body_;
  std::vector<Hit> hits_;
  std::vector<Eigen::Vector3d> points_map_m_;
};

inline double uniform(std::mt19937& random, double from, double to) {
  return std::uniform_real_distribution<double>(from, to)(random);
}

inline Eigen::Vector3d random_direction(std::mt19937& random) {
  std::normal_distribution<double> normal;
  Eigen::Vector3d vector(normal(random), normal(random), normal(random));
  return vector.norm() > 1e-6 ? vector.normalized() : Eigen::Vector3d::UnitX();
}

/// A room round the origin.
inline BallWorld random_room(std::mt19937& random) {
  BallWorld room;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double sign : {-1.0, 1.0}) {
      room.push_back({Wall{sign * Eigen::Vector3d::Unit(axis), uniform(random, 3.0, 15.0)}});
    }
  }
  return room;
}

/// Up to `most` walls that lean, at least one.
inline BallWorld random_walls(std::mt19937& random, int most) {
  BallWorld walls(static_cast<std::size_t>(std::uniform_int_distribution<int>(1, most)(random)));
  for (Thing& wall : walls) {
    wall.shape = Wall{random_direction(random), uniform(random, 3.0, 15.0)};
  }
  return walls;
}

inline Thing random_ball_or_box(std::mt19937& random) {
  const Eigen::Vector3d center = uniform(random, 1.5, 14.0) * random_direction(random);
  if (uniform(random, 0.0, 1.0) < 0.5) {
    return {Ball{center, uniform(random, 0.2, 2.0)}};
  }
  const Eigen::Vector3d half(
      uniform(random, 0.1, 3.0), uniform(random, 0.1, 3.0), uniform(random, 0.1, 3.0));
  return {Box{center, half}};
}

/// 10 to 40 things, with texture, none nearer than `free_m` to the origin: balls, boxes along the
/// axes, and a room or some walls that lean.
inline BallWorld random_ball_world(std::mt19937& random, double free_m) {
  BallWorld world = uniform(random, 0.0, 1.0) < 0.5 ? random_room(random) : random_walls(random, 4);
  const auto count = static_cast<std::size_t>(uniform(random, 10.0, 41.0));
  while (world.size() < count) {
    const Thing thing = random_ball_or_box(random);
    if (distance_m(thing, Eigen::Vector3d::Zero()) > free_m) {
      world.push_back(thing);
    }
  }
  return world;
}

}  // namespace skyhalo::testing

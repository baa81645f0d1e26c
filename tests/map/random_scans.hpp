#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>

#include "skyhalo/geometry/pose.hpp"
#include "skyhalo/map/range_scan.hpp"

namespace skyhalo::testing {

using Random = std::mt19937;

inline double between(Random& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

/// A point of a box, each as likely as any other.
inline Eigen::Vector3d point_in(Random& random, const Eigen::AlignedBox3d& box) {
  return {between(random, box.min().x(), box.max().x()),
          between(random, box.min().y(), box.max().y()),
          between(random, box.min().z(), box.max().z())};
}

inline Eigen::Matrix3d any_attitude(Random& random) {
  std::normal_distribution<double> normal;
  const std::array q{normal(random), normal(random), normal(random), normal(random)};
  return Eigen::Quaterniond(q[0], q[1], q[2], q[3]).normalized().toRotationMatrix();
}

/// The range's uncertainty (m) of a pinhole pair of 0.1 m and 400 px, with half a pixel of error.
inline double pair_uncertainty_m(double z_m) {
  return std::max(0.002, z_m * z_m * 0.5 / 40.0);
}

/// A closed room with a pillar in it.
struct Room {
  Eigen::AlignedBox3d walls;
  Eigen::AlignedBox3d pillar;

  /// Range (m) of the first surface from a point, inside or outside of the walls.
  [[nodiscard]] double range_m(const Eigen::Vector3d& from_m, const Eigen::Vector3d& along) const {
    return std::min(surface_m(walls, from_m, along), surface_m(pillar, from_m, along));
  }

  /// Range (m) at which a ray first crosses a box's surface; infinite if never.
  [[nodiscard]] static double surface_m(const Eigen::AlignedBox3d& box,
                                        const Eigen::Vector3d& from_m,
                                        const Eigen::Vector3d& along) {
    const Eigen::Array3d a = (box.min() - from_m).array() / along.array();
    const Eigen::Array3d b = (box.max() - from_m).array() / along.array();
    const double enter_m = a.min(b).maxCoeff();
    const double leave_m = a.max(b).minCoeff();
    if (leave_m <= 0.0 || enter_m >= leave_m) {
      return std::numeric_limits<double>::infinity();
    }
    return enter_m > 0.0 ? enter_m : leave_m;
  }
};

/// A pose in any attitude at a point of a box.
inline Pose pose_in(Random& random, const Eigen::AlignedBox3d& box) {
  const Eigen::Matrix3d R_map_body = any_attitude(random);
  return make_pose(R_map_body, point_in(random, box));
}

/// What is seen of a room from a pose: depths up to `max_range_m`, free to there beyond, some
/// directions unseen, and a cone of the sphere where no sensor looks.
inline RangeScan room_scan(
    Random& random, int rows, const Room& room, const Pose& T_map_body, double max_range_m) {
  RangeScan scan(rows);
  const Eigen::Vector3d blind = any_attitude(random).col(0);
  for (int row = 0; row < rows; ++row) {
    for (int col = 0; col < scan.cols(); ++col) {
      const Eigen::Vector3d u = scan.direction(row, col);
      const double z_m = room.range_m(T_map_body.translation(), T_map_body.linear() * u);
      if (u.dot(blind) > 0.9 || between(random, 0.0, 1.0) < 0.03) {
        continue;
      }
      if (z_m < max_range_m) {
        scan.set_depth(
            row, col, static_cast<float>(z_m), static_cast<float>(pair_uncertainty_m(z_m)));
      } else {
        scan.set_free(row, col, static_cast<float>(max_range_m));
      }
    }
  }
  return scan;
}

/// Depths, free and unseen directions without any order, up to a range; the uncertainties from some
/// millimetres to metres.
inline RangeScan noise_scan(Random& random, int rows, double max_range_m) {
  RangeScan scan(rows);
  for (int row = 0; row < rows; ++row) {
    for (int col = 0; col < scan.cols(); ++col) {
      const double kind = between(random, 0.0, 1.0);
      const auto range_m = static_cast<float>(between(random, 0.1, max_range_m));
      if (kind < 0.5) {
        const double delta_z_m = std::exp(between(random, std::log(0.005), std::log(3.0)));
        scan.set_depth(row, col, range_m, static_cast<float>(delta_z_m));
      } else if (kind < 0.8) {
        scan.set_free(row, col, range_m);
      }
    }
  }
  return scan;
}

}  // namespace skyhalo::testing

#include "laser_check.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <random>

#include "skyhalo/evaluation/ground_truth.hpp"
#include "skyhalo/geometry/spherical.hpp"
#include "skyhalo/sphere/halo_query.hpp"

namespace skyhalo::app {
namespace {

using Points = std::vector<Eigen::Vector3d>;

// How far laser and halo may be apart: the larger of the two.
constexpr double kBoundM = 0.5;
constexpr double kBoundShare = 0.1;

constexpr double kRoadToleranceM = 0.08;
constexpr std::size_t kFewestRoadPoints = 50;
constexpr double kLeastUpright = 0.98;  // cosine of the road's tilt

/// Where the road can be: ahead, not far aside, below the body.
bool may_be_road(const Eigen::Vector3d& p_body_m) {
  return p_body_m.x() > 4.0 && std::abs(p_body_m.y()) < 7.0 && p_body_m.z() < 0.0;
}

/// The plane through three points, unless it is no road.
std::optional<RoadPlane> plane_through(const Eigen::Vector3d& a,
                                       const Eigen::Vector3d& b,
                                       const Eigen::Vector3d& c) {
  constexpr double kLeastCrossM2 = 1e-3;
  const Eigen::Vector3d cross = (b - a).cross(c - a);
  if (cross.norm() < kLeastCrossM2) {
    return std::nullopt;
  }
  const Eigen::Vector3d up = cross.normalized() * (cross.z() < 0.0 ? -1.0 : 1.0);
  return up.z() < kLeastUpright ? std::nullopt : std::optional(RoadPlane{up, -up.dot(a)});
}

bool is_on(const RoadPlane& plane, const Eigen::Vector3d& p_body_m) {
  return std::abs(plane.height_m(p_body_m)) < kRoadToleranceM;
}

std::ptrdiff_t count_on(const RoadPlane& plane, const Points& points) {
  return std::count_if(
      points.begin(), points.end(), [&](const auto& p) { return is_on(plane, p); });
}

Points points_on(const RoadPlane& plane, const Points& points) {
  Points on;
  std::copy_if(points.begin(), points.end(), std::back_inserter(on), [&](const auto& p) {
    return is_on(plane, p);
  });
  return on;
}

/// The plane with the least squared distances.
RoadPlane fitted(const Points& points) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& p : points) {
    mean += p / static_cast<double>(points.size());
  }
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector3d& p : points) {
    spread += (p - mean) * (p - mean).transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(spread);
  const Eigen::Vector3d normal = solver.eigenvectors().col(0);
  const Eigen::Vector3d up = normal * (normal.z() < 0.0 ? -1.0 : 1.0);
  return {up, -up.dot(mean)};
}

bool is_borne_out(const Eigen::Vector3d& thing_m, const Points& things_m, const LaserCheck& check) {
  const double radius_m2 = check.support_radius_m * check.support_radius_m;
  return std::count_if(things_m.begin(), things_m.end(), [&](const Eigen::Vector3d& p) {
           return (p - thing_m).squaredNorm() <= radius_m2;
         }) >= check.support_count;
}

}  // namespace

std::vector<Eigen::Vector3d> seen_points(const LaserScan& scan,
                                         const LaserSource& source,
                                         double max_range_m) {
  const TruthCamera camera = source.truth_camera();
  const Pose T_body_laser = source.T_body_laser();
  Points points_body_m;
  for (const Eigen::Vector3f& point : scan) {
    const Eigen::Vector3d p_laser_m = point.cast<double>();
    if (is_seen(camera, camera.T_camera_laser * p_laser_m, max_range_m)) {
      points_body_m.push_back(T_body_laser * p_laser_m);
    }
  }
  return points_body_m;
}

std::optional<RoadPlane> road_plane(std::span<const Eigen::Vector3d> points_body_m) {
  constexpr int kTries = 400;
  constexpr int kRefinements = 4;
  Points points;
  std::copy_if(points_body_m.begin(), points_body_m.end(), std::back_inserter(points), may_be_road);
  if (points.size() < kFewestRoadPoints) {
    return std::nullopt;
  }
  std::mt19937 random(1);  // the same each time
  const auto any = [&]() -> const Eigen::Vector3d& { return points[random() % points.size()]; };
  RoadPlane best;
  std::ptrdiff_t most = 0;
  for (int i = 0; i < kTries; ++i) {
    const Eigen::Vector3d& a = any();
    const Eigen::Vector3d& b = any();
    const Eigen::Vector3d& c = any();
    const std::optional<RoadPlane> plane = plane_through(a, b, c);
    const std::ptrdiff_t on = plane ? count_on(*plane, points) : 0;
    if (on > most) {
      most = on;
      best = *plane;
    }
  }
  if (most < static_cast<std::ptrdiff_t>(kFewestRoadPoints)) {
    return std::nullopt;
  }
  RoadPlane road = best;
  for (int i = 0; i < kRefinements; ++i) {
    road = fitted(points_on(road, points));
  }
  return road;
}

std::optional<LaserView> view_of_laser(std::span<const Eigen::Vector3d> points_body_m,
                                       const LaserCheck& check) {
  const std::optional<RoadPlane> road = road_plane(points_body_m);
  if (!road) {
    return std::nullopt;
  }
  LaserView view{.road = *road,
                 .nearest_m = {},
                 .supported_m = {},
                 .points_body_m = {points_body_m.begin(), points_body_m.end()}};
  Points things_m;  // all of them, also outside the cone: what stands there bears out too
  std::copy_if(
      points_body_m.begin(), points_body_m.end(), std::back_inserter(things_m), [&](const auto& p) {
        return road->height_m(p) > check.clearance_m;
      });
  Points ahead_m;
  const double least_cosine = std::cos(check.half_angle_rad);
  std::copy_if(things_m.begin(), things_m.end(), std::back_inserter(ahead_m), [&](const auto& p) {
    return p.x() >= least_cosine * p.norm();
  });
  std::stable_sort(ahead_m.begin(), ahead_m.end(), [](const auto& a, const auto& b) {
    return a.squaredNorm() < b.squaredNorm();
  });
  const auto supported = std::find_if(ahead_m.begin(), ahead_m.end(), [&](const auto& p) {
    return is_borne_out(p, things_m, check);
  });
  if (!ahead_m.empty()) {
    view.nearest_m = ahead_m.front().norm();
  }
  if (supported != ahead_m.end()) {
    view.supported_m = supported->norm();
  }
  return view;
}

std::optional<double> stereo_nearest_m(const Halo& halo,
                                       const RoadPlane& road,
                                       const LaserCheck& check) {
  const GridGeometry& grid = halo.geometry();
  const double least_cosine = std::cos(check.half_angle_rad);
  const RegionView view = view_where(halo, [&](GridCell cell, float depth_m) {
    if (std::isnan(depth_m) || grid.center_direction(cell).x() < least_cosine) {
      return false;
    }
    const Eigen::Vector3d lower_edge =
        direction(grid.theta_min_rad + (cell.row + 1.0) * grid.theta_step_rad,
                  grid.phi_min_rad + (cell.col + 0.5) * grid.phi_step_rad);
    return road.height_m(static_cast<double>(depth_m) * lower_edge) > check.clearance_m;
  });
  return view.nearest_cell ? std::optional(view.nearest_m) : std::nullopt;
}

FreeClaims free_claims(const Halo& halo,
                       std::span<const Eigen::Vector3d> points_body_m,
                       const LaserCheck& check) {
  struct Count {
    int points = 0;
    int nearer = 0;
  };

  std::vector<Count> counts(halo.depths_m().size());
  for (const Eigen::Vector3d& p_m : points_body_m) {
    const SphericalPoint point = to_spherical(p_m);
    if (const auto cell = halo.geometry().cell_of(point.theta_rad, point.phi_rad)) {
      Count& count = counts[static_cast<std::size_t>(halo.geometry().offset_of(*cell))];
      const double tolerance_m = std::max(kBoundM, kBoundShare * point.rho_m);
      ++count.points;
      count.nearer += point.rho_m + tolerance_m < halo.free_to_m(*cell) ? 1 : 0;
    }
  }
  FreeClaims claims;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    if (halo.free_to_m()[i] > 0.0F && counts[i].points >= check.support_count) {
      ++claims.cells;
      claims.contradicted += counts[i].nearer >= check.support_count ? 1 : 0;
    }
  }
  return claims;
}

bool agrees(const std::optional<double>& laser_m,
            const std::optional<double>& stereo_m,
            double max_range_m) noexcept {
  if (!laser_m) {
    return !stereo_m || *stereo_m > (1.0 - kBoundShare) * max_range_m;
  }
  return stereo_m && std::abs(*stereo_m - *laser_m) <= std::max(kBoundM, kBoundShare * *laser_m);
}

}  // namespace skyhalo::app

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "skyhalo/sim/moving_object.hpp"
#include "skyhalo/sim/scene.hpp"
#include "skyhalo/sim/scene_tracer.hpp"

namespace skyhalo::reference {

/// A triangle of a scene at one moment, with the numbers that a hit names it by.
struct NaiveTriangle {
  std::array<Eigen::Vector3d, 3> corners_m;  ///< scene frame
  std::uint32_t object = 0;                  ///< 0 stands still, 1 + index of a mover
  std::uint32_t index = 0;                   ///< in the object's mesh
};

/// Where a ray crosses a triangle's plane.
struct NaiveCrossing {
  double range_m = 0.0;  ///< infinite when the ray lies along the plane
  double b = 0.0;        ///< weight of the second corner, anything outside the triangle
  double c = 0.0;        ///< weight of the third corner

  /// How far inside the triangle, as the smallest of the three weights; negative outside.
  [[nodiscard]] double inside() const { return std::min({b, c, 1.0 - b - c}); }
};

/// The nearest triangle on a ray, and how sure that is.
struct NaiveHit {
  double range_m = std::numeric_limits<double>::infinity();
  double next_range_m = std::numeric_limits<double>::infinity();  ///< of the second nearest
  /// Least distance (as a weight) to an edge of a triangle whose plane is crossed up to the hit.
  double edge_distance = std::numeric_limits<double>::infinity();
  double incidence = 1.0;  ///< cosine between the ray and the normal
  NaiveCrossing crossing;
  NaiveTriangle triangle;
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  ///< unit vector, towards the ray's origin
};

/// The triangles of one mesh whose vertices go straight from one pose to another, at `share` of the
/// way.
inline void append_naive_triangles(std::vector<NaiveTriangle>& triangles,
                                   const TriangleMesh& mesh,
                                   std::uint32_t object,
                                   const std::array<Pose, 2>& T_scene_mesh,
                                   double share) {
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    NaiveTriangle triangle;
    triangle.object = object;
    triangle.index = static_cast<std::uint32_t>(i);
    for (std::size_t k = 0; k < 3; ++k) {
      const Eigen::Vector3d vertex_m = mesh.vertices_m[mesh.triangles[i][k]].cast<double>();
      triangle.corners_m[k] =
          (1.0 - share) * (T_scene_mesh[0] * vertex_m) + share * (T_scene_mesh[1] * vertex_m);
    }
    triangles.push_back(triangle);
  }
}

/// All triangles of a scene at `share` (0...1) of a span of time.
inline std::vector<NaiveTriangle> naive_triangles(const Scene& scene,
                                                  const TimeSpan& span,
                                                  double share) {
  std::vector<NaiveTriangle> triangles;
  append_naive_triangles(triangles, scene.fixed, 0, {Pose::Identity(), Pose::Identity()}, 0.0);
  for (std::size_t i = 0; i < scene.movers.size(); ++i) {
    const MovingObject& mover = scene.movers[i];
    append_naive_triangles(triangles,
                           mover.mesh,
                           static_cast<std::uint32_t>(i + 1),
                           {T_scene_object(mover, span.begin_s), T_scene_object(mover, span.end_s)},
                           share);
  }
  return triangles;
}

/// Where a ray crosses the plane of a triangle: the three equations `origin + t direction = A + b
/// (B - A) + c (C - A)`, solved by Cramer's rule.
inline NaiveCrossing naive_crossing(const Eigen::Vector3d& origin_m,
                                    const Eigen::Vector3d& direction,
                                    const std::array<Eigen::Vector3d, 3>& corners_m) {
  const Eigen::Vector3d first = corners_m[1] - corners_m[0];
  const Eigen::Vector3d second = corners_m[2] - corners_m[0];
  const Eigen::Vector3d from = origin_m - corners_m[0];
  const auto determinant = [](const Eigen::Vector3d& x,
                              const Eigen::Vector3d& y,
                              const Eigen::Vector3d& z) { return x.dot(y.cross(z)); };
  const double whole = determinant(first, second, -direction);
  if (whole == 0.0) {
    return {.range_m = std::numeric_limits<double>::infinity(), .b = -1.0, .c = -1.0};
  }
  return {.range_m = determinant(first, second, from) / whole,
          .b = determinant(from, second, -direction) / whole,
          .c = determinant(first, from, -direction) / whole};
}

/// The nearest triangle on a ray up to `max_range_m`, by asking each one. A direction of zero meets
/// nothing.
inline NaiveHit naive_trace(const std::vector<NaiveTriangle>& triangles,
                            const Eigen::Vector3d& origin_m,
                            const Eigen::Vector3d& direction,
                            double max_range_m = 1e6) {
  NaiveHit hit;
  std::vector<NaiveCrossing> crossings;
  if (direction.isZero(0.0)) {
    return hit;
  }
  for (const NaiveTriangle& triangle : triangles) {
    const NaiveCrossing crossing = naive_crossing(origin_m, direction, triangle.corners_m);
    crossings.push_back(crossing);
    if (!(crossing.range_m >= 0.0 && crossing.range_m <= max_range_m) || crossing.inside() < 0.0) {
      continue;
    }
    if (crossing.range_m >= hit.range_m) {
      hit.next_range_m = std::min(hit.next_range_m, crossing.range_m);
      continue;
    }
    hit.next_range_m = hit.range_m;
    hit.range_m = crossing.range_m;
    hit.crossing = crossing;
    hit.triangle = triangle;
  }
  for (const NaiveCrossing& crossing : crossings) {
    if (crossing.range_m >= 0.0 && crossing.range_m <= std::min(hit.range_m, max_range_m)) {
      hit.edge_distance = std::min(hit.edge_distance, std::abs(crossing.inside()));
    }
  }
  if (std::isfinite(hit.range_m)) {
    const auto& corners_m = hit.triangle.corners_m;
    const Eigen::Vector3d across =
        (corners_m[1] - corners_m[0]).cross(corners_m[2] - corners_m[0]).normalized();
    hit.normal = across.dot(direction) > 0.0 ? Eigen::Vector3d(-across) : across;
    hit.incidence = std::abs(across.dot(direction)) / direction.norm();
  }
  return hit;
}

}  // namespace skyhalo::reference

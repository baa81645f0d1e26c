#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <random>

#include "skyhalo/sim/scene.hpp"
#include "skyhalo/sim/shapes.hpp"

namespace skyhalo::testing {

/// A point anywhere in a cube about the origin (m).
inline Eigen::Vector3d random_point_m(std::mt19937& rng, double half_edge_m) {
  std::uniform_real_distribution<double> along(-half_edge_m, half_edge_m);
  const double x = along(rng);
  const double y = along(rng);
  return {x, y, along(rng)};
}

/// A unit vector, all directions alike.
inline Eigen::Vector3d random_direction(std::mt19937& rng) {
  std::normal_distribution<double> along;
  const double x = along(rng);
  const double y = along(rng);
  return Eigen::Vector3d(x, y, along(rng)).normalized();
}

/// A rotation, all alike.
inline Eigen::Matrix3d random_rotation(std::mt19937& rng) {
  std::normal_distribution<double> along;
  const double w = along(rng);
  const double x = along(rng);
  const double y = along(rng);
  return Eigen::Quaterniond(w, x, y, along(rng)).normalized().toRotationMatrix();
}

/// Triangles without order in a cube about the origin, each about `size_m` large.
inline TriangleMesh random_soup(std::mt19937& rng, int count, double half_edge_m, double size_m) {
  TriangleMesh mesh;
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector3d middle_m = random_point_m(rng, half_edge_m);
    const auto first = static_cast<std::uint32_t>(mesh.vertices_m.size());
    for (int k = 0; k < 3; ++k) {
      mesh.vertices_m.emplace_back((middle_m + random_point_m(rng, size_m)).cast<float>());
    }
    mesh.triangles.push_back({first, first + 1, first + 2});
    mesh.materials.push_back(0);
  }
  return mesh;
}

/// A soup that stands still, of one grey material.
inline Scene random_scene(std::uint32_t seed, int count, double half_edge_m, double size_m) {
  std::mt19937 rng(seed);
  Scene scene;
  scene.name = "soup";
  scene.materials.resize(1);
  scene.fixed = random_soup(rng, count, half_edge_m, size_m);
  return scene;
}

/// A closed room about a middle (m) as one box of one material.
inline Scene room_scene(const Eigen::Vector3f& middle_m, const Eigen::Vector3f& size_m) {
  Scene scene;
  scene.name = "room";
  scene.materials.resize(1);
  scene.materials[0].laser_reflectivity = 0.8F;
  add_box(scene.fixed, {.middle_m = middle_m, .size_m = size_m, .yaw_rad = 0.0F}, {});
  return scene;
}

}  // namespace skyhalo::testing

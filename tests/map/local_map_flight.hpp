#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <random>
#include <vector>

namespace skyhalo::testing {

/// The positions (m, map frame) of a flight of at least `length_m` from the origin, always the
/// same: single cells of `voxel_m` along each axis, diagonals of single and of several cells, steps
/// of parts of a cell, stops, and now and then a jump of up to 24 m. It crosses the origin's planes
/// again and again.
inline std::vector<Eigen::Vector3d> winding_flight(double length_m, double voxel_m) {
  std::mt19937 random(7);
  const auto below = [&](std::size_t n) { return random() % n; };
  const auto between = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  std::vector<Eigen::Vector3d> positions{Eigen::Vector3d::Zero()};
  double flown_m = 0.0;
  while (flown_m < length_m) {
    Eigen::Vector3d step = Eigen::Vector3d::Zero();
    switch (below(8)) {
      case 0:
      case 1:
        step[static_cast<int>(below(3))] = below(2) == 0 ? voxel_m : -voxel_m;
        break;
      case 2:
        step = {below(2) == 0 ? voxel_m : -voxel_m, below(2) == 0 ? voxel_m : -voxel_m, voxel_m};
        break;
      case 3:
      case 4:
        step = {between(-2.0, 2.0), between(-2.0, 2.0), between(-1.0, 1.0)};
        break;
      case 5:
        step = {between(-0.2, 0.2), between(-0.2, 0.2), between(-0.2, 0.2)};
        break;
      case 6:
        if (below(10) == 0) {
          step = {between(-24.0, 24.0), between(-24.0, 24.0), between(-12.0, 12.0)};
        }
        break;
      default:  // a stop
        break;
    }
    // Home again when it has strayed.
    if (positions.back().norm() > 60.0) {
      step -= 0.05 * positions.back();
    }
    flown_m += step.norm();
    positions.push_back(positions.back() + step);
  }
  return positions;
}

}  // namespace skyhalo::testing

#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace skyhalo::reference {

/// A local map (METHOD.md 6) that copies all of its content whenever the drone moves. Cell
/// (i, j, k) begins at voxel_m (i, j, k); it holds `size` cells along each axis, and the drone's
/// cell is number size / 2 of each.
class NaiveLocalMap {
 public:
  static constexpr std::int16_t kNaiveUnknown = -32768;

  /// All unknown, the drone at the origin.
  NaiveLocalMap(const Eigen::Vector3i& size, double voxel_m)
      : size_(size),
        voxel_m_(voxel_m),
        first_(first_for(Eigen::Vector3d::Zero())),
        cells_(static_cast<std::size_t>(size.prod()), kNaiveUnknown) {}

  const Eigen::Vector3i& first() const { return first_; }

  bool holds(const Eigen::Vector3i& cell) const {
    const Eigen::Array3i place = (cell - first_).array();
    return (place >= 0).all() && (place < size_.array()).all();
  }

  /// Unknown outside.
  std::int16_t at(const Eigen::Vector3i& cell) const {
    return holds(cell) ? cells_[index(cell - first_)] : kNaiveUnknown;
  }

  /// Of a cell that it holds.
  void set(const Eigen::Vector3i& cell, std::int16_t value) {
    cells_[index(cell - first_)] = value;
  }

  /// The drone is at this position (m, map frame) now.
  void follow(const Eigen::Vector3d& position_m) {
    const Eigen::Vector3i first = first_for(position_m);
    std::vector<std::int16_t> cells(cells_.size(), kNaiveUnknown);
    for (int x = 0; x < size_.x(); ++x) {
      for (int y = 0; y < size_.y(); ++y) {
        for (int z = 0; z < size_.z(); ++z) {
          cells[index({x, y, z})] = at(first + Eigen::Vector3i(x, y, z));
        }
      }
    }
    cells_ = cells;
    first_ = first;
  }

 private:
  Eigen::Vector3i first_for(const Eigen::Vector3d& position_m) const {
    const Eigen::Vector3i center = (position_m / voxel_m_).array().floor().cast<int>();
    return center - size_ / 2;
  }

  std::size_t index(const Eigen::Vector3i& place) const {
    return static_cast<std::size_t>((place.x() * size_.y() + place.y()) * size_.z() + place.z());
  }

  Eigen::Vector3i size_;
  double voxel_m_;
  Eigen::Vector3i first_;
  std::vector<std::int16_t> cells_;
};

}  // namespace skyhalo::reference

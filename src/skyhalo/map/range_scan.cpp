#include "skyhalo/map/range_scan.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "skyhalo/base/error.hpp"
#include "skyhalo/geometry/spherical.hpp"

namespace skyhalo {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr int kMostRows = 2000;
constexpr float kLeastDeltaM = 1e-4F;
constexpr float kMostDeltaM = 1e4F;

int checked(int rows) {
  if (rows < 2 || rows > kMostRows) {
    throw Error(ErrorKind::kInput, "range scan: expected 2 to 2000 rows");
  }
  return rows;
}

bool is_range(float range_m) noexcept {
  return range_m > 0.0F && std::isfinite(range_m);
}

}  // namespace

RangeScan::RangeScan(int rows)
    : rows_(checked(rows)),
      z_m_(std::size_t{2} * static_cast<std::size_t>(rows) * static_cast<std::size_t>(rows) +
               kScanPadding,
           kNan),
      delta_z_m_(z_m_.size(), 1.0F),
      free_to_m_(z_m_.size(), 0.0F) {}

double RangeScan::step_rad() const noexcept {
  return std::numbers::pi / rows_;
}

Eigen::Vector3d RangeScan::direction(int row, int col) const noexcept {
  return skyhalo::direction((row + 0.5) * step_rad(), (col + 0.5) * step_rad() - std::numbers::pi);
}

void RangeScan::clear() noexcept {
  std::fill(z_m_.begin(), z_m_.end(), kNan);
  std::fill(free_to_m_.begin(), free_to_m_.end(), 0.0F);
  farthest_m_ = 0.0;
}

void RangeScan::set_depth(int row, int col, float z_m, float delta_z_m) noexcept {
  const std::size_t at = index_of(row, col);
  const bool known = is_range(z_m) && !std::isnan(delta_z_m);
  z_m_[at] = known ? z_m : kNan;
  delta_z_m_[at] = known ? std::clamp(delta_z_m, kLeastDeltaM, kMostDeltaM) : 1.0F;
  free_to_m_[at] = 0.0F;
  farthest_m_ = known ? std::max(farthest_m_, static_cast<double>(z_m)) : farthest_m_;
}

void RangeScan::set_free(int row, int col, float free_to_m) noexcept {
  const std::size_t at = index_of(row, col);
  z_m_[at] = kNan;
  free_to_m_[at] = is_range(free_to_m) ? free_to_m : 0.0F;
}

}  // namespace skyhalo

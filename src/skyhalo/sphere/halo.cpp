#include "skyhalo/sphere/halo.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "skyhalo/base/error.hpp"

namespace skyhalo {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr std::int64_t kNever = std::numeric_limits<std::int64_t>::min();

/// Whether a grid's cells are cells of the whole sphere.
bool is_part_of(const GridGeometry& grid, const GridGeometry& sphere) noexcept {
  const auto is_whole = [](double steps) { return std::abs(steps - std::round(steps)) < 1e-6; };
  const double step = sphere.theta_step_rad;
  const double first_row = grid.theta_min_rad / step;
  const double first_col = (grid.phi_min_rad + std::numbers::pi) / step;
  return std::abs(grid.theta_step_rad - step) < 1e-9 && std::abs(grid.phi_step_rad - step) < 1e-9 &&
         is_whole(first_row) && first_row > -0.5 &&
         std::lround(first_row) + grid.rows <= sphere.rows && is_whole(first_col) &&
         first_col > -0.5 && first_col < sphere.cols - 0.5 && grid.cols <= sphere.cols;
}

}  // namespace

Halo::Halo(double step_rad)
    : geometry_(whole_sphere(step_rad)),
      depths_m_(static_cast<std::size_t>(geometry_.cell_count()), kNan),
      free_to_m_(depths_m_.size(), 0.0F),
      sources_(depths_m_.size(), kNoSource),
      seen_ns_(depths_m_.size(), kNever) {
  directions_.reserve(depths_m_.size());
  for (int cell = 0; cell < geometry_.cell_count(); ++cell) {
    directions_.emplace_back(
        geometry_.center_direction({cell / geometry_.cols, cell % geometry_.cols}).cast<float>());
  }
}

Sight Halo::sight(GridCell cell) const noexcept {
  const std::size_t at = index_of(cell);
  if (!std::isnan(depths_m_[at])) {
    return Sight::kObstacle;
  }
  return free_to_m_[at] > 0.0F ? Sight::kFree : Sight::kUnseen;
}

std::optional<double> Halo::depth_m(GridCell cell) const noexcept {
  const float depth_m = depths_m_[index_of(cell)];
  return std::isnan(depth_m) ? std::nullopt : std::optional<double>(depth_m);
}

double Halo::free_to_m(GridCell cell) const noexcept {
  return free_to_m_[index_of(cell)];
}

std::optional<std::size_t> Halo::source(GridCell cell) const noexcept {
  const std::uint8_t source = sources_[index_of(cell)];
  return source == kNoSource ? std::nullopt : std::optional<std::size_t>(source);
}

std::optional<double> Halo::age_s(GridCell cell, Timestamp now) const noexcept {
  const std::int64_t seen_ns = seen_ns_[index_of(cell)];
  if (seen_ns == kNever) {
    return std::nullopt;
  }
  return std::chrono::duration<double>(now.time_since_epoch() - std::chrono::nanoseconds(seen_ns))
      .count();
}

void Halo::set(
    GridCell cell, float depth_m, float free_to_m, std::uint8_t source, Timestamp stamp) noexcept {
  const std::size_t at = index_of(cell);
  depths_m_[at] = depth_m;
  free_to_m_[at] = depth_m < free_to_m ? depth_m : free_to_m;
  sources_[at] = depth_m >= 0.0F || free_to_m > 0.0F ? source : kNoSource;
  seen_ns_[at] = sources_[at] == kNoSource ? seen_ns_[at] : stamp.time_since_epoch().count();
}

void Halo::stitch(std::span<const PairGrid> grids) {
  const auto fits = [this](const PairGrid& pair) {
    return pair.grid == nullptr || is_part_of(pair.grid->geometry(), geometry_);
  };
  if (grids.size() > kNoSource || !std::all_of(grids.begin(), grids.end(), fits)) {
    throw Error(ErrorKind::kInput,
                "halo: expected at most 255 grids, each an aligned part of the halo's cells, with "
                "its step");
  }
  std::fill(depths_m_.begin(), depths_m_.end(), kNan);
  std::fill(free_to_m_.begin(), free_to_m_.end(), 0.0F);
  std::fill(sources_.begin(), sources_.end(), kNoSource);
  for (std::size_t i = 0; i < grids.size(); ++i) {
    if (grids[i].grid != nullptr) {
      overlay(grids[i], static_cast<std::uint8_t>(i));
    }
  }
  for (std::size_t at = 0; at < depths_m_.size(); ++at) {
    free_to_m_[at] = depths_m_[at] < free_to_m_[at] ? depths_m_[at] : free_to_m_[at];
  }
}

void Halo::overlay(const PairGrid& pair, std::uint8_t source) noexcept {
  const GridGeometry& grid = pair.grid->geometry();
  const double step_rad = geometry_.theta_step_rad;
  const auto first_row = static_cast<int>(std::lround(grid.theta_min_rad / step_rad));
  const auto first_col =
      static_cast<int>(std::lround((grid.phi_min_rad + std::numbers::pi) / step_rad));
  const std::int64_t stamp_ns = pair.stamp.time_since_epoch().count();
  const std::span<const float> depths_m = pair.grid->depths_m();
  const std::span<const float> free_to_m = pair.grid->free_to_m();
  for (int row = 0; row < grid.rows; ++row) {
    for (int col = 0; col < grid.cols; ++col) {
      const auto from = static_cast<std::size_t>(grid.offset_of({row, col}));
      const int turned = first_col + col;
      const std::size_t to =
          index_of({first_row + row, turned < geometry_.cols ? turned : turned - geometry_.cols});
      const bool has_depth = !std::isnan(depths_m[from]);
      const bool known = !std::isnan(depths_m_[to]);
      const bool nearer = has_depth && !(depths_m_[to] <= depths_m[from]);
      const bool freer = free_to_m[from] > free_to_m_[to];
      if (nearer || (freer && !known)) {
        sources_[to] = source;
        seen_ns_[to] = stamp_ns;
      }
      depths_m_[to] = nearer ? depths_m[from] : depths_m_[to];
      free_to_m_[to] = freer ? free_to_m[from] : free_to_m_[to];
    }
  }
}

}  // namespace skyhalo

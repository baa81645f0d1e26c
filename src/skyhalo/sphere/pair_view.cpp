#include "skyhalo/sphere/pair_view.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include "skyhalo/base/error.hpp"
#include "skyhalo/geometry/spherical.hpp"

namespace skyhalo {
namespace {

constexpr double kMaxWindowRad = std::numbers::pi / 4.0 + 1e-9;
constexpr int kNone = -1;
constexpr int kSubDirections = 8;

int offset_of(const GridGeometry& grid, const Eigen::Vector3d& direction_body) noexcept {
  const SphericalPoint point = to_spherical(direction_body);
  const auto cell = grid.cell_of(point.theta_rad, point.phi_rad);
  return cell ? grid.offset_of(*cell) : kNone;
}

void take_in(CellLooks& all, const CellLooks& one) noexcept {
  all.valid += one.valid;
  all.invalid += one.invalid;
  all.nearest_m = std::min(all.nearest_m, one.nearest_m);
}

/// Whether the pixel of a direction (`cam`) lies within the image.
bool is_in_image(const PairModel& model,
                 const cv::Size& size_px,
                 const Eigen::Vector3d& ray) noexcept {
  if (std::holds_alternative<PinholePair>(model) && !(ray.z() > 0.0)) {
    return false;
  }
  const Eigen::Vector3d pixel = project(model, ray);
  return pixel.x() >= -0.5 && pixel.x() < size_px.width - 0.5 && pixel.y() >= -0.5 &&
         pixel.y() < size_px.height - 0.5;
}

}  // namespace

void check(const SeenRule& rule, const std::string& section) {
  const auto require = [&](bool holds, const char* key, const char* expected) {
    if (!holds) {
      throw Error(ErrorKind::kInput, section + "." + key + ": expected " + expected);
    }
  };
  require(rule.near_m > 0.0 && std::isfinite(rule.near_m), "near_m", "a length above 0 m");
  require(rule.min_share > 0.0 && rule.min_share <= 1.0,
          "min_seen_share",
          "a number above 0 and at most 1");
  require(rule.window_rad >= 0.0 && rule.window_rad <= kMaxWindowRad,
          "seen_window_deg",
          "an angle in 0...45 deg");
}

PairView::PairView(const PairGeometry& pair,
                   const cv::Size& image_size_px,
                   const GridGeometry& grid,
                   const SeenRule& rule)
    : grid_(grid),
      rule_((check(rule, "sphere"), rule)),
      max_range_m_(static_cast<float>(pair.max_range_m)),
      rows_seen_(static_cast<std::size_t>(grid.cell_count())),
      seen_to_m_(rows_seen_.size()) {
  find_runs(pair, image_size_px);
  find_coverage(pair, image_size_px);
  find_places(pair.T_body_camera.translation());
}

void PairView::find_runs(const PairGeometry& pair, const cv::Size& image_size_px) {
  for (int v = 0; v < image_size_px.height; ++v) {
    row_begin_.push_back(static_cast<int>(runs_.size()));
    LookRun run{0, 0, kNone};
    for (int u = 0; u < image_size_px.width; ++u) {
      const int cell = offset_of(grid_, pair.T_body_camera.linear() * ray_of(pair.model, u, v));
      if (cell != run.cell) {
        if (run.cell != kNone) {
          runs_.push_back(run);
        }
        run = {u, u, cell};
      }
      run.end = u + 1;
    }
    if (run.cell != kNone) {
      runs_.push_back(run);
    }
  }
  row_begin_.push_back(static_cast<int>(runs_.size()));
}

void PairView::find_coverage(const PairGeometry& pair, const cv::Size& image_size_px) {
  coverage_.assign(static_cast<std::size_t>(grid_.cell_count()), 0.0);
  for (const LookRun& run : runs_) {
    coverage_[static_cast<std::size_t>(run.cell)] = 1.0;
  }
  const Eigen::Matrix3d R_camera_body = pair.T_body_camera.linear().transpose();
  for (int row = 0; row < grid_.rows; ++row) {
    for (int col = 0; col < grid_.cols; ++col) {
      double& coverage = coverage_[static_cast<std::size_t>(grid_.offset_of({row, col}))];
      int inside = 0;
      for (int i = 0; coverage > 0.0 && i < kSubDirections * kSubDirections; ++i) {
        const int down = i / kSubDirections;
        const double theta = row + (down + 0.5) / kSubDirections;
        const double phi = col + (i % kSubDirections + 0.5) / kSubDirections;
        const Eigen::Vector3d ray = direction(grid_.theta_min_rad + theta * grid_.theta_step_rad,
                                              grid_.phi_min_rad + phi * grid_.phi_step_rad);
        inside += is_in_image(pair.model, image_size_px, R_camera_body * ray) ? 1 : 0;
      }
      coverage = static_cast<double>(inside) / (kSubDirections * kSubDirections);
    }
  }
}

std::span<const LookRun> PairView::runs(int image_row) const noexcept {
  const auto row = static_cast<std::size_t>(image_row);
  return {runs_.data() + row_begin_[row], runs_.data() + row_begin_[row + 1]};
}

void PairView::find_places(const Eigen::Vector3d& camera_m) {
  // By nearness 1/r the direction turns almost evenly: samples an eighth of a cell apart, halved
  // wherever the cell changes between two of them.
  const double nearest = 1.0 / rule_.near_m;
  const int samples =
      1 + static_cast<int>(std::ceil(8.0 * camera_m.norm() * nearest / grid_.theta_step_rad));
  for (int i = 0; i < grid_.cell_count(); ++i) {
    const Eigen::Vector3d ray = grid_.center_direction({i / grid_.cols, i % grid_.cols});
    const auto look_at = [&](double nearness) {
      return offset_of(grid_, ray - nearness * camera_m);
    };
    const double along_m = ray.dot(camera_m);
    const int first = static_cast<int>(places_.size());
    places_.push_back({static_cast<float>(rule_.near_m), look_at(nearest)});
    const std::function<void(double, double, int)> add_changes =
        [&](double from, double to, int look_to) {
          if (places_.back().look == look_to) {
            return;
          }
          const double middle = 0.5 * (from + to);
          if (from - to < 1e-9 * nearest) {
            places_.push_back({static_cast<float>(1.0 / middle), look_to});
            return;
          }
          add_changes(from, middle, look_at(middle));
          add_changes(middle, to, look_to);
        };
    for (int k = 0; k < samples; ++k) {
      const double from = nearest * (samples - k) / samples;
      const double to = nearest * (samples - k - 1) / samples;
      add_changes(from, to, look_at(to));
    }
    rays_.push_back({first,
                     static_cast<int>(places_.size()),
                     static_cast<float>(along_m),
                     static_cast<float>(camera_m.squaredNorm() - along_m * along_m)});
  }
}

int PairView::column_reach(int row) const noexcept {
  const double theta = grid_.theta_min_rad + (row + 0.5) * grid_.theta_step_rad;
  const double steps = rule_.window_rad / (grid_.phi_step_rad * std::sin(theta));
  return static_cast<int>(std::lround(std::min(steps, 0.5 * (grid_.cols - 1) - 0.5)));
}

CellLooks PairView::row_window(std::span<const CellLooks> looks,
                               GridCell cell,
                               int reach) const noexcept {
  CellLooks window;
  for (int k = cell.col - reach; k <= cell.col + reach; ++k) {
    const int turned = k < 0 ? k + grid_.cols : k >= grid_.cols ? k - grid_.cols : k;
    if (turned == k || grid_.is_whole_circle()) {
      take_in(window, looks[static_cast<std::size_t>(grid_.offset_of({cell.row, turned}))]);
    }
  }
  return window;
}

float PairView::seen_to(const CellLooks& own, GridCell cell) const noexcept {
  const auto reach = static_cast<int>(std::lround(rule_.window_rad / grid_.theta_step_rad));
  CellLooks window;
  for (int row = std::max(cell.row - reach, 0); row <= std::min(cell.row + reach, grid_.rows - 1);
       ++row) {
    take_in(window, rows_seen_[static_cast<std::size_t>(grid_.offset_of({row, cell.col}))]);
  }
  const double share = window.valid * coverage_[static_cast<std::size_t>(grid_.offset_of(cell))];
  const bool seen =
      own.valid > 0 && share > 0.0 && share >= rule_.min_share * (window.valid + window.invalid);
  return seen ? std::min(window.nearest_m, max_range_m_) : -1.0F;
}

void PairView::see_through_windows(std::span<const CellLooks> looks) noexcept {
  for (int row = 0; row < grid_.rows; ++row) {
    const int reach = column_reach(row);
    for (int col = 0; col < grid_.cols; ++col) {
      rows_seen_[static_cast<std::size_t>(grid_.offset_of({row, col}))] =
          row_window(looks, {row, col}, reach);
    }
  }
  for (int i = 0; i < grid_.cell_count(); ++i) {
    const auto at = static_cast<std::size_t>(i);
    seen_to_m_[at] = seen_to(looks[at], {i / grid_.cols, i % grid_.cols});
  }
}

void PairView::find_free(std::span<const CellLooks> looks, std::span<float> free_to_m) noexcept {
  see_through_windows(looks);
  std::transform(rays_.begin(), rays_.end(), free_to_m.begin(), [this](const CellRay& ray) {
    return free_along(ray);
  });
}

float PairView::free_along(const CellRay& ray) const noexcept {
  const auto from_camera_m2 = [&](float range_m) {
    const float along_m = range_m - ray.along_m;
    return ray.aside2_m2 + along_m * along_m;
  };
  for (int i = ray.first_place; i < ray.end_place; ++i) {
    const Place& place = places_[static_cast<std::size_t>(i)];
    const float seen_to_m =
        place.look == kNone ? -1.0F : seen_to_m_[static_cast<std::size_t>(place.look)];
    if (seen_to_m < 0.0F || from_camera_m2(place.begin_m) > seen_to_m * seen_to_m) {
      return i == ray.first_place ? 0.0F : place.begin_m;
    }
    // The distance from the camera has one minimum along the ray: what is seen at both ends is seen
    // between.
    if (i + 1 < ray.end_place) {
      const float end_m = places_[static_cast<std::size_t>(i) + 1].begin_m;
      if (from_camera_m2(end_m) <= seen_to_m * seen_to_m) {
        continue;
      }
    }
    return ray.along_m + std::sqrt(std::max(0.0F, seen_to_m * seen_to_m - ray.aside2_m2));
  }
  return 0.0F;
}

}  // namespace skyhalo

#include "skyhalo/sphere/pair_geometry.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "skyhalo/base/error.hpp"
#include "skyhalo/geometry/spherical.hpp"

namespace skyhalo {
namespace {

constexpr int kPixelStep = 4;

/// Which rows and columns of the whole sphere hold something.
struct Touched {
  std::vector<char> rows;
  std::vector<char> cols;
};

void touch(const GridGeometry& sphere, const Eigen::Vector3d& p_body_m, Touched& touched) {
  const SphericalPoint point = to_spherical(p_body_m);
  if (const auto cell = sphere.cell_of(point.theta_rad, point.phi_rad)) {
    touched.rows[static_cast<std::size_t>(cell->row)] = 1;
    touched.cols[static_cast<std::size_t>(cell->col)] = 1;
  }
}

/// Every few pixels, and the last of each row and column.
std::vector<int> sampled(int size_px) {
  std::vector<int> at;
  for (int i = 0; i < size_px - 1; i += kPixelStep) {
    at.push_back(i);
  }
  at.push_back(size_px - 1);
  return at;
}

/// The largest angle between neighbouring samples (rad), to be made up for.
double sample_step_rad(const PairModel& model, const cv::Size& size_px) {
  const double u = 0.5 * size_px.width;
  const double v = 0.5 * size_px.height;
  const double cosine = ray_of(model, u, v).dot(ray_of(model, u + kPixelStep, v + kPixelStep));
  return std::acos(std::clamp(cosine, -1.0, 1.0));
}

Touched view_of(const PairGeometry& pair,
                const cv::Size& size_px,
                const GridGeometry& sphere,
                double near_m) {
  Touched touched{std::vector<char>(static_cast<std::size_t>(sphere.rows)),
                  std::vector<char>(static_cast<std::size_t>(sphere.cols))};
  for (const int v : sampled(size_px.height)) {
    for (const int u : sampled(size_px.width)) {
      const Eigen::Vector3d ray = pair.T_body_camera.linear() * ray_of(pair.model, u, v);
      touch(sphere, ray, touched);
      for (const double range_m : {near_m, 1.5 * near_m, 3.0 * near_m, 10.0 * near_m}) {
        touch(sphere, pair.T_body_camera.translation() + range_m * ray, touched);
      }
    }
  }
  return touched;
}

/// Also marks what lies within `margin` of a mark; columns wrap.
void widen(std::vector<char>& marks, int margin, bool wraps) {
  const std::vector<char> before = marks;
  const int size = static_cast<int>(marks.size());
  for (int i = 0; i < size; ++i) {
    for (int k = -margin; before[static_cast<std::size_t>(i)] != 0 && k <= margin; ++k) {
      const int at = wraps ? ((i + k) % size + size) % size : std::clamp(i + k, 0, size - 1);
      marks[static_cast<std::size_t>(at)] = 1;
    }
  }
}

/// The shortest stretch of a circle that holds all marks: where it begins, and its length.
struct Stretch {
  int begin;
  int length;
};

Stretch stretch_of(const std::vector<char>& marks) {
  const int size = static_cast<int>(marks.size());
  Stretch longest_gap{0, 0};
  Stretch gap{0, 0};
  for (int i = 0; i < 2 * size; ++i) {
    if (marks[static_cast<std::size_t>(i % size)] != 0) {
      gap = {i + 1, 0};
    } else if (++gap.length > longest_gap.length) {
      longest_gap = gap;
    }
  }
  return {(longest_gap.begin + longest_gap.length) % size, std::max(0, size - longest_gap.length)};
}

}  // namespace

GridGeometry grid_of_view(const PairGeometry& pair,
                          const cv::Size& image_size_px,
                          const GridBounds& bounds,
                          double near_m) {
  constexpr double kPi = std::numbers::pi;
  const GridGeometry limits = make_grid_geometry(bounds);
  const GridGeometry sphere = whole_sphere(bounds.step_rad);
  Touched touched = view_of(pair, image_size_px, sphere, near_m);
  const int margin =
      1 + static_cast<int>(std::ceil(sample_step_rad(pair.model, image_size_px) / bounds.step_rad));
  widen(touched.rows, margin, false);
  widen(touched.cols, margin, true);
  if (touched.rows.front() != 0 || touched.rows.back() != 0) {  // a pole is seen from all sides
    std::fill(touched.cols.begin(), touched.cols.end(), char{1});
  }
  const int first_row = static_cast<int>(std::lround(limits.theta_min_rad / bounds.step_rad));
  const int first_col = static_cast<int>(std::lround((limits.phi_min_rad + kPi) / bounds.step_rad));
  for (int row = 0; row < sphere.rows; ++row) {
    if (row < first_row || row >= first_row + limits.rows) {
      touched.rows[static_cast<std::size_t>(row)] = 0;
    }
  }
  for (int col = 0; col < sphere.cols; ++col) {
    if ((col - first_col + sphere.cols) % sphere.cols >= limits.cols) {
      touched.cols[static_cast<std::size_t>(col)] = 0;
    }
  }
  const auto row_begin = std::find(touched.rows.begin(), touched.rows.end(), 1);
  const auto row_end = std::find(touched.rows.rbegin(), touched.rows.rend(), 1).base();
  const Stretch cols = stretch_of(touched.cols);
  if (row_begin == touched.rows.end() || cols.length == 0) {
    throw Error(ErrorKind::kInput,
                "sphere: the pair sees nothing between theta_min_deg, theta_max_deg, phi_min_deg "
                "and phi_max_deg");
  }
  const auto first = static_cast<double>(row_begin - touched.rows.begin());
  return {.theta_min_rad = first * bounds.step_rad,
          .theta_step_rad = bounds.step_rad,
          .rows = static_cast<int>(row_end - row_begin),
          .phi_min_rad = cols.begin * bounds.step_rad - kPi,
          .phi_step_rad = bounds.step_rad,
          .cols = cols.length};
}

}  // namespace skyhalo

#include "skyhalo/sphere/accumulate.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "skyhalo/base/error.hpp"
#include "skyhalo/base/for_each_index.hpp"
#include "skyhalo/geometry/spherical.hpp"
#include "skyhalo/sphere/locate.hpp"

namespace skyhalo {
namespace {

/// An image's rows are added in this many bands, whatever the number of threads, so that the order
/// of all sums is fixed.
constexpr int kBands = 4;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

std::size_t padded(int width) noexcept {
  const auto pixels = static_cast<std::size_t>(width);
  constexpr std::size_t kStep = kRowPadding;
  return (pixels + kStep - 1) / kStep * kStep;
}

std::string text_of(const cv::Size& size_px) {
  return std::to_string(size_px.width) + "x" + std::to_string(size_px.height) + " px";
}

std::array<float, 3> narrowed(const Eigen::Vector3d& vector) noexcept {
  return {static_cast<float>(vector.x()),
          static_cast<float>(vector.y()),
          static_cast<float>(vector.z())};
}

/// The memory of one band.
struct Band {
  Band(int width, int cell_count, const DepthRule& rule)
      : points(cell_count, rule),
        looks(static_cast<std::size_t>(cell_count)),
        disparity_px(padded(width), kNan),
        cell(padded(width)),
        range_m(padded(width)),
        seen_m(padded(width) + kRowPadding) {}

  void clear() noexcept {
    points.clear();
    std::fill(looks.begin(), looks.end(), CellLooks{});
    counts = {};
  }

  CellPoints points;
  std::vector<CellLooks> looks;
  PixelCounts counts;
  std::vector<float> disparity_px;  // a row, and NaN beyond its end
  std::vector<std::int32_t> cell;
  std::vector<float> range_m;
  std::vector<float> seen_m;
};

/// What the columns of a spherical pair have in common.
struct ColumnAngles {
  std::vector<float> sine;
  std::vector<float> cosine;
  std::vector<float> max_delta_rad;
};

ColumnAngles column_angles(const PairModel& model, int width) {
  ColumnAngles columns;
  if (const auto* pair = std::get_if<SphericalPair>(&model)) {
    columns = {std::vector<float>(padded(width)),
               std::vector<float>(padded(width)),
               std::vector<float>(padded(width))};
    constexpr double kQuarter = std::numbers::pi / 2.0;
    for (int u = 0; u < width; ++u) {
      const double alpha = (u - pair->principal_u_px) * pair->delta_theta_u_rad;
      const auto at = static_cast<std::size_t>(u);
      columns.sine[at] = static_cast<float>(std::sin(alpha));
      columns.cosine[at] = static_cast<float>(std::cos(alpha));
      columns.max_delta_rad[at] =
          alpha > -kQuarter ? std::max(0.0F, static_cast<float>(kQuarter - alpha)) : 0.0F;
    }
  }
  return columns;
}

PinholeRow row_of(const PinholePair& pair, const ColumnAngles&, const Pose& T_body_camera, int v) {
  const double across_px = v - pair.principal_v_px;
  const Eigen::Matrix3d turned = pair.baseline_m * T_body_camera.linear();
  const double baseline_m2 = pair.baseline_m * pair.baseline_m;
  return {.origin_m = narrowed(T_body_camera.translation()),
          .base_m_px = narrowed(turned * Eigen::Vector3d(0.0, across_px, pair.focal_px)),
          .step_m_px = narrowed(turned.col(0)),
          .principal_u_px = static_cast<float>(pair.principal_u_px),
          .across2_m2_px2 = static_cast<float>(
              baseline_m2 * (across_px * across_px + pair.focal_px * pair.focal_px)),
          .step2_m2_px2 = static_cast<float>(baseline_m2),
          .offset_px = static_cast<float>(pair.disparity_offset_px)};
}

SphericalRow row_of(const SphericalPair& pair,
                    const ColumnAngles& columns,
                    const Pose& T_body_camera,
                    int v) {
  const double beta = (v - pair.principal_v_px) * pair.delta_theta_v_rad;
  return {.origin_m = narrowed(T_body_camera.translation()),
          .side = narrowed(T_body_camera.linear().col(0)),
          .ahead = narrowed(T_body_camera.linear() *
                            Eigen::Vector3d(0.0, std::sin(beta), std::cos(beta))),
          .sin_alpha = columns.sine.data(),
          .cos_alpha = columns.cosine.data(),
          .max_delta_rad = columns.max_delta_rad.data(),
          .delta_theta_u_rad = static_cast<float>(pair.delta_theta_u_rad),
          .baseline_m = static_cast<float>(pair.baseline_m)};
}

}  // namespace

struct Accumulator::State {
  State(const PairGeometry& geometry,
        const cv::Size& image_size_px,
        const GridGeometry& grid_geometry,
        const DepthRule& depth_rule,
        const SeenRule& seen)
      : pair(geometry),
        size_px(image_size_px),
        grid(grid_geometry),
        depth((check(depth_rule, "sphere"), depth_rule)),
        locate_grid(grid_geometry),
        limits{static_cast<float>(geometry.min_range_m), static_cast<float>(geometry.max_range_m)},
        columns(column_angles(geometry.model, image_size_px.width)),
        view(geometry, image_size_px, grid_geometry, seen),
        bands(kBands, Band(image_size_px.width, grid_geometry.cell_count(), depth_rule)) {}

  /// `model` is what `pair.model` holds, known for the whole band.
  template <class Model>
  void add_band(const Model& model, const cv::Mat1f& disparity, int index) noexcept {
    Band& band = bands[static_cast<std::size_t>(index)];
    band.clear();
    const LocatedRow located{band.cell.data(), band.range_m.data(), band.seen_m.data()};
    for (int v = size_px.height * index / kBands; v < size_px.height * (index + 1) / kBands; ++v) {
      std::copy_n(disparity[v], size_px.width, band.disparity_px.begin());
      const LocatedCounts counts = locate(row_of(model, columns, pair.T_body_camera, v),
                                          {locate_grid, limits, located},
                                          band.disparity_px.data(),
                                          size_px.width);
      band.counts.measured += counts.measured;
      band.counts.used += counts.used;
      if (counts.doubtful > 0) {
        locate_doubtful(model, v, band);
      }
      const auto width = static_cast<std::size_t>(size_px.width);
      band.points.add(std::span(band.cell).first(width), std::span(band.range_m).first(width));
      add_row(band.seen_m.data(), view.runs(v), band.looks);
    }
  }

  /// Pixels that single precision cannot place, in double precision.
  template <class Model>
  void locate_doubtful(const Model& model, int v, Band& band) noexcept {
    for (int u = 0; u < size_px.width; ++u) {
      const auto at = static_cast<std::size_t>(u);
      if (band.cell[at] != locate_grid.doubtful_cell) {
        continue;
      }
      band.cell[at] = locate_grid.no_cell;
      const Eigen::Vector3d p_camera_m = reproject(model, u, v, band.disparity_px[at]);
      const double camera_m = p_camera_m.norm();
      band.counts.measured += std::isnan(camera_m) ? 0 : 1;
      if (!(camera_m >= pair.min_range_m)) {
        band.seen_m[at] = camera_m < pair.min_range_m ? kTooNear : kInvalid;
        continue;
      }
      band.seen_m[at] = camera_m > pair.max_range_m ? kInfinity : static_cast<float>(camera_m);
      band.counts.used += camera_m <= pair.max_range_m ? 1 : 0;
      const SphericalPoint point = to_spherical(pair.T_body_camera * p_camera_m);
      const auto cell = grid.cell_of(point.theta_rad, point.phi_rad);
      if (cell && point.rho_m > 0.0 && camera_m <= pair.max_range_m) {
        band.cell[at] = grid.offset_of(*cell);
        band.range_m[at] = static_cast<float>(point.rho_m);
      }
    }
  }

  PairGeometry pair;
  cv::Size size_px;
  GridGeometry grid;
  DepthRule depth;
  LocateGrid locate_grid;
  LocateLimits limits;
  ColumnAngles columns;
  PairView view;
  std::vector<Band> bands;
};

Accumulator::Accumulator(const PairGeometry& pair,
                         const cv::Size& image_size_px,
                         const GridGeometry& grid,
                         const DepthRule& depth,
                         const SeenRule& seen)
    : state_(std::make_unique<State>(pair, image_size_px, grid, depth, seen)) {}

Accumulator::Accumulator(Accumulator&&) noexcept = default;
Accumulator& Accumulator::operator=(Accumulator&&) noexcept = default;
Accumulator::~Accumulator() = default;

PixelCounts Accumulator::accumulate(const cv::Mat1f& disparity, SphericalGrid& grid) {
  State& state = *state_;
  if (grid.geometry() != state.grid || grid.rule() != state.depth) {
    throw Error(ErrorKind::kInput, "spherical grid: not the accumulator's geometry and depth rule");
  }
  if (disparity.size() != state.size_px) {
    throw Error(
        ErrorKind::kInput,
        "disparity image: " + text_of(disparity.size()) + ", expected " + text_of(state.size_px));
  }
  for_each_index(kBands, [&](std::size_t i) {
    ask(state.pair.model,
        [&](const auto& model) { state.add_band(model, disparity, static_cast<int>(i)); });
  });
  // Each cell takes in the bands in their order, whichever thread does it.
  for_each_index(kBands, [&](std::size_t i) {
    const int part = static_cast<int>(i);
    const int cells = state.grid.cell_count();
    for (const Band& band : state.bands) {
      grid.merge(band.points, band.looks, {cells * part / kBands, cells * (part + 1) / kBands});
    }
  });
  PixelCounts counts;
  for (const Band& band : state.bands) {
    counts.measured += band.counts.measured;
    counts.used += band.counts.used;
  }
  grid.settle(state.view);
  return counts;
}

PixelCounts accumulate(const cv::Mat1f& disparity, const PairGeometry& pair, SphericalGrid& grid) {
  return Accumulator(pair, disparity.size(), grid.geometry(), grid.rule())
      .accumulate(disparity, grid);
}

}  // namespace skyhalo

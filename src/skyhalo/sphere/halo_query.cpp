#include "skyhalo/sphere/halo_query.hpp"

#include <algorithm>
#include <numbers>

#include "skyhalo/geometry/angle.hpp"
#include "skyhalo/geometry/spherical.hpp"
#include "skyhalo/sphere/ball_way.hpp"

namespace skyhalo {
namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;

std::optional<GridCell> cell_towards(const GridGeometry& grid,
                                     const Eigen::Vector3d& direction_body) noexcept {
  const SphericalPoint point = to_spherical(direction_body);
  return point.rho_m > 0.0 ? grid.cell_of(point.theta_rad, point.phi_rad) : std::nullopt;
}

/// An azimuth in [0, 2 pi) from the first one of a sector on.
double turned_from(double first_rad, double phi_rad) noexcept {
  const double turned = std::fmod(phi_rad - first_rad, kTurn);
  const double positive = turned < 0.0 ? turned + kTurn : turned;
  return positive < kTurn ? positive : 0.0;  // a tiny negative one rounds to a turn
}

/// Turns the body's frame level, with the nose's heading as azimuth 0.
Eigen::Matrix3d level_of(const Eigen::Matrix3d& R_map_body) noexcept {
  const double heading = std::atan2(R_map_body(1, 0), R_map_body(0, 0));
  return Eigen::AngleAxisd(-heading, Eigen::Vector3d::UnitZ()).toRotationMatrix() * R_map_body;
}

/// Sectors, without wrapping.
struct SectorSpan {
  int first;
  int last;
};

/// The sectors that a disc about a level direction reaches into.
SectorSpan sectors_of(const Eigen::Vector3d& level, double radius_rad) noexcept {
  const double azimuth = std::atan2(level.y(), level.x());
  const double sine = std::sin(radius_rad);
  const double aside = std::hypot(level.x(), level.y());
  const auto sector_of = [](double angle) {
    return static_cast<int>(std::lround(angle / kTurn * kRingSectors));
  };
  if (!(aside > sine)) {  // over the vertical
    return {0, kRingSectors - 1};
  }
  const double half_width = std::asin(sine / aside);
  const SectorSpan span{sector_of(azimuth - half_width), sector_of(azimuth + half_width)};
  return span.last - span.first < kRingSectors ? span : SectorSpan{0, kRingSectors - 1};
}

/// How far the ball travels along the tube's direction before it touches the cell's thing, or where
/// the cell is unseen.
TubeView way_to(const Halo& halo, GridCell cell, const Tube& tube, double cosine) noexcept {
  const double slack_rad = cell_radius_rad(halo.geometry());
  const double cosine_nearest = nearer_cosine(cosine, slack_rad);
  const auto depth_m = halo.depth_m(cell);
  const double to_thing_m = depth_m ? travel_to_touch_m(*depth_m, cosine_nearest, tube.radius_m)
                                    : std::numeric_limits<double>::infinity();
  const bool asked = cosine_nearest >= std::cos(tube.look_angle_rad);
  const double known_m = std::max(halo.free_to_m(cell), tube.radius_m);
  const double to_unseen_m = asked && !(depth_m && *depth_m <= known_m)
                                 ? travel_to_touch_m(known_m, cosine_nearest, tube.radius_m)
                                 : std::numeric_limits<double>::infinity();
  return to_thing_m <= to_unseen_m ? TubeView{Sight::kObstacle, to_thing_m, cell}
                                   : TubeView{Sight::kUnseen, to_unseen_m, cell};
}

}  // namespace

void RegionView::add(const Halo& halo, GridCell cell) noexcept {
  ++cells;
  const Sight sight = halo.sight(cell);
  free_to_m = std::min(free_to_m, halo.free_to_m(cell));
  unseen_cells += sight == Sight::kUnseen ? 1 : 0;
  if (sight == Sight::kObstacle && *halo.depth_m(cell) < nearest_m) {
    nearest_m = *halo.depth_m(cell);
    nearest_cell = cell;
  }
}

RegionView view_along(const Halo& halo, const Eigen::Vector3d& direction_body) noexcept {
  RegionView view;
  if (const auto cell = cell_towards(halo.geometry(), direction_body)) {
    view.add(halo, *cell);
  }
  return view;
}

RegionView view_in_cone(const Halo& halo,
                        const Eigen::Vector3d& axis_body,
                        double half_angle_rad) noexcept {
  const auto middle = cell_towards(halo.geometry(), axis_body);
  const Eigen::Vector3d axis = axis_body.normalized();
  const double least_cosine = std::cos(std::clamp(half_angle_rad, 0.0, std::numbers::pi));
  return view_where(halo, [&](GridCell cell, float) {
    return cell == middle || halo.geometry().center_direction(cell).dot(axis) >= least_cosine;
  });
}

RegionView view_in_box(const Halo& halo, const AngleBox& box) noexcept {
  const double width = box.phi_max_rad - box.phi_min_rad;
  const double width_rad = width >= kTurn ? kTurn : turned_from(0.0, width);
  const GridGeometry& grid = halo.geometry();
  return view_where(halo, [&](GridCell cell, float) {
    const double theta = grid.theta_min_rad + (cell.row + 0.5) * grid.theta_step_rad;
    const double phi = grid.phi_min_rad + (cell.col + 0.5) * grid.phi_step_rad;
    return theta >= box.theta_min_rad && theta < box.theta_max_rad &&
           (width_rad >= kTurn || turned_from(box.phi_min_rad, phi) < width_rad);
  });
}

Ring ring_of(const Halo& halo, const PitchBand& pitch, const Eigen::Matrix3d& R_map_body) noexcept {
  const Eigen::Matrix3d R_level_body = level_of(R_map_body);
  const GridGeometry& grid = halo.geometry();
  const double radius_rad = cell_radius_rad(grid);
  // Cells that cannot reach the band are left out by their height alone.
  constexpr double kQuarter = 0.5 * std::numbers::pi;
  const double lowest = std::sin(std::max(pitch.min_rad - radius_rad, -kQuarter)) - 1e-6;
  const double highest = std::sin(std::min(pitch.max_rad + radius_rad, kQuarter)) + 1e-6;
  Ring ring;
  for (int i = 0; i < grid.cell_count(); ++i) {
    const Eigen::Vector3d middle =
        R_level_body * halo.directions()[static_cast<std::size_t>(i)].cast<double>();
    if (!(middle.z() >= lowest && middle.z() <= highest)) {
      continue;
    }
    const SectorSpan span = sectors_of(middle, radius_rad);
    for (int sector = span.first; sector <= span.last; ++sector) {
      const int turned = ((sector % kRingSectors) + kRingSectors) % kRingSectors;
      ring[static_cast<std::size_t>(turned)].add(halo, {i / grid.cols, i % grid.cols});
    }
  }
  return ring;
}

TubeView view_along_tube(const Halo& halo, const Tube& tube) noexcept {
  const Eigen::Vector3d direction = tube.direction_body.normalized();
  const GridGeometry& grid = halo.geometry();
  const bool valid = std::abs(direction.squaredNorm() - 1.0) < 1e-6 && tube.radius_m >= 0.0 &&
                     tube.distance_m >= 0.0 && tube.look_angle_rad >= 0.0;
  if (!valid) {
    return {};
  }
  TubeView clear{Sight::kFree, tube.distance_m, std::nullopt};
  for (int i = 0; i < grid.cell_count(); ++i) {
    const double cosine =
        halo.directions()[static_cast<std::size_t>(i)].cast<double>().dot(direction);
    const TubeView way = way_to(halo, {i / grid.cols, i % grid.cols}, tube, cosine);
    if (way.clear_to_m < clear.clear_to_m) {
      clear = way;
    }
  }
  return clear;
}

}  // namespace skyhalo

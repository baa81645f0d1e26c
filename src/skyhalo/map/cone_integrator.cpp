#include "skyhalo/map/cone_integrator.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "skyhalo/geometry/lattice_walk.hpp"
#include "skyhalo/map/body_reach.hpp"

namespace skyhalo {
namespace {

/// How far a cone reaches along an axis of the map, of which its own axis has this component: the
/// largest component of its directions.
double reach_along(double component, double half_angle_rad) noexcept {
  const double angle_rad = std::acos(std::clamp(component, -1.0, 1.0));
  return std::max(0.0, std::cos(std::max(0.0, angle_rad - half_angle_rad)));
}

double angle_between(const Eigen::Vector3d& a, const Eigen::Vector3d& b) noexcept {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

/// Whether a ball may have points of a cone about `axis`, from its tip on.
bool may_touch(const Ray& axis,
               double half_angle_rad,
               const Eigen::Vector3d& center_m,
               double radius_m) noexcept {
  const Eigen::Vector3d from_tip_m = center_m - axis.origin_m;
  const double range_m = from_tip_m.norm();
  return range_m <= radius_m || angle_between(from_tip_m, axis.direction) <=
                                    half_angle_rad + std::asin(radius_m / range_m);
}

Increment rounded(double increment) noexcept {
  return static_cast<Increment>(std::lround(increment));
}

}  // namespace

ConeIntegrator::ConeIntegrator(const IntegrationConfig& config)
    : config_((check(config), config)), table_(config.sensor, kLogOddsPerUnit) {}

template <class Map>
bool ConeIntegrator::integrate(const RangeMeasurement& measurement,
                               const Pose& T_map_body,
                               Map& map) {
  if (!is_valid(measurement) || !can_enter(map.lattice(), T_map_body)) {
    return false;
  }
  const Cone cone = cone_of(measurement, T_map_body);
  const VoxelLattice& lattice = map.lattice();
  // Cells count that the sphere at the range touches, and none is looked at beyond some thousand.
  const double reach_m = std::min(cone.end_m + std::numbers::sqrt3 * lattice.voxel_m,
                                  kMostReachCells * lattice.voxel_m);
  const auto reach = [&](double sign) -> Eigen::Vector3d {
    return reach_m * cone.axis.direction.unaryExpr([&](double component) {
      return reach_along(sign * component, cone.half_angle_rad);
    });
  };
  const CellBox region = overlap(
      map.bounds(),
      cells_touching(lattice, cone.axis.origin_m - reach(-1.0), cone.axis.origin_m + reach(1.0)));
  map.begin_change();
  if (region.empty()) {
    return true;
  }
  marks_.begin(region);
  for_each_cell(bricks_touching(region), [&](const Eigen::Vector3i& brick) {
    mark_brick(cone, lattice, region, brick);
    return true;
  });
  mark_axis(cone, lattice, region);
  for (const Eigen::Vector3i& brick : marks_.bricks()) {
    map.prepare(brick, false);
    map.change(brick, *marks_.find(brick), config_.limit_units);
  }
  return true;
}

ConeIntegrator::Cone ConeIntegrator::cone_of(const RangeMeasurement& measurement,
                                             const Pose& T_map_body) const noexcept {
  const Pose T_map_sensor = T_map_body * measurement.T_body_sensor;
  const bool has_echo = measurement.range_m.has_value();
  const double range_m = measurement.range_m.value_or(measurement.max_range_m);
  const int row = table_.row_of(measurement.delta_z_m);
  const double behind_m =
      has_echo ? IncrementTable::kWidths * measurement.delta_z_m * table_.width_ratio(row) : 0.0;
  return {{T_map_sensor.translation(), T_map_sensor.linear().col(0)},
          measurement.half_angle_rad,
          range_m,
          has_echo,
          measurement.delta_z_m,
          range_m + behind_m,
          row};
}

/// What a place gets on the axis, by its distance behind the range.
double ConeIntegrator::said(const Cone& cone, double offset_m) const noexcept {
  if (!cone.has_echo) {
    return offset_m <= 0.0 ? table_.crossed() : 0.0;
  }
  return table_.increment(cone.table_row, cone.delta_z_m, offset_m);
}

/// The cells of a brick whose middles are in the cone. A cell at the range counts as hit when the
/// sphere about the sensor touches it.
void ConeIntegrator::mark_brick(const Cone& cone,
                                const VoxelLattice& lattice,
                                const CellBox& region,
                                const Eigen::Vector3i& brick) {
  const Eigen::Vector3d middle_m = lattice.corner_m(first_cell(brick)) +
                                   Eigen::Vector3d::Constant(0.5 * kBrickEdge * lattice.voxel_m);
  const double radius_m = 0.5 * std::numbers::sqrt3 * kBrickEdge * lattice.voxel_m;
  if (!may_touch(cone.axis, cone.half_angle_rad, middle_m, radius_m)) {
    return;
  }
  const Eigen::Vector3i first = first_cell(brick);
  const CellBox cells = overlap(region, {first, (first.array() + kBrickEdge).matrix()});
  for_each_cell(cells, [&](const Eigen::Vector3i& cell) {
    const Eigen::Vector3d from_tip_m = lattice.center_m(cell) - cone.axis.origin_m;
    const double m = from_tip_m.norm();
    const double angle_rad = angle_between(from_tip_m, cone.axis.direction);
    if (m > 0.0 && angle_rad < cone.half_angle_rad) {
      const double half_m = 0.5 * lattice.voxel_m * from_tip_m.lpNorm<1>() / m;
      const double d = m - cone.range_m;
      const double hit_m = d < 0.0 ? std::min(d + half_m, 0.0) : std::max(d - half_m, 0.0);
      const double offset_m = cone.has_echo ? hit_m : d + half_m;
      const Increment increment =
          rounded(said(cone, offset_m) * beam_weight(angle_rad, cone.half_angle_rad));
      if (increment != 0) {
        marks_.mark(cell, increment);
      }
    }
    return true;
  });
}

/// The cells that the axis crosses, as a ray of a scan does.
void ConeIntegrator::mark_axis(const Cone& cone,
                               const VoxelLattice& lattice,
                               const CellBox& region) {
  const RayInterval inside = overlap(clip(cone.axis, lattice, region), {0.0, cone.end_m});
  walk_lattice(
      lattice, cone.axis, inside, [&](const Eigen::Vector3i& cell, double from_m, double to_m) {
        const double value = said(cone, std::clamp(cone.range_m, from_m, to_m) - cone.range_m);
        const double share = value < 0.0 ? std::min(1.0, (to_m - from_m) / lattice.voxel_m) : 1.0;
        const Increment increment = rounded(value * share);
        if (increment != 0 && region.holds(cell)) {
          marks_.mark(cell, increment);
        }
        return true;
      });
}

template bool ConeIntegrator::integrate(const RangeMeasurement&, const Pose&, DenseMap&);
template bool ConeIntegrator::integrate(const RangeMeasurement&, const Pose&, LocalMap&);
template bool ConeIntegrator::integrate(const RangeMeasurement&, const Pose&, SparseMap&);

}  // namespace skyhalo

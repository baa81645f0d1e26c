#pragma once

#include "skyhalo/geometry/ray_walk.hpp"
#include "skyhalo/map/brick_marks.hpp"
#include "skyhalo/map/dense_map.hpp"
#include "skyhalo/map/local_map.hpp"
#include "skyhalo/map/scan_integrator.hpp"
#include "skyhalo/map/sparse_map.hpp"
#include "skyhalo/sensor_model/increment_table.hpp"
#include "skyhalo/sensor_model/range_measurement.hpp"

namespace skyhalo {

/// Enters the measurements of sonars, radars and single beams into maps of any kind, by the same
/// sensor model as scans: cells of the cone that are nearer than the range are free, those at the
/// range may be what gave the echo, each as much as `beam_weight` says. The axis counts in full
/// however narrow the beam is. Each cell changes at most once per measurement. Owns all memory that
/// a measurement needs; not for use by two threads at once.
class ConeIntegrator {
 public:
  /// Throws `Error` (input) when a setting is outside its domain.
  explicit ConeIntegrator(const IntegrationConfig& config);

  /// Enters one measurement. Returns whether it was valid; one that is not, and a pose that is not
  /// finite, change nothing.
  template <class Map>  // DenseMap, LocalMap or SparseMap
  bool integrate(const RangeMeasurement& measurement, const Pose& T_map_body, Map& map);

 private:
  /// A measurement in the map's frame.
  struct Cone {
    Ray axis;
    double half_angle_rad = 0.0;
    double range_m = 0.0;
    bool has_echo = false;
    double delta_z_m = 0.0;
    double end_m = 0.0;  // nothing is said of what is farther
    int table_row = 0;
  };

  [[nodiscard]] Cone cone_of(const RangeMeasurement& measurement,
                             const Pose& T_map_body) const noexcept;
  [[nodiscard]] double said(const Cone& cone, double offset_m) const noexcept;
  void mark_brick(const Cone& cone,
                  const VoxelLattice& lattice,
                  const CellBox& region,
                  const Eigen::Vector3i& brick);
  void mark_axis(const Cone& cone, const VoxelLattice& lattice, const CellBox& region);

  IntegrationConfig config_;
  IncrementTable table_;
  BrickMarks marks_;
};

}  // namespace skyhalo

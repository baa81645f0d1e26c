#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "skyhalo/map/end_marks.hpp"
#include "skyhalo/map/range_scan.hpp"
#include "skyhalo/sensor_model/increment_table.hpp"

namespace skyhalo {

/// Where the cells of a map are, as seen from the body.
struct CellFrame {
  Eigen::Matrix3f R_map_body = Eigen::Matrix3f::Identity();
  Eigen::Vector3f origin_cells = Eigen::Vector3f::Zero();  ///< the body, from the first cell on
  float voxel_m = 1.0F;
  bool thick = true;  ///< whether cells have a size (see `IntegrationConfig::cell_size_term`)
};

/// A patch's tilt follows from as many directions on each side.
inline constexpr int kNeighbours = 2;

/// What one row of directions has: the scan's, and the angles of its middle.
struct PatchRow {
  std::size_t first = 0;  ///< place of its first direction
  const float* z_m = nullptr;
  const float* per_m = nullptr;  ///< 1/range, with `kNeighbours` on each side; NaN for none
  std::ptrdiff_t stride = 0;     ///< of that, from row to row
  const float* delta_z_m = nullptr;
  const float* free_to_m = nullptr;
  const float* sin_phi = nullptr;  ///< of the columns
  const float* cos_phi = nullptr;
  float sin_theta = 0.0F;
  float cos_theta = 0.0F;
  float rows_per_rad = 0.0F;
};

/// Where a patch is. Numbers of one direction lie together, as cells read them together.
struct PatchPlace {
  float near_m = 0.0F;     ///< cells nearer than this are merely crossed
  float far_m = 0.0F;      ///< of cells from here on nothing is said; -1: of none
  float z_m = 0.0F;        ///< range in the middle of the direction; NaN for none
  std::int32_t tilts = 0;  ///< two halves: by which part of 65536 1/range changes per column
                           ///< (upper) and per row
};

/// What the sensor model says near a patch.
struct PatchModel {
  float half_m = 0.0F;        ///< half the thickness, along the ray
  float steps_before = 0.0F;  ///< columns of the increment table per metre in front
  float steps_behind = 0.0F;  ///< the same behind
  std::int32_t in_table = 0;  ///< place of the measurement itself in the increment table
};

/// The cells that hold the ends of rays, counted from some cell on, and what these get; that is 0
/// without a depth. A row of directions that end nowhere comes first.
struct RayEnds {
  std::vector<std::int32_t> x;
  std::vector<std::int32_t> y;
  std::vector<std::int32_t> z;
  std::vector<std::int32_t> peak;
};

/// A scan as the sweep of a map reads it: per direction a small plane patch of the surface that is
/// seen there. Its tilt follows from the neighbours' ranges on the side that goes on evenly, so
/// that cells between two rays lie on the right side of it and corners stay sharp (as by an
/// essentially non-oscillatory scheme: Harten et al. 1987), and its thickness from the tilt: a cell
/// that the plane touches is on it.
class ScanPatches {
 public:
  /// Works out all patches. Allocates when the scan has another number of rows than the last one.
  void find(const RangeScan& scan, const IncrementTable& table, const CellFrame& frame);

  /// Marks the cells of a region that hold the ends of rays, of what speaks for a thing there.
  /// `from`: the cell that ends are counted from. The marks' bricks are those that touch the
  /// region.
  void mark_ends(const Eigen::Vector3i& from, const CellBox& region, EndMarks& marks) const;

  int rows = 0;
  int cols = 0;
  std::vector<PatchPlace> places;
  std::vector<PatchModel> models;
  RayEnds ends;
  std::vector<float> sin_phi;  ///< of the columns
  std::vector<float> cos_phi;
  std::vector<float> sin_theta;  ///< of the rows
  std::vector<float> cos_theta;
  std::vector<float> per_m;  ///< 1/range, each row with neighbours at both ends, and rows beyond

 private:
  void invert(const RangeScan& scan);
  [[nodiscard]] float* per_m_row(int row) noexcept;
  void resize(int scan_rows);
};

}  // namespace skyhalo

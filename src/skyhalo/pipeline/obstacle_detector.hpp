#pragma once

#include <optional>
#include <vector>

#include "skyhalo/camera/stereo_rig.hpp"
#include "skyhalo/map/occupancy_map.hpp"
#include "skyhalo/pipeline/detector_config.hpp"
#include "skyhalo/pipeline/halo_scan.hpp"
#include "skyhalo/pipeline/stage_observer.hpp"
#include "skyhalo/sphere/accumulate.hpp"
#include "skyhalo/sphere/halo.hpp"
#include "skyhalo/sphere/spherical_grid.hpp"

namespace skyhalo {

/// What one pair saw in the last frame.
struct PairPerception {
  cv::Mat1f disparity;  ///< px at the matched resolution, aligned with the right image; NaN = none
  SphericalGrid grid;   ///< nearest distances by direction, body frame
  PixelCounts pixels;
  bool delivered = false;  ///< whether there were images; without, all else is of an earlier frame
};

/// The whole method: stereo frames and the vehicle's pose become a halo of nearest distances and an
/// occupancy map. Owns all memory that a frame needs; the same input gives the same bits at any
/// number of threads. Not for use by two threads at once.
class ObstacleDetector {
 public:
  /// With a map of any kind, which may hold something already. Throws `Error` (input) when a
  /// setting is outside its domain or the rig has no pair.
  ObstacleDetector(const StereoRig& rig, const DetectorConfig& config, OccupancyMap map);

  /// With a global map of these bounds.
  ObstacleDetector(const StereoRig& rig, const DetectorConfig& config, const VoxelGrid& map_grid);
  ObstacleDetector(const ObstacleDetector&) = delete;
  ObstacleDetector& operator=(const ObstacleDetector&) = delete;
  ObstacleDetector(ObstacleDetector&&) noexcept;
  ObstacleDetector& operator=(ObstacleDetector&&) noexcept;
  ~ObstacleDetector();

  /// Takes in one frame set, one entry per pair of the rig; a pair without images did not deliver:
  /// what it would have seen is unseen. Throws `Error` (input), leaves the map as it was and the
  /// halo unseen, when the images do not fit the rig.
  void process(const FrameSet& frames, const Pose& T_map_body, StageObserver* observer = nullptr);

  /// One pair's view of the last frame; valid until the next one.
  [[nodiscard]] const PairPerception& perception(std::size_t pair) const;

  /// The nearest distances in all directions, of the last frame's pairs together.
  [[nodiscard]] const Halo& halo() const noexcept { return halo_; }

  /// What the last frame told the map, for other maps to take in.
  [[nodiscard]] const RangeScan& scan() const noexcept { return scan_; }

  /// What the last frame did to the map.
  [[nodiscard]] const IntegrationReport& integration() const noexcept { return integration_; }

  [[nodiscard]] const OccupancyMap& map() const noexcept { return map_; }

  /// For what keeps a map within bounds from outside, between two frames.
  [[nodiscard]] OccupancyMap& map() noexcept { return map_; }

  /// The global map, if the detector was given one. Throws `std::bad_variant_access` otherwise.
  [[nodiscard]] const DenseMap& dense_map() const { return std::get<DenseMap>(map_); }

 private:
  struct PairEngine;

  void check_frames(const FrameSet& frames) const;
  void update_map(Timestamp stamp, const Pose& T_map_body);

  // By size, as `ScanIntegrator` has room for vectors.
  ScanIntegrator integrator_;
  std::optional<Timestamp> last_stamp_;
  std::vector<PairEngine> pairs_;
  std::vector<PairGrid> grids_;  // of the present frame
  std::vector<RangeModel> range_models_;
  IntegrationReport integration_;
  DecayClock decay_;
  Halo halo_;
  RangeScan scan_;
  OccupancyMap map_;
};

}  // namespace skyhalo

#pragma once

#include <vector>

#include "skyhalo/camera/stereo_rig.hpp"
#include "skyhalo/map/dense_map.hpp"
#include "skyhalo/pipeline/detector_config.hpp"
#include "skyhalo/pipeline/halo_rays.hpp"
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
  /// Throws `Error` (input) when a setting is outside its domain or the rig has no pair.
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

  /// How many measurements of the last frame went into the map.
  [[nodiscard]] int rays() const noexcept { return ray_count_; }

  [[nodiscard]] const DenseMap& map() const noexcept { return map_; }

 private:
  struct PairEngine;

  void check_frames(const FrameSet& frames) const;

  std::vector<PairEngine> pairs_;
  std::vector<PairGrid> grids_;  // of the present frame
  Halo halo_;
  HaloRays rays_;
  std::vector<RangeModel> range_models_;
  int ray_count_ = 0;
  DenseMap map_;
};

}  // namespace skyhalo

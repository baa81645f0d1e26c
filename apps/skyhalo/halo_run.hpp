#pragma once

#include <array>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "common_options.hpp"
#include "laser_check.hpp"
#include "skyhalo/dataset/frame_source.hpp"
#include "skyhalo/io/output_folder.hpp"
#include "skyhalo/pipeline/obstacle_detector.hpp"
#include "skyhalo/safety/velocity_limiter.hpp"
#include "skyhalo/sphere/halo_query.hpp"
#include "stage_clock.hpp"

namespace skyhalo::app {

/// What the laser says of a frame, and the halo of the same things.
struct Comparison {
  std::optional<double> laser_m;
  std::optional<double> laser_supported_m;
  std::optional<double> stereo_m;
  bool agrees = false;
  bool supported_agrees = false;  // with the nearest thing that more laser points bear out
  FreeClaims free;
};

/// What is written of one frame.
struct HaloRow {
  int frame = 0;
  Timestamp stamp;
  std::array<int, 3> cells{};  // by `Sight`
  RegionView forward;
  RegionView all;
  VelocityLimit limit;
  std::optional<Comparison> comparison;
};

/// What to do with which frames.
struct HaloSettings {
  FrameRange range;
  LaserCheck check;
  const LaserSource* laser = nullptr;  ///< null: compare with none
  bool has_poses = false;              ///< of the body; without, it counts as level
  std::set<int> picture_frames;
  bool quiet = false;
};

/// The file of a frame's picture.
[[nodiscard]] std::string picture_name(int frame);

/// Runs the frames of a recording, which must outlive it, through the detector and keeps what is to
/// be written of them.
class HaloRun {
 public:
  HaloRun(const FrameSource& source, const Config& config, HaloSettings settings);

  /// Pictures go to the folder.
  void process(const OutputFolder& out);

  [[nodiscard]] const HaloSettings& settings() const noexcept { return settings_; }

  [[nodiscard]] const std::vector<HaloRow>& rows() const noexcept { return rows_; }

  [[nodiscard]] const GridGeometry& grid() const noexcept { return detector_.halo().geometry(); }

  /// Frames that cannot be compared for want of a scan.
  [[nodiscard]] const std::vector<int>& without_scan() const noexcept { return without_scan_; }

  /// Frames that cannot be compared as their scan shows no road.
  [[nodiscard]] const std::vector<int>& without_road() const noexcept { return without_road_; }

  /// All stages but the map, which is none here.
  [[nodiscard]] std::vector<StageTimes> stages() const;

 private:
  struct Item;

  [[nodiscard]] Item read(int frame) const;
  void use(int frame, const Item& item, const OutputFolder& out);
  [[nodiscard]] HaloRow row_of(int frame, Timestamp stamp, const Eigen::Matrix3d& R_map_body);
  [[nodiscard]] Comparison compared(const LaserView& laser) const;

  const FrameSource& source_;
  HaloSettings settings_;
  ObstacleDetector detector_;
  VelocityLimiter limiter_;
  StageClock clock_;
  std::vector<HaloRow> rows_;
  std::vector<int> without_scan_;
  std::vector<int> without_road_;
};

}  // namespace skyhalo::app

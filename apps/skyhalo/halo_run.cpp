#include "halo_run.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "for_each_frame.hpp"
#include "skyhalo/base/number_text.hpp"
#include "skyhalo/geometry/angle.hpp"
#include "skyhalo/io/contact_sheet.hpp"
#include "skyhalo/io/halo_picture.hpp"
#include "skyhalo/io/image_file.hpp"
#include "skyhalo/io/picture.hpp"

namespace skyhalo::app {
namespace {

constexpr double kDesiredMps = 20.0;
constexpr double kBandDeg = 10.0;  // of the view from above, to either side of level

/// A map that the detector fills and nobody reads.
VoxelGrid tiny_grid(double voxel_m) {
  return make_voxel_grid(
      {Eigen::Vector3d::Constant(-0.5 * voxel_m), Eigen::Vector3d::Constant(0.5 * voxel_m)},
      voxel_m);
}

/// Full speed level ahead, from a standstill.
Motion motion_ahead(const Eigen::Matrix3d& R_map_body) {
  const double heading_rad = std::atan2(R_map_body(1, 0), R_map_body(0, 0));
  Motion motion;
  motion.desired_mps =
      kDesiredMps * Eigen::Vector3d(std::cos(heading_rad), std::sin(heading_rad), 0.0);
  motion.R_map_body = R_map_body;
  return motion;
}

std::array<int, 3> count_cells(const Halo& halo) {
  std::array<int, 3> cells{};
  const GridGeometry& grid = halo.geometry();
  for (int i = 0; i < grid.cell_count(); ++i) {
    ++cells.at(static_cast<std::size_t>(halo.sight({i / grid.cols, i % grid.cols})));
  }
  return cells;
}

cv::Mat3b eight_bit_colour(const cv::Mat& image) {
  cv::Mat bytes;
  image.convertTo(bytes, CV_8U, image.depth() == CV_16U ? 1.0 / 257.0 : 1.0);
  if (bytes.channels() != 3) {
    cv::cvtColor(bytes, bytes, bytes.channels() == 1 ? cv::COLOR_GRAY2BGR : cv::COLOR_BGRA2BGR);
  }
  return bytes;
}

/// The images, the disparities and the halo of the detector's last frame.
cv::Mat3b sheet(const ObstacleDetector& detector,
                const StereoRig& rig,
                const FrameSet& frames,
                const Eigen::Matrix3d& R_map_body,
                double max_range_m) {
  constexpr int kWidthPx = 1080;
  std::vector<TitledPicture> pictures;
  for (std::size_t pair = 0; pair < rig.pairs.size(); ++pair) {
    if (!detector.perception(pair).delivered) {
      continue;
    }
    const std::string& name = rig.pairs[pair].name;
    pictures.push_back({"right image, " + name, eight_bit_colour(frames.pairs[pair].right)});
    pictures.push_back({"disparity, " + name + ": yellow near, violet far, black none",
                        disparity_picture(detector.perception(pair).disparity)});
  }
  const Halo& halo = detector.halo();
  const PitchBand band{-rad_from_deg(kBandDeg), rad_from_deg(kBandDeg)};
  pictures.push_back({"halo: nearest thing in all directions from the body",
                      halo_picture(halo, std::max(1, kWidthPx / halo.geometry().cols))});
  pictures.push_back({number_text("halo from above, pitch within %.0f deg of level", kBandDeg) +
                          ": pale free, coloured the nearest thing, hatched not seen",
                      halo_top_picture(halo, band, R_map_body, max_range_m, kWidthPx)});
  return contact_sheet(pictures, 2, kWidthPx);
}

}  // namespace

/// A frame as it is read.
struct HaloRun::Item {
  FrameSet images;
  bool has_scan = false;
  std::optional<LaserView> laser;
};

std::string picture_name(int frame) {
  std::array<char, 48> name{};
  const int length = std::snprintf(name.data(), name.size(), "frame_%06d.png", frame);
  return {name.data(), static_cast<std::size_t>(length)};
}

HaloRun::HaloRun(const FrameSource& source, const Config& config, HaloSettings settings)
    : source_(source),
      settings_(std::move(settings)),
      detector_(source.rig(), config.detector, tiny_grid(config.detector.map.voxel_m)),
      limiter_(config.safety, detector_.halo()) {}

void HaloRun::process(const OutputFolder& out) {
  const FrameRange& range = settings_.range;
  ProgressBar bar("looking", range.last - range.first + 1, settings_.quiet);
  for_each_frame(
      range,
      bar,
      [&](int frame) { return read(frame); },
      [&](int frame, const Item& item) { use(frame, item, out); });
}

std::vector<StageTimes> HaloRun::stages() const {
  std::vector<StageTimes> times = clock_.times();
  std::erase_if(times, [](const StageTimes& t) { return t.stage == name_of(Stage::kMap); });
  return times;
}

/// Several threads read at once.
HaloRun::Item HaloRun::read(int frame) const {
  Item item{.images = source_.read(frame), .has_scan = false, .laser = {}};
  const LaserSource* const laser = settings_.laser;
  if (const auto scan = laser != nullptr ? laser->read_scan(frame) : std::nullopt) {
    item.has_scan = true;
    item.laser =
        view_of_laser(seen_points(*scan, *laser, settings_.check.max_range_m), settings_.check);
  }
  return item;
}

void HaloRun::use(int frame, const Item& item, const OutputFolder& out) {
  const Pose T_map_body = settings_.has_poses ? source_.T_map_body(frame) : Pose::Identity();
  detector_.process(item.images, T_map_body, &clock_);
  rows_.push_back(row_of(frame, item.images.stamp, T_map_body.linear()));
  if (item.laser) {
    rows_.back().comparison = compared(*item.laser);
  } else if (settings_.laser != nullptr) {
    (item.has_scan ? without_road_ : without_scan_).push_back(frame);
  }
  if (settings_.picture_frames.contains(frame)) {
    write_png(out.file(picture_name(frame)),
              sheet(detector_,
                    source_.rig(),
                    item.images,
                    T_map_body.linear(),
                    settings_.check.max_range_m));
  }
}

HaloRow HaloRun::row_of(int frame, Timestamp stamp, const Eigen::Matrix3d& R_map_body) {
  const Halo& halo = detector_.halo();
  return {.frame = frame,
          .stamp = stamp,
          .cells = count_cells(halo),
          .forward = view_in_cone(halo, Eigen::Vector3d::UnitX(), settings_.check.half_angle_rad),
          .all = view_where(halo, [](GridCell, float) { return true; }),
          .limit = limiter_.limit(halo, motion_ahead(R_map_body)),
          .comparison = {}};
}

Comparison HaloRun::compared(const LaserView& laser) const {
  const LaserCheck& check = settings_.check;
  const auto stereo_m = stereo_nearest_m(detector_.halo(), laser.road, check);
  return {.laser_m = laser.nearest_m,
          .laser_supported_m = laser.supported_m,
          .stereo_m = stereo_m,
          .agrees = agrees(laser.nearest_m, stereo_m, check.max_range_m),
          .supported_agrees = agrees(laser.supported_m, stereo_m, check.max_range_m),
          .free = free_claims(detector_.halo(), laser.points_body_m, check)};
}

}  // namespace skyhalo::app

#include "skyhalo/pipeline/obstacle_detector.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "skyhalo/base/error.hpp"
#include "skyhalo/base/for_each_index.hpp"
#include "skyhalo/rectify/rectifier.hpp"
#include "skyhalo/stereo/disparity_mask.hpp"
#include "skyhalo/stereo/matcher.hpp"

namespace skyhalo {
namespace {

/// Runs one stage and tells the observer, if there is one.
template <class Work>
void run_stage(StageObserver* observer, Stage stage, std::size_t pair, Work&& work) {
  if (observer != nullptr) {
    observer->begin(stage, pair);
  }
  work();
  if (observer != nullptr) {
    observer->end(stage, pair);
  }
}

/// The configuration's settings, but for what the pair's description says itself.
MatchingConfig settings_of(const StereoPair& pair, MatchingConfig matching) {
  matching.downscale = pair.downscale.value_or(matching.downscale);
  matching.rcrop_px = pair.rcrop_px.value_or(matching.rcrop_px);
  return matching;
}

/// Grids leave room for things as near to a camera as this (m).
constexpr double kNearestThingM = 0.5;

bool has_images(const StereoImages& images) noexcept {
  return !images.left.empty() || !images.right.empty();
}

/// The pair at the matched resolution.
PairGeometry geometry_of(const StereoPair& pair,
                         const MatchingConfig& matching,
                         const SphereConfig& sphere) {
  return {downscaled(pair.model, matching.downscale),
          pair.T_body_camera,
          pair.min_range_m.value_or(0.0),
          pair.max_range_m.value_or(sphere.max_range_m)};
}

/// How many pixels of the middle of the image look into one cell.
double pixels_per_cell(const PairModel& model, const cv::Size& size_px, double step_rad) {
  const double u = 0.5 * size_px.width;
  const double v = 0.5 * size_px.height;
  const Eigen::Vector3d ray = ray_of(model, u, v);
  const double across_rad = ray.cross(ray_of(model, u + 1.0, v)).norm();
  const double down_rad = ray.cross(ray_of(model, u, v + 1.0)).norm();
  return step_rad * step_rad / (across_rad * down_rad);
}

/// The configuration's rule, with the floor of the pair. Where a cell has few pixels, fewer of them
/// can bear out a depth.
DepthRule depth_rule_of(const StereoPair& pair,
                        const MatchingConfig& matching,
                        const SphereConfig& sphere) {
  const PairModel model = downscaled(pair.model, matching.downscale);
  const cv::Size size_px = pair.image_size_px / matching.downscale;
  const double quarter = 0.25 * pixels_per_cell(model, size_px, sphere.bounds.step_rad);
  DepthRule rule = sphere.depth;
  rule.min_range_m = min_range_m(model, size_px.width, matching.matcher.max_disparity_px);
  rule.nearest_count =
      std::clamp(static_cast<int>(std::min<double>(quarter, kMaxNearest)), 1, rule.nearest_count);
  return rule;
}

/// Places that the pair cannot measure yet, wherever in its view, are not asked for.
SeenRule seen_rule_of(const PairGeometry& pair, const DepthRule& depth, SeenRule rule) {
  const double nearest_m = std::max(pair.min_range_m, depth.min_range_m);
  rule.near_m = std::max(rule.near_m, nearest_m + pair.T_body_camera.translation().norm());
  return rule;
}

}  // namespace

/// The engines and memory of one pair.
struct ObstacleDetector::PairEngine {
  PairEngine(const StereoPair& pair, const DetectorConfig& config)
      : PairEngine(pair, config, settings_of(pair, config.matching)) {}

  PairEngine(const StereoPair& pair, const DetectorConfig& config, const MatchingConfig& settings)
      : description(pair),
        matching(settings),
        rectifier(pair, matching.downscale),
        matcher(matching.matcher),
        geometry(geometry_of(pair, matching, config.sphere)),
        matched_size_px(pair.image_size_px / matching.downscale),
        seen{.disparity = {},
             .grid = SphericalGrid(
                 grid_of_view(geometry, matched_size_px, config.sphere.bounds, kNearestThingM),
                 depth_rule_of(pair, matching, config.sphere)),
             .pixels = {}},
        accumulator(geometry,
                    matched_size_px,
                    seen.grid.geometry(),
                    seen.grid.rule(),
                    seen_rule_of(geometry, seen.grid.rule(), config.sphere.seen)) {}

  void rectify(const StereoImages& images) { rectified = &rectifier.rectify(images); }

  void match() {
    matcher.match(rectified->left, rectified->right, seen.disparity);
    discard_unseen(seen.disparity, rectified->right_valid, rectified->left_valid);
    discard_right_columns(seen.disparity, matching.rcrop_px);
    discard_rectangles(seen.disparity, description.masks_px, matching.downscale);
    discard_rectangles(seen.disparity, matching.masks_px, matching.downscale);
  }

  void fill_grid() {
    seen.grid.clear();
    seen.pixels = accumulator.accumulate(seen.disparity, seen.grid);
  }

  [[nodiscard]] PairGrid delivered(Timestamp stamp) const noexcept {
    return {seen.delivered ? &seen.grid : nullptr, stamp};
  }

  StereoPair description;
  MatchingConfig matching;
  Rectifier rectifier;
  const RectifiedPair* rectified = nullptr;  // inside `rectifier`, of the current frame
  Matcher matcher;
  PairGeometry geometry;
  cv::Size matched_size_px;
  PairPerception seen;
  Accumulator accumulator;
};

ObstacleDetector::ObstacleDetector(const StereoRig& rig,
                                   const DetectorConfig& config,
                                   const VoxelGrid& map_grid)
    : ObstacleDetector(rig, config, OccupancyMap(DenseMap(map_grid))) {}

ObstacleDetector::ObstacleDetector(const StereoRig& rig,
                                   const DetectorConfig& config,
                                   OccupancyMap map)
    : integrator_((check(config), integration_config(config))),
      decay_(config.map.decay),
      halo_(config.sphere.bounds.step_rad),
      scan_(halo_.geometry().rows),
      map_(std::move(map)) {
  if (rig.pairs.empty()) {
    throw Error(ErrorKind::kInput, "rig: expected at least one stereo pair");
  }
  pairs_.reserve(rig.pairs.size());
  for (const StereoPair& pair : rig.pairs) {
    pairs_.emplace_back(pair, config);
    range_models_.push_back({pairs_.back().geometry.model, config.sensor_model.delta_d_px});
  }
  grids_.resize(pairs_.size());
}

ObstacleDetector::ObstacleDetector(ObstacleDetector&&) noexcept = default;
ObstacleDetector& ObstacleDetector::operator=(ObstacleDetector&&) noexcept = default;
ObstacleDetector::~ObstacleDetector() = default;

void ObstacleDetector::process(const FrameSet& frames,
                               const Pose& T_map_body,
                               StageObserver* observer) {
  halo_.stitch({});  // nothing of an earlier frame stays, whatever happens in this one
  check_frames(frames);
  for_each_index(pairs_.size(), [&](std::size_t i) {
    PairEngine& pair = pairs_[i];
    pair.seen.delivered = has_images(frames.pairs[i]);
    if (pair.seen.delivered) {
      run_stage(observer, Stage::kRectify, i, [&] { pair.rectify(frames.pairs[i]); });
      run_stage(observer, Stage::kMatch, i, [&] { pair.match(); });       // thesis 5.1, 5.2
      run_stage(observer, Stage::kSphere, i, [&] { pair.fill_grid(); });  // thesis 5.3
    }
  });
  run_stage(observer, Stage::kStitch, 0, [&] {  // thesis 5.4
    std::transform(pairs_.begin(), pairs_.end(), grids_.begin(), [&](const PairEngine& pair) {
      return pair.delivered(frames.stamp);
    });
    halo_.stitch(grids_);
  });
  run_stage(observer, Stage::kMap, 0, [&] { update_map(frames.stamp, T_map_body); });
}

void ObstacleDetector::update_map(Timestamp stamp, const Pose& T_map_body) {
  if (LocalMap* local = std::get_if<LocalMap>(&map_)) {
    local->follow(T_map_body.translation());  // thesis 7.2.1
  }
  const double elapsed_s =
      last_stamp_ ? std::chrono::duration<double>(stamp - *last_stamp_).count() : 0.0;
  last_stamp_ = stamp;
  fill_scan(halo_, range_models_, scan_);
  std::visit(
      [&](auto& map) {
        if (const DecayStep step = decay_.pass(elapsed_s); forgets(step)) {
          map.decay(step);
        }
        integration_ = integrator_.integrate(scan_, T_map_body, map);  // thesis 6.2, 7.2.2
      },
      map_);
}

const PairPerception& ObstacleDetector::perception(std::size_t pair) const {
  return pairs_.at(pair).seen;
}

void ObstacleDetector::check_frames(const FrameSet& frames) const {
  if (frames.pairs.size() != pairs_.size()) {
    throw Error(ErrorKind::kInput,
                "frame set: " + std::to_string(frames.pairs.size()) +
                    " pairs of images for a rig of " + std::to_string(pairs_.size()));
  }
  for (std::size_t i = 0; i < pairs_.size(); ++i) {
    const StereoPair& pair = pairs_[i].description;
    if (has_images(frames.pairs[i]) &&
        (frames.pairs[i].left.size() != left_image_size_px(pair) ||
         frames.pairs[i].right.size() != right_image_size_px(pair))) {
      throw Error(ErrorKind::kInput,
                  "pair " + pair.name + ": images of another size than the rig's");
    }
  }
}

}  // namespace skyhalo

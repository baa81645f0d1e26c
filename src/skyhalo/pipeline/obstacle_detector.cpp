#include "skyhalo/pipeline/obstacle_detector.hpp"

#include <cmath>
#include <string>

#include "skyhalo/base/error.hpp"
#include "skyhalo/base/for_each_index.hpp"
#include "skyhalo/pipeline/grid_rays.hpp"
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

}  // namespace

/// The engines and memory of one pair.
struct ObstacleDetector::PairEngine {
  PairEngine(const StereoPair& pair, const DetectorConfig& config)
      : description(pair),
        matching(settings_of(pair, config.matching)),
        rectifier(pair, matching.downscale),
        matcher(matching.matcher),
        geometry{downscaled(pair.model, matching.downscale),
                 pair.T_body_camera,
                 pair.min_range_m.value_or(0.0),
                 pair.max_range_m.value_or(config.sphere.max_range_m)},
        seen{.disparity = {},
             .grid = SphericalGrid(make_grid_geometry(config.sphere.bounds)),
             .depth = {config.sphere.sigma_threshold_m,
                       config.sphere.sigma_factor,
                       min_range_m(geometry.model,
                                   pair.image_size_px.width / matching.downscale,
                                   matching.matcher.max_disparity_px)},
             .pixels = {}},
        rays(seen.grid.geometry()),
        range_model{geometry.model,
                    config.sensor_model,
                    seen.depth,
                    static_cast<int>(std::lround(config.map.log_odds_limit / kLogOddsPerUnit))} {}

  void rectify(const StereoImages& images) { rectified = &rectifier.rectify(images); }

  void match() {
    matcher.match(rectified->left, rectified->right, seen.disparity);
    discard_unseen(seen.disparity, rectified->right_valid, rectified->left_valid);
    discard_right_columns(seen.disparity, matching.rcrop_px);
    discard_rectangles(seen.disparity, description.masks_px, matching.downscale);
    discard_rectangles(seen.disparity, matching.masks_px, matching.downscale);
  }

  void fill_grid() noexcept {
    seen.grid.clear();
    seen.pixels = accumulate(seen.disparity, geometry, seen.grid);
  }

  void update(DenseMap& map, const Pose& T_map_body) noexcept {
    seen.rays = rays.integrate(seen.grid, range_model, T_map_body, map);
  }

  StereoPair description;
  MatchingConfig matching;
  Rectifier rectifier;
  const RectifiedPair* rectified = nullptr;  // inside `rectifier`, of the current frame
  Matcher matcher;
  PairGeometry geometry;
  PairPerception seen;
  GridRays rays;
  RangeModel range_model;
};

ObstacleDetector::ObstacleDetector(const StereoRig& rig,
                                   const DetectorConfig& config,
                                   const VoxelGrid& map_grid)
    : map_((check(config), map_grid)) {
  if (rig.pairs.empty()) {
    throw Error(ErrorKind::kInput, "rig: expected at least one stereo pair");
  }
  pairs_.reserve(rig.pairs.size());
  for (const StereoPair& pair : rig.pairs) {
    pairs_.emplace_back(pair, config);
  }
}

ObstacleDetector::ObstacleDetector(ObstacleDetector&&) noexcept = default;
ObstacleDetector& ObstacleDetector::operator=(ObstacleDetector&&) noexcept = default;
ObstacleDetector::~ObstacleDetector() = default;

void ObstacleDetector::process(const FrameSet& frames,
                               const Pose& T_map_body,
                               StageObserver* observer) {
  check_frames(frames);
  for_each_index(pairs_.size(), [&](std::size_t i) {
    PairEngine& pair = pairs_[i];
    run_stage(observer, Stage::kRectify, i, [&] { pair.rectify(frames.pairs[i]); });
    run_stage(observer, Stage::kMatch, i, [&] { pair.match(); });       // thesis 5.1, 5.2
    run_stage(observer, Stage::kSphere, i, [&] { pair.fill_grid(); });  // thesis 5.3
  });
  // One pair after the other, so that the map gets the same bits every time.
  for (std::size_t i = 0; i < pairs_.size(); ++i) {
    run_stage(observer, Stage::kMap, i, [&] { pairs_[i].update(map_, T_map_body); });  // 6.2, 7.1
  }
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
    if (frames.pairs[i].left.size() != left_image_size_px(pair) ||
        frames.pairs[i].right.size() != right_image_size_px(pair)) {
      throw Error(ErrorKind::kInput,
                  "pair " + pair.name + ": images of another size than the rig's");
    }
  }
}

}  // namespace skyhalo

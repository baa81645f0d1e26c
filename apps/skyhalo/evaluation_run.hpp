#pragma once

#include <vector>

#include "common_options.hpp"
#include "skyhalo/dataset/kitti_labels.hpp"
#include "skyhalo/dataset/kitti_raw.hpp"
#include "skyhalo/evaluation/ground_truth.hpp"
#include "skyhalo/evaluation/report.hpp"
#include "skyhalo/pipeline/obstacle_detector.hpp"
#include "stage_clock.hpp"

namespace skyhalo::app {

/// An evaluation in the making.
struct Evaluation {
  GroundTruth truth;
  ObstacleDetector detector;
  StageClock clock{};
  std::vector<FrameMetrics> rows{};
  std::vector<int> skipped_scans{};
};

/// Which frames, and whether progress is shown.
struct FrameLoop {
  FrameRange range;
  bool quiet = false;
};

/// Fills the ground truth from the laser scans of all frames.
void build_truth(const KittiRawDrive& drive,
                 const TrackLabels& labels,
                 const EvaluationConfig& config,
                 const FrameLoop& loop,
                 Evaluation& evaluation);

/// Maps the frames one by one and scores the map after each against the complete ground truth.
void map_and_score(const KittiRawDrive& drive,
                   const EvaluationConfig& config,
                   const FrameLoop& loop,
                   Evaluation& evaluation);

}  // namespace skyhalo::app

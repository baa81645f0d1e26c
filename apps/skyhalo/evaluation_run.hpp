#pragma once

#include <vector>

#include "common_options.hpp"
#include "skyhalo/evaluation/ground_truth.hpp"
#include "skyhalo/evaluation/report.hpp"
#include "skyhalo/pipeline/obstacle_detector.hpp"
#include "source.hpp"
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

/// Fills the ground truth from the laser scans of all frames; the recording has a laser.
void build_truth(const Recording& recording,
                 const BoxesOf& boxes_of,
                 const EvaluationConfig& config,
                 const FrameLoop& loop,
                 Evaluation& evaluation);

/// Maps the frames one by one and scores the map after each against the complete ground truth.
void map_and_score(const FrameSource& source,
                   const EvaluationConfig& config,
                   const FrameLoop& loop,
                   Evaluation& evaluation);

}  // namespace skyhalo::app

#include "evaluation_run.hpp"

#include <optional>

#include "for_each_frame.hpp"

namespace skyhalo::app {
namespace {

int frame_count(const FrameRange& range) {
  return range.last - range.first + 1;
}

/// What one scan says of the map's cells.
struct ScanCells {
  std::vector<std::int64_t> occupied;
  std::vector<std::uint8_t> observed;
};

/// None without a scan.
std::optional<ScanCells> truth_cells(const Recording& recording,
                                     const BoxesOf& boxes_of,
                                     double max_range_m,
                                     const VoxelGrid& grid,
                                     int frame) {
  const LaserSource& laser = *recording.laser;
  const std::optional<LaserScan> scan = laser.read_scan(frame);
  if (!scan) {
    return std::nullopt;
  }
  const std::vector<OrientedBox> boxes = boxes_of(frame);
  const TruthView view{laser.truth_camera(),
                       laser.T_annotation_laser(),
                       recording.frames->T_map_body(frame) * laser.T_body_laser(),
                       max_range_m};
  return ScanCells{occupied_cells(*scan, view, boxes, grid), observed_cells(*scan, view, grid)};
}

}  // namespace

void build_truth(const Recording& recording,
                 const BoxesOf& boxes_of,
                 const EvaluationConfig& config,
                 const FrameLoop& loop,
                 Evaluation& evaluation) {
  ProgressBar bar("ground truth", frame_count(loop.range), loop.quiet);
  for_each_frame(
      loop.range,
      bar,
      [&](int frame) {
        return truth_cells(recording, boxes_of, config.max_range_m, evaluation.truth.grid(), frame);
      },
      [&](int frame, const std::optional<ScanCells>& cells) {
        if (cells) {
          evaluation.truth.mark(cells->occupied);
          evaluation.truth.mark_observed(cells->observed);
        } else {
          evaluation.skipped_scans.push_back(frame);
        }
      });
}

void map_and_score(const FrameSource& source,
                   const EvaluationConfig& config,
                   const FrameLoop& loop,
                   Evaluation& evaluation) {
  ProgressBar bar("mapping", frame_count(loop.range), loop.quiet);
  for_each_frame(
      loop.range,
      bar,
      [&](int frame) { return source.read(frame); },
      [&](int frame, const FrameSet& frames) {
        evaluation.detector.process(frames, source.T_map_body(frame), &evaluation.clock);
        const auto cells = evaluation.detector.dense_map().cells();
        const GroundTruth& truth = evaluation.truth;
        const double p_occupied = config.occupied_probability;
        evaluation.rows.push_back({frame,
                                   score(cells, truth.occupied(), p_occupied),
                                   score(cells, truth.occupied(), p_occupied, truth.observed())});
      });
}

}  // namespace skyhalo::app

#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "skyhalo/evaluation/metrics.hpp"
#include "skyhalo/geometry/voxel_grid.hpp"

namespace skyhalo {

/// The scores after one frame.
struct FrameMetrics {
  int frame = 0;
  Metrics metrics;     ///< protocol `thesis`: all cells
  Metrics observed{};  ///< protocol `observed`: only cells that the laser crossed or ended in
};

/// One stage's times.
struct StageTimes {
  std::string stage;
  double p50_ms = 0.0;
  double p95_ms = 0.0;
};

/// A picture for the report, as the bytes of a PNG file.
struct ReportPicture {
  std::string caption;
  std::string note;
  std::string png;
};

/// What an evaluation found; everything that the files of a report are made of.
struct EvaluationResult {
  std::string version;
  std::string sequence;  ///< for instance "0003"
  std::string source;    ///< name of the recording
  VoxelGrid grid;
  double max_range_m = 0.0;
  std::int64_t occupied_cells = 0;  ///< of the ground truth
  std::vector<int> skipped_scans;   ///< frames whose laser scan is missing
  std::vector<FrameMetrics> rows;
  std::vector<StageTimes> stages;
  std::vector<ReportPicture> pictures;
  bool labelled = true;  ///< whether annotated boxes were left out of the ground truth
  double duration_s = 0.0;
  std::string config_yaml;
};

/// `metrics.csv`: a header and a row per frame; a score that is not defined is an empty field.
[[nodiscard]] std::string metrics_csv(const EvaluationResult& result);

/// `table.md`: the last row in the columns of the thesis's table 8.1, for both protocols, with the
/// thesis's own row for the sequence where it prints one.
[[nodiscard]] std::string metrics_table(const EvaluationResult& result);

/// `summary.json` and the `--json` line; a score that is not defined is null.
[[nodiscard]] nlohmann::json metrics_summary(const EvaluationResult& result);

/// `report.html`: one page with charts per frame that opens offline.
[[nodiscard]] std::string metrics_report(const EvaluationResult& result);

}  // namespace skyhalo

#include "skyhalo/evaluation/report.hpp"

#include <array>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <sstream>

#include "skyhalo/evaluation/report_template.hpp"
#include "skyhalo/evaluation/thesis_table.hpp"
#include "skyhalo/io/base64.hpp"

namespace skyhalo {
namespace {

using nlohmann::json;

/// A score's name in files, and where it is.
struct ScoreColumn {
  const char* name;
  double Metrics::*value;
};

struct CountColumn {
  const char* name;
  std::int64_t Metrics::*value;
};

constexpr std::array kCounts{CountColumn{"tp", &Metrics::tp},
                             CountColumn{"fp", &Metrics::fp},
                             CountColumn{"tn", &Metrics::tn},
                             CountColumn{"fn", &Metrics::fn}};

constexpr std::array kScores{ScoreColumn{"accuracy", &Metrics::accuracy},
                             ScoreColumn{"precision", &Metrics::precision},
                             ScoreColumn{"recall", &Metrics::recall},
                             ScoreColumn{"specificity", &Metrics::specificity},
                             ScoreColumn{"npv", &Metrics::npv},
                             ScoreColumn{"error", &Metrics::error},
                             ScoreColumn{"correlation", &Metrics::correlation}};

std::string decimal(double value, int digits) {
  if (!std::isfinite(value)) {
    return "";
  }
  std::array<char, 32> text{};
  const int length = std::snprintf(text.data(), text.size(), "%.*f", digits, value);
  return {text.data(), static_cast<std::size_t>(length)};
}

json to_json(const Metrics& metrics) {
  json object = json::object();
  for (const CountColumn& column : kCounts) {
    object[column.name] = metrics.*column.value;
  }
  for (const ScoreColumn& column : kScores) {
    const double value = metrics.*column.value;
    object[column.name] = std::isfinite(value) ? json(value) : json(nullptr);
  }
  return object;
}

json to_json(const FrameMetrics& row) {
  json object = to_json(row.metrics);
  object["frame"] = row.frame;
  object["observed"] = to_json(row.observed);
  return object;
}

std::string table_row(const std::string& name, const Metrics& metrics) {
  std::string row = "| " + name + " |";
  for (const CountColumn& column : kCounts) {
    row += " " + std::to_string(metrics.*column.value) + " |";
  }
  for (const ScoreColumn& column : kScores) {
    row += " " + decimal(metrics.*column.value, 3) + " |";
  }
  return row + "\n";
}

json bounds_json(const VoxelGrid& grid) {
  const Eigen::Vector3d& min_m = grid.min_m;
  const Eigen::Vector3d max_m = grid.max_m();
  return {min_m.x(), max_m.x(), min_m.y(), max_m.y(), min_m.z(), max_m.z()};
}

json stages_json(const EvaluationResult& result) {
  json stages = json::array();
  for (const StageTimes& stage : result.stages) {
    stages.push_back({{"stage", stage.stage}, {"p50_ms", stage.p50_ms}, {"p95_ms", stage.p95_ms}});
  }
  return stages;
}

/// The facts that summary and page share.
json facts_json(const EvaluationResult& result) {
  return {{"version", result.version},
          {"source", result.source},
          {"protocol", "thesis"},  // of the scores that stand by themselves
          {"frames", result.rows.size()},
          {"voxel_m", result.grid.voxel_m},
          {"bounds_m", bounds_json(result.grid)},
          {"max_range_m", result.max_range_m},
          {"cells", result.grid.cell_count()},
          {"occupied_cells", result.occupied_cells},
          {"skipped_scans", result.skipped_scans},
          {"labelled", result.labelled},
          {"seconds", result.duration_s},
          {"stages", stages_json(result)}};
}

}  // namespace

std::string metrics_csv(const EvaluationResult& result) {
  std::ostringstream out;
  out << "frame";
  for (const CountColumn& column : kCounts) {
    out << "," << column.name;
  }
  for (const ScoreColumn& column : kScores) {
    out << "," << column.name;
  }
  out << "\n";
  for (const FrameMetrics& row : result.rows) {
    out << row.frame;
    for (const CountColumn& column : kCounts) {
      out << "," << row.metrics.*column.value;
    }
    for (const ScoreColumn& column : kScores) {
      out << "," << decimal(row.metrics.*column.value, 6);
    }
    out << "\n";
  }
  return out.str();
}

std::string metrics_table(const EvaluationResult& result) {
  std::string table =
      "| seq | TP | FP | TN | FN | accuracy | precision | recall | specificity | npv | error | "
      "correlation |\n|---|---|---|---|---|---|---|---|---|---|---|---|\n";
  if (!result.rows.empty()) {
    table += table_row(result.sequence, result.rows.back().metrics);
    table += table_row(result.sequence + ", observed cells", result.rows.back().observed);
  }
  if (const auto thesis = thesis_row(result.sequence)) {
    table += table_row("thesis, " + result.sequence + " (whole sequence)", *thesis);
  }
  return table;
}

json metrics_summary(const EvaluationResult& result) {
  json summary = facts_json(result);
  json sequences = json::array();
  if (!result.rows.empty()) {
    json last = to_json(result.rows.back());
    last["sequence"] = result.sequence;
    summary.update(last);  // one sequence: its scores are the summary's own too
    sequences.push_back(last);
  }
  summary["sequences"] = sequences;
  json stages = json::object();
  for (const StageTimes& stage : result.stages) {
    stages[stage.stage] = {{"p50_ms", stage.p50_ms}, {"p95_ms", stage.p95_ms}};
  }
  summary["stages"] = stages;
  return summary;
}

std::string metrics_report(const EvaluationResult& result) {
  json data = facts_json(result);
  data["title"] = "KITTI " + result.sequence;
  data["sequence"] = result.sequence;
  data["config_yaml"] = result.config_yaml;
  data["rows"] = json::array();
  for (const FrameMetrics& row : result.rows) {
    data["rows"].push_back(to_json(row));
  }
  data["reference"] = nullptr;
  if (const auto thesis = thesis_row(result.sequence)) {
    data["reference"] = to_json(*thesis);
    data["reference"]["name"] = "thesis, table 8.1, " + result.sequence + " (whole sequence)";
  }
  data["pictures"] = json::array();
  for (const ReportPicture& picture : result.pictures) {
    data["pictures"].push_back({{"caption", picture.caption},
                                {"note", picture.note},
                                {"png_base64", base64(picture.png)}});
  }
  // A "</script>" inside the data would end the page's script.
  std::string text;
  for (const char c : data.dump(-1, ' ', false, json::error_handler_t::replace)) {
    text += c == '<' ? std::string("\\u003c") : std::string(1, c);
  }
  constexpr std::string_view kPlaceholder = "/*SKYHALO_DATA*/null";
  std::string page(kReportTemplate);
  return page.replace(page.find(kPlaceholder), kPlaceholder.size(), text);
}

}  // namespace skyhalo

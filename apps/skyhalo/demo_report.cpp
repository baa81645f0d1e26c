#include "demo_report.hpp"

#include <algorithm>
#include <numeric>
#include <sstream>

#include "demo_template.hpp"
#include "skyhalo/base/number_text.hpp"
#include "skyhalo/base/version.hpp"
#include "skyhalo/io/base64.hpp"
#include "skyhalo/io/image_file.hpp"
#include "skyhalo/io/svg_chart.hpp"

namespace skyhalo::app {
namespace {

using nlohmann::json;

std::string fixed(double value, int digits) {
  return number_text(digits == 0   ? "%.0f"
                     : digits == 1 ? "%.1f"
                     : digits == 2 ? "%.2f"
                                   : "%.3f",
                     value);
}

std::string percent(double share) {
  return fixed(100.0 * share, 1) + " %";
}

/// Text as it can stand in a page.
std::string escaped(const std::string& text) {
  std::string safe;
  for (const char c : text) {
    switch (c) {
      case '&':
        safe += "&amp;";
        break;
      case '<':
        safe += "&lt;";
        break;
      case '>':
        safe += "&gt;";
        break;
      default:
        safe += c;
    }
  }
  return safe;
}

double sum_of(const std::vector<DemoRow>& rows, double DemoRow::*value) {
  return std::accumulate(rows.begin(), rows.end(), 0.0, [&](double sum, const DemoRow& row) {
    return sum + row.*value;
  });
}

std::string tile(const std::string& value, const std::string& what) {
  return "<div class=\"tile\"><div class=\"value\">" + value + "</div><div class=\"soft\">" + what +
         "</div></div>\n";
}

std::string tiles(const json& summary) {
  return "<section class=\"grid\">\n" +
         tile(percent(summary["precision"].get<double>()),
              "of what the map calls occupied is there, to a cell") +
         tile(percent(summary["recall"].get<double>()),
              "of what is there and was seen within 15 m is in the map, to a cell") +
         tile(std::to_string(summary["flown_through_occupied"].get<int>()),
              "places that were flown through are called occupied") +
         tile(fixed(summary["frame_sets_per_s"].get<double>(), 1),
              "frame sets of all pairs a second on this machine") +
         "</section>\n";
}

std::string stage_table(const std::vector<StageTimes>& stages) {
  std::string rows;
  for (const StageTimes& times : stages) {
    rows += "<tr><td>" + escaped(times.stage) + "</td><td>" + fixed(times.p50_ms, 2) + "</td><td>" +
            fixed(times.p95_ms, 2) + "</td></tr>\n";
  }
  return "<table><tr><th>stage</th><th>median ms</th><th>95 % ms</th></tr>\n" + rows + "</table>\n";
}

std::string disparity_table(const DemoFlight& demo) {
  std::string rows;
  for (const DisparityScore& score : demo.disparities()) {
    rows += "<tr><td>" + escaped(score.pair) + "</td><td>" + fixed(score.median_px, 3) +
            "</td><td>" + percent(score.outliers) + "</td><td>" + percent(score.density) +
            "</td></tr>\n";
  }
  return "<table><tr><th>pair</th><th>median error px</th><th>above 2 px</th><th>pixels "
         "measured</th></tr>\n" +
         rows + "</table>\n";
}

std::string charts(const DemoFlight& demo) {
  ChartSeries precision{.label = "precision"};
  ChartSeries recall{.label = "recall"};
  ChartSeries times{.label = "all stages"};
  for (const DemoRow& row : demo.rows()) {
    if (row.score.exact > 0) {
      precision.points.emplace_back(row.frame, row.score.precision());
      recall.points.emplace_back(row.frame, row.score.recall());
    }
    times.points.emplace_back(row.frame, row.process_ms);
  }
  const std::vector<LineChart> panels{{.title = "The map against what is there",
                                       .x_label = "frame set",
                                       .y_label = "share",
                                       .y_range = ChartRange{0.0, 1.0},
                                       .series = {precision, recall}},
                                      {.title = "Time of a frame set, all pairs",
                                       .x_label = "frame set",
                                       .y_label = "ms",
                                       .series = {times}}};
  return "<figure class=\"chart\">" + svg_of(panels) + "</figure>\n";
}

std::string figures(const DemoFlight& demo) {
  std::string text;
  for (const TitledPicture& picture : demo.pictures()) {
    text += "<figure><img alt=\"" + escaped(picture.title) + "\" src=\"data:image/png;base64," +
            base64(encode_png(picture.picture)) + "\"><figcaption>" + escaped(picture.title) +
            "</figcaption></figure>\n";
  }
  return "<section class=\"pictures\">\n" + text + "</section>\n";
}

}  // namespace

json demo_summary(const DemoFlight& demo, const SimulatedFlight& flight, double duration_s) {
  const std::vector<DemoRow>& rows = demo.rows();
  const TolerantScore& score = rows.back().score;
  const auto frames = static_cast<double>(rows.size());
  json disparities = json::object();
  for (const DisparityScore& pair : demo.disparities()) {
    disparities[pair.pair] = {
        {"median_px", pair.median_px}, {"outliers", pair.outliers}, {"density", pair.density}};
  }
  return {{"version", kVersion},
          {"scene", flight.name()},
          {"seed", flight.config().seed},
          {"frame_sets", rows.size()},
          {"pairs", flight.rig().pairs.size()},
          {"flight_s", flight.time_s(flight.frame_count() - 1)},
          {"precision", score.precision()},
          {"recall", score.recall()},
          {"claimed_cells", score.claimed},
          {"claimed_right", score.claimed_right},
          {"exact_cells", score.exact},
          {"exact_found", score.exact_found},
          {"flown_through_occupied", demo.flown_through_occupied()},
          {"voxel_m", demo.exact().grid().voxel_m},
          {"frame_sets_per_s", 1e3 * frames / sum_of(rows, &DemoRow::process_ms)},
          {"stages", stages_json(demo.stages())},
          {"disparity", disparities},
          {"rendering_mpixel_per_s",
           1e-6 * frames * demo.pixels_per_frame() / sum_of(rows, &DemoRow::render_s)},
          {"duration_s", duration_s}};
}

std::string demo_text(const json& summary) {
  std::ostringstream text;
  text << summary["frame_sets"] << " frame sets of " << summary["pairs"]
       << " stereo pairs through the scene \"" << summary["scene"].get<std::string>() << "\"\n"
       << "  precision " << fixed(summary["precision"].get<double>(), 3) << " ("
       << summary["claimed_right"] << " of " << summary["claimed_cells"]
       << " cells that the map calls occupied)\n"
       << "  recall    " << fixed(summary["recall"].get<double>(), 3) << " ("
       << summary["exact_found"] << " of " << summary["exact_cells"]
       << " cells with something in them)\n"
       << "  against the exact map, cells of " << summary["voxel_m"]
       << " m that a camera saw within 15 m, to one cell\n"
       << "  places flown through that the map calls occupied: "
       << summary["flown_through_occupied"] << "\n"
       << "  " << fixed(summary["frame_sets_per_s"].get<double>(), 1)
       << " frame sets per second; median ms:";
  for (const auto& [stage, times] : summary["stages"].items()) {
    text << " " << stage << " " << fixed(times["p50_ms"].get<double>(), 1);
  }
  text << "\n";
  return text.str();
}

std::string demo_page(const DemoFlight& demo, const json& summary, const std::string& config_yaml) {
  constexpr std::string_view kPlaceholder = "<!--SKYHALO_CONTENT-->";
  const std::string content =
      "<h1>A flight through the " + escaped(summary["scene"].get<std::string>()) + "</h1>\n<p>" +
      std::to_string(summary["frame_sets"].get<int>()) + " frame sets of " +
      std::to_string(summary["pairs"].get<int>()) +
      " stereo pairs, simulated with exact truth, then taken through the method as on board: "
      "rectified, matched, folded into the halo, fused into maps. skyhalo " +
      escaped(summary["version"].get<std::string>()) + ".</p>\n" + tiles(summary) + charts(demo) +
      "<h2>Times</h2>\n<p>Rectify, match and sphere: one pair; stitch and map: all "
      "together.</p>\n" +
      stage_table(demo.stages()) +
      "<h2>Disparities</h2>\n<p>Against the exact ones, where both cameras see the point.</p>\n" +
      disparity_table(demo) +
      "<h2>Pictures</h2>\n<p>From the middle of the flight; maps at its "
      "end.</p>\n" +
      figures(demo) + "<details><summary>All numbers</summary><pre>" + escaped(summary.dump(2)) +
      "</pre></details>\n<details><summary>Settings</summary><pre>" + escaped(config_yaml) +
      "</pre></details>\n";
  std::string page(kDemoTemplate);
  return page.replace(page.find(kPlaceholder), kPlaceholder.size(), content);
}

}  // namespace skyhalo::app

#include "halo_output.hpp"

#include <array>
#include <cstdio>
#include <sstream>

#include "skyhalo/base/number_text.hpp"
#include "skyhalo/geometry/angle.hpp"

namespace skyhalo::app {
namespace {

const char* name_of(LimitReason reason) {
  switch (reason) {
    case LimitReason::kNone:
      return "none";
    case LimitReason::kObstacle:
      return "obstacle";
    case LimitReason::kUnseen:
      return "unseen";
    case LimitReason::kTurn:
      return "turn";
    case LimitReason::kInvalid:
      break;
  }
  return "invalid";
}

/// Seconds with all nine decimals of the stamp.
std::string stamp_text(Timestamp stamp) {
  const long long ns = stamp.time_since_epoch().count();
  std::array<char, 48> text{};
  const int length = std::snprintf(
      text.data(), text.size(), "%lld.%09lld", ns / 1'000'000'000, ns % 1'000'000'000);
  return {text.data(), static_cast<std::size_t>(length)};
}

/// Empty for none.
std::string range_text(const std::optional<double>& range_m) {
  return range_m ? number_text("%.3f", *range_m) : "";
}

std::string nearest_text(const RegionView& view) {
  return view.nearest_cell ? number_text("%.3f", view.nearest_m) : "";
}

/// The middle of the nearest cell, as azimuth and pitch.
std::string direction_text(const RegionView& view, const GridGeometry& grid) {
  if (!view.nearest_cell) {
    return ",";
  }
  const double theta = grid.theta_min_rad + (view.nearest_cell->row + 0.5) * grid.theta_step_rad;
  const double phi = grid.phi_min_rad + (view.nearest_cell->col + 0.5) * grid.phi_step_rad;
  return number_text("%.2f", deg_from_rad(phi)) + "," +
         number_text("%.2f", 90.0 - deg_from_rad(theta));
}

std::string comparison_text(const std::optional<Comparison>& found) {
  if (!found) {
    return ",,,,,";
  }
  return "," + range_text(found->laser_m) + "," + range_text(found->stereo_m) + "," +
         (found->agrees ? "1" : "0") + "," + range_text(found->laser_supported_m) + "," +
         (found->supported_agrees ? "1" : "0");
}

}  // namespace

std::string halo_csv(const HaloRun& run) {
  const bool laser = run.settings().laser != nullptr;
  std::ostringstream csv;
  csv << "frame,stamp_s,obstacle_cells,free_cells,unseen_cells,forward_nearest_m,nearest_m,"
         "azimuth_deg,pitch_deg,forward_limit_mps,reason"
      << (laser ? ",laser_nearest_m,stereo_nearest_m,agrees,laser_supported_m,supported_agrees"
                : "")
      << "\n";
  for (const HaloRow& row : run.rows()) {
    const auto cells = [&](Sight sight) { return row.cells.at(static_cast<std::size_t>(sight)); };
    csv << row.frame << "," << stamp_text(row.stamp) << "," << cells(Sight::kObstacle) << ","
        << cells(Sight::kFree) << "," << cells(Sight::kUnseen) << "," << nearest_text(row.forward)
        << "," << nearest_text(row.all) << "," << direction_text(row.all, run.grid()) << ","
        << number_text("%.3f", row.limit.velocity_mps.norm()) << "," << name_of(row.limit.reason)
        << (laser ? comparison_text(row.comparison) : "") << "\n";
  }
  return csv.str();
}

namespace {

nlohmann::json range_json(const std::optional<double>& range_m) {
  return range_m ? nlohmann::json(*range_m) : nlohmann::json();
}

/// How often laser and halo agree: of all the laser's things, or of those that are borne out.
nlohmann::json agreement_json(const std::vector<HaloRow>& rows, bool supported) {
  int compared = 0;
  int agreeing = 0;
  nlohmann::json disagreeing = nlohmann::json::array();
  for (const HaloRow& row : rows) {
    if (!row.comparison) {
      continue;
    }
    const Comparison& found = *row.comparison;
    ++compared;
    if (supported ? found.supported_agrees : found.agrees) {
      ++agreeing;
    } else {
      disagreeing.push_back(
          {{"frame", row.frame},
           {"laser_m", range_json(supported ? found.laser_supported_m : found.laser_m)},
           {"stereo_m", range_json(found.stereo_m)}});
    }
  }
  return {{"frames_compared", compared},
          {"agreeing", agreeing},
          {"agreement", compared > 0 ? nlohmann::json(1.0 * agreeing / compared) : nullptr},
          {"disagreeing", disagreeing}};
}

/// How often the laser contradicts that a cell is free, over all frames.
nlohmann::json free_json(const std::vector<HaloRow>& rows) {
  FreeClaims all;
  for (const HaloRow& row : rows) {
    all.cells += row.comparison ? row.comparison->free.cells : 0;
    all.contradicted += row.comparison ? row.comparison->free.contradicted : 0;
  }
  return {{"cells", all.cells},
          {"contradicted", all.contradicted},
          {"contradicted_share",
           all.cells > 0 ? nlohmann::json(1.0 * all.contradicted / all.cells) : nullptr}};
}

nlohmann::json laser_json(const HaloRun& run) {
  nlohmann::json laser = agreement_json(run.rows(), false);
  laser["bound"] = kAgreementBound;
  laser["clearance_m"] = run.settings().check.clearance_m;
  laser["max_range_m"] = run.settings().check.max_range_m;
  laser["free"] = free_json(run.rows());
  laser["without_scan"] = run.without_scan();
  laser["without_road"] = run.without_road();
  laser["supported"] = agreement_json(run.rows(), true);
  laser["supported"]["points"] = run.settings().check.support_count;
  laser["supported"]["radius_m"] = run.settings().check.support_radius_m;
  return laser;
}

}  // namespace

nlohmann::json halo_summary(const HaloRun& run) {
  const FrameRange& range = run.settings().range;
  const int dropped = range.last - range.first + 1 - static_cast<int>(run.rows().size());
  nlohmann::json pictures = nlohmann::json::array();
  for (const int frame : run.settings().picture_frames) {
    pictures.push_back(picture_name(frame));
  }
  nlohmann::json summary = {{"frames", run.rows().size()},
                            {"dropped", dropped},
                            {"step_deg", deg_from_rad(run.grid().theta_step_rad)},
                            {"cone_deg", deg_from_rad(run.settings().check.half_angle_rad)},
                            {"pictures", pictures},
                            {"stages", stages_json(run.stages())}};
  if (run.settings().laser != nullptr) {
    summary.update(laser_json(run));
  }
  return summary;
}

std::string describe_halo(const nlohmann::json& summary) {
  std::ostringstream text;
  text << summary["frames"] << " frames, " << summary["dropped"] << " dropped\n";
  if (summary.contains("frames_compared")) {
    text << "laser and halo agree on the nearest thing ahead in " << summary["agreeing"] << " of "
         << summary["frames_compared"] << " frames (of things that several laser points bear out: "
         << summary["supported"]["agreeing"] << ")\n";
    for (const nlohmann::json& frame : summary["disagreeing"]) {
      text << "  frame " << frame["frame"] << ": laser " << frame["laser_m"] << " m, halo "
           << frame["stereo_m"] << " m\n";
    }
  }
  text << "Written to " << summary["out"].get<std::string>() << ": halo.csv, summary.json";
  if (!summary["pictures"].empty()) {
    text << ", " << summary["pictures"].size() << " frame_*.png";
  }
  return text.str() + "\n";
}

}  // namespace skyhalo::app

#include <algorithm>
#include <chrono>
#include <memory>
#include <utility>

#include "commands.hpp"
#include "common_options.hpp"
#include "demo_report.hpp"
#include "simulation.hpp"
#include "skyhalo/calibration/rig_file.hpp"
#include "skyhalo/io/contact_sheet.hpp"
#include "skyhalo/io/image_file.hpp"
#include "skyhalo/io/map_file.hpp"
#include "skyhalo/io/output_folder.hpp"
#include "source.hpp"

namespace skyhalo::app {
namespace {

struct DemoOptions {
  CommonOptions common;
  SimulationOptions simulation{.usual_frames = 54};
  std::string rig;
  std::string out = "out/demo";
};

/// For maps rather than for warnings: finer directions than by default, at 15 m a quarter of a
/// cell, and in each the mean of its ranges.
Config demo_config() {
  Config config;
  config.detector.sphere.depth.kind = DepthRuleKind::kMean;
  config.detector.sphere.bounds.step_rad = rad_from_deg(0.5);
  config.detector.matching.matcher.sgm.texture_min_grey = 8;
  return config;
}

RigDescription open_description(const DemoOptions& options, const Config& config) {
  if (options.rig.empty()) {
    return reference_rig();
  }
  open_rig(options.rig, options.common, config);  // says what looks wrong in it
  return read_rig_file(options.rig).description;
}

/// The pictures on one sheet, without those of the pairs but the first two.
cv::Mat3b overview(const std::vector<TitledPicture>& pictures, std::size_t pairs) {
  constexpr std::size_t kPerPair = 3;
  std::vector<TitledPicture> chosen;
  for (std::size_t i = 0; i < pictures.size(); ++i) {
    if (i < kPerPair * std::min<std::size_t>(pairs, 2) || i >= kPerPair * pairs) {
      chosen.push_back(pictures[i]);
    }
  }
  return contact_sheet(chosen, 3, 640);
}

void demo(const DemoOptions& options) {
  const auto start = std::chrono::steady_clock::now();
  Config config = load_config(options.common, demo_config());
  const std::string settings = to_yaml(config);
  const ThreadLimit limit(options.common.threads);
  const RigDescription rig =
      at_matched_resolution(open_description(options, config), config.detector.matching);
  OutputFolder out(options.out);
  const SimulationOptions& wish = options.simulation;
  print_note(options.common, "making the scene \"" + wish.scene + "\"");
  const auto flight = make_flight(wish, options.common, open_scene(wish), resolve(rig));
  DemoFlight run(*flight, config);
  run.run(options.common.quiet);

  const double duration_s =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  nlohmann::json summary = demo_summary(run, *flight, duration_s);
  summary["out"] = options.out;
  write_png(out.file("overview.png"), overview(run.pictures(), flight->rig().pairs.size()));
  write_ply(out.file("map.ply"),
            occupied_points(run.map(), config.evaluation.occupied_probability));
  write_bytes(out.file("summary.json"), summary.dump(2) + "\n");
  write_bytes(out.file("report.html"), demo_page(run, summary, settings));
  out.commit();
  print_result(options.common,
               demo_text(summary) + "Look at it: open " + (out.folder() / "report.html").string() +
                   " in a browser\n",
               summary);
}

}  // namespace

void add_demo(CLI::App& program) {
  auto options = std::make_shared<DemoOptions>();
  CLI::App* command = program.add_subcommand(
      "demo",
      "a simulated flight of the reference platform through the whole method, scored against the\n"
      "exact map; writes report.html, summary.json, map.ply and overview.png\n"
      "It takes sphere.step_deg=0.5, sphere.rule=mean, sgm.texture_min_grey=8; --config replaces "
      "them.");
  add_simulation_options(*command, options->simulation);
  command
      ->add_option("--rig",
                   options->rig,
                   "rig file of the cameras (default: the reference platform's four pairs)")
      ->type_name("FILE");
  command->add_option("--out", options->out, "folder for the results")
      ->type_name("DIR")
      ->capture_default_str();
  add_common_options(*command, options->common);
  command->callback([options] { demo(*options); });
}

}  // namespace skyhalo::app

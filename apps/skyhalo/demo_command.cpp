#include <memory>
#include <opencv2/imgproc.hpp>
#include <sstream>

#include "commands.hpp"
#include "common_options.hpp"
#include "skyhalo/dataset/image_pair.hpp"
#include "skyhalo/io/contact_sheet.hpp"
#include "skyhalo/io/image_file.hpp"
#include "skyhalo/io/map_file.hpp"
#include "skyhalo/io/output_folder.hpp"
#include "skyhalo/io/picture.hpp"
#include "skyhalo/pipeline/obstacle_detector.hpp"
#include "stage_clock.hpp"

namespace skyhalo::app {
namespace {

struct DemoOptions {
  CommonOptions common;
  std::string left = "/usr/share/doc/opencv-doc/examples/data/aloeL.jpg";
  std::string right = "/usr/share/doc/opencv-doc/examples/data/aloeR.jpg";
  std::string out = "out/demo";
};

/// The "Aloe" pair of the Middlebury 2006 data sets, with the numbers published with them: f 3740
/// px, views 160 mm apart, disparities counted from 270 px. The camera looks forward from the body
/// origin.
StereoPair aloe_pair() {
  Eigen::Matrix3d R_body_camera;
  R_body_camera << 0.0, 0.0, 1.0, -1.0, 0.0, 0.0, 0.0, -1.0, 0.0;
  return {.name = "aloe",
          .image_size_px = {},
          .model = PinholePair{.focal_px = 3740.0,
                               .principal_u_px = 640.5,
                               .principal_v_px = 554.5,
                               .baseline_m = 0.160,
                               .disparity_offset_px = 270.0},
          .T_body_camera = make_pose(R_body_camera, Eigen::Vector3d::Zero()),
          .masks_px = {}};
}

/// Settings for a table top seen through a long lens: fine cells over a narrow view.
Config aloe_config() {
  Config config;
  config.detector.matching.matcher.max_disparity_px = 128;
  config.detector.matching.rcrop_px = 0;
  config.detector.sphere.bounds = {.theta_min_rad = rad_from_deg(80.0),
                                   .theta_max_rad = rad_from_deg(100.0),
                                   .phi_min_rad = rad_from_deg(-10.0),
                                   .phi_max_rad = rad_from_deg(10.0),
                                   .step_rad = rad_from_deg(0.25)};
  config.detector.sphere.depth.sigma_threshold_m = 0.02;
  config.detector.map.voxel_m = 0.01;
  return config;
}

cv::Mat3b colour(const cv::Mat& image) {
  cv::Mat3b picture;
  if (image.channels() == 1) {
    cv::cvtColor(image, picture, cv::COLOR_GRAY2BGR);
  } else {
    picture = image;
  }
  return picture;
}

nlohmann::json summarise(const ObstacleDetector& detector, double occupied_probability) {
  const PairPerception& seen = detector.perception(0);
  const DenseMap& map = detector.dense_map();
  return {{"frame_sets", 1},
          {"density",
           static_cast<double>(seen.pixels.measured) / static_cast<double>(seen.disparity.total())},
          {"grid_cells", seen.grid.geometry().cell_count()},
          {"grid_cells_with_depth", seen.grid.occupied_cell_count()},
          {"rays", detector.integration().things},
          {"map_cells", map.grid().cell_count()},
          {"occupied_cells", occupied_points(map, occupied_probability).size()}};
}

void demo(const DemoOptions& options) {
  const Config config = load_config(options.common, aloe_config());
  const ThreadLimit limit(options.common.threads);
  const ImagePairSource source(options.left, options.right, aloe_pair());
  OutputFolder out(options.out);
  const Eigen::AlignedBox3d bounds(Eigen::Vector3d(0.9, -0.4, -0.4),
                                   Eigen::Vector3d(2.1, 0.4, 0.4));
  ObstacleDetector detector(
      source.rig(), config.detector, make_voxel_grid(bounds, config.detector.map.voxel_m));
  const FrameSet frames = source.read(0);
  StageClock clock;
  detector.process(frames, source.T_map_body(0), &clock);

  const PairPerception& seen = detector.perception(0);
  const double p_occupied = config.evaluation.occupied_probability;
  nlohmann::json summary = summarise(detector, p_occupied);
  summary["stages"] = stages_json(clock.times());
  summary["out"] = options.out;
  const std::vector<TitledPicture> pictures{
      {"right image", colour(frames.pairs.front().right)},
      {"disparity (bright is near)", disparity_picture(seen.disparity)},
      {"spherical grid, unrolled (bright is near)", grid_picture(seen.grid, 8)},
      {"map slice from above (black is occupied)", slice_picture(detector.dense_map(), 0.0, 4)}};
  write_png(out.file("overview.png"), contact_sheet(pictures, 2, 480));
  write_ply(out.file("map.ply"), occupied_points(detector.dense_map(), p_occupied));
  write_bytes(out.file("summary.json"), summary.dump(2) + "\n");
  out.commit();

  std::ostringstream text;
  text << "One stereo pair, " << summary["rays"] << " rays, " << summary["occupied_cells"]
       << " occupied cells of " << config.detector.map.voxel_m << " m.\n"
       << "Look at " << (out.folder() / "overview.png").string() << " and "
       << (out.folder() / "map.ply").string() << " (MeshLab, CloudCompare).\n";
  print_result(options.common, text.str(), summary);
}

}  // namespace

void add_demo(CLI::App& program) {
  auto options = std::make_shared<DemoOptions>();
  CLI::App* command = program.add_subcommand(
      "demo",
      "the whole way on one real stereo pair: disparity, spherical grid, map\n"
      "writes overview.png, map.ply and summary.json\n"
      "It has settings of its own, for a table top in close-up; --config replaces them.");
  command->add_option("--left", options->left, "left image of the Aloe pair (Debian: opencv-doc)")
      ->type_name("FILE")
      ->capture_default_str();
  command->add_option("--right", options->right, "right image")
      ->type_name("FILE")
      ->capture_default_str();
  command->add_option("--out", options->out, "folder for the results")
      ->type_name("DIR")
      ->capture_default_str();
  add_common_options(*command, options->common);
  command->callback([options] { demo(*options); });
}

}  // namespace skyhalo::app

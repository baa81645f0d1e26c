#include <iostream>
#include <map>
#include <memory>
#include <optional>

#include "commands.hpp"
#include "common_options.hpp"
#include "rig_report.hpp"
#include "skyhalo/base/error.hpp"
#include "skyhalo/calibration/calibration_import.hpp"
#include "skyhalo/calibration/rig_file.hpp"
#include "skyhalo/geometry/angle.hpp"
#include "skyhalo/io/output_folder.hpp"
#include "skyhalo/io/text_file.hpp"

namespace skyhalo::app {
namespace {

const std::map<std::string, Facing> kFacings = {{"forward", Facing::kForward},
                                                {"left", Facing::kLeft},
                                                {"right", Facing::kRight},
                                                {"back", Facing::kBack},
                                                {"down", Facing::kDown},
                                                {"up", Facing::kUp}};

std::vector<std::string> words(const auto& map) {
  std::vector<std::string> keys;
  keys.reserve(map.size());
  for (const auto& [word, value] : map) {
    keys.push_back(word);
  }
  return keys;
}

struct ImportCommand {
  CommonOptions common;
  std::vector<std::string> files;
  std::string out;
  std::string format = "auto";
  std::string facing = "forward";
  std::string body = "imu";
  std::string size;
  std::string name;
  std::string model = "auto";
  bool fisheye = false;
  std::optional<double> hfov_deg;
  std::optional<double> vfov_deg;
};

struct CheckCommand {
  CommonOptions common;
  std::string file;
};

std::optional<cv::Size> parse_size(const std::string& text) {
  if (text.empty()) {
    return std::nullopt;
  }
  const std::size_t times = text.find('x');
  const std::optional<int> width = parse_whole_number(text.substr(0, times));
  const std::optional<int> height =
      times == std::string::npos ? std::nullopt : parse_whole_number(text.substr(times + 1));
  if (!width || !height || *width < 1 || *height < 1) {
    throw UsageError("--size " + text + ": expected WIDTHxHEIGHT, for instance 1242x375");
  }
  return cv::Size(*width, *height);
}

const std::map<std::string, CalibrationFormat> kFormats = {
    {"auto", CalibrationFormat::kAuto},
    {"kalibr", CalibrationFormat::kKalibr},
    {"euroc", CalibrationFormat::kEuroc},
    {"opencv", CalibrationFormat::kOpencv},
    {"ros", CalibrationFormat::kRos},
    {"basalt", CalibrationFormat::kBasalt},
    {"kitti-raw", CalibrationFormat::kKittiRaw},
    {"kitti-tracking", CalibrationFormat::kKittiTracking}};

std::string word_of(CalibrationFormat format) {
  for (const auto& [word, candidate] : kFormats) {
    if (candidate == format) {
      return word;
    }
  }
  return "";
}

/// A field that a pinhole would stretch too much at its sides.
bool is_wide(const RawPair& cameras) {
  constexpr double kWidestPinhole = rad_from_deg(110.0);
  try {
    const VirtualPair pair = make_virtual_pair(cameras, {.model = PairModelKind::kSpherical});
    return field_of_view(pair.model, pair.size_px).horizontal_rad > kWidestPinhole;
  } catch (const Error&) {  // the check tells what is wrong with it
    return false;
  }
}

void check_angle(const char* option, const std::optional<double>& angle_deg) {
  if (angle_deg && !(*angle_deg > 0.0 && *angle_deg <= 360.0)) {
    throw UsageError(std::string(option) + ": expected an angle above 0 degrees");
  }
}

void choose_models(const ImportCommand& options, RigDescription& rig) {
  for (PairDescription& pair : rig.pairs) {
    if (auto* raw = std::get_if<RawPairDescription>(&pair.images)) {
      const bool spherical =
          options.model == "spherical" || (options.model == "auto" && is_wide(raw->cameras));
      raw->rectify_to.model = spherical ? PairModelKind::kSpherical : PairModelKind::kPinhole;
      if (options.hfov_deg) {
        raw->rectify_to.hfov_rad = rad_from_deg(*options.hfov_deg);
      }
      if (options.vfov_deg) {
        raw->rectify_to.vfov_rad = rad_from_deg(*options.vfov_deg);
      }
    }
  }
}

/// Throws for the first pair that cannot be used.
void refuse_unusable(const std::string& file, const RigReport& report) {
  if (!report.unusable.empty()) {
    throw input_error(file, report.unusable.front());
  }
}

void import_rig(const ImportCommand& options) {
  check_angle("--hfov-deg", options.hfov_deg);
  check_angle("--vfov-deg", options.vfov_deg);
  const Config config = load_config(options.common);
  const std::vector<std::filesystem::path> files(options.files.begin(), options.files.end());
  ImportResult imported = import_calibration(
      files,
      {.format = kFormats.at(options.format),
       .mounting = {.facing = kFacings.at(options.facing), .body_at_imu = options.body == "imu"},
       .size_px = parse_size(options.size),
       .name = options.name,
       .opencv_fisheye = options.fisheye});
  choose_models(options, imported.rig);
  const RigReport report = check_rig(imported.rig, check_settings(config));
  const std::string yaml =
      to_yaml(imported.rig,
              "Imported from a calibration in the form of " + word_of(imported.format) +
                  ".\nFrames and keys: skyhalo rig check --help, skyhalo rig schema.");
  print_warnings(options.common, imported.warnings);
  print_warnings(options.common, report.warnings);
  refuse_unusable(options.files.front(), report);
  nlohmann::json summary = rig_json(report);
  for (const std::string& warning : imported.warnings) {
    summary["warnings"].push_back(warning);
  }
  summary["format"] = word_of(imported.format);
  if (options.out.empty()) {
    std::cout << yaml;
    print_result(options.common, "", summary);
    return;
  }
  replace_file(options.out, yaml);
  summary["out"] = options.out;
  print_result(options.common,
               rig_table(report, check_settings(config)) + "Written to " + options.out + "\n",
               summary);
}

void check(const CheckCommand& options) {
  const Config config = load_config(options.common);
  const RigFile rig = read_rig_file(options.file);
  RigReport report = check_rig(rig.description, check_settings(config));
  report.warnings.insert(report.warnings.begin(), rig.warnings.begin(), rig.warnings.end());
  print_warnings(options.common, report.warnings);
  const std::size_t count = report.warnings.size() + report.unusable.size();
  const std::string verdict =
      count == 0 ? "Nothing looks wrong.\n"
                 : std::to_string(count) + (count == 1 ? " warning.\n" : " warnings.\n");
  print_result(
      options.common, rig_table(report, check_settings(config)) + verdict, rig_json(report));
  if (!report.unusable.empty()) {
    (void)load_rig(options.file);  // says why, with the line
  }
}

void add_import(CLI::App& rig) {
  auto options = std::make_shared<ImportCommand>();
  CLI::App* command = rig.add_subcommand(
      "import",
      "a rig file from the calibration files of Kalibr, EuRoC, OpenCV, ROS, Basalt or KITTI\n"
      "  camchain.yaml | cam0/sensor.yaml cam1/sensor.yaml | mav0/ | intrinsics.yml "
      "extrinsics.yml\n"
      "  | left.yaml right.yaml | calibration.json | 2011_09_26/ | calib/0003.txt\n"
      "Cameras come two by two, left before right.");
  command->add_option("FILES", options->files, "the calibration files, or a folder of them")
      ->required();
  command->add_option("-o,--out", options->out, "the rig file (default: print it)")
      ->type_name("FILE");
  command->add_option("--format", options->format, "take the files for this")
      ->check(CLI::IsMember(words(kFormats)))
      ->capture_default_str();
  command
      ->add_option("--facing",
                   options->facing,
                   "which way the first pair looks from the vehicle (KITTI's files say it)")
      ->check(CLI::IsMember(words(kFacings)))
      ->capture_default_str();
  command
      ->add_option("--body",
                   options->body,
                   "origin of the body frame: imu (where the files know one) or camera (the first "
                   "right one)")
      ->check(CLI::IsMember({"imu", "camera"}))
      ->capture_default_str();
  command
      ->add_option("--model",
                   options->model,
                   "rectified model: pinhole, spherical, or auto (spherical above 110 degrees)")
      ->check(CLI::IsMember({"auto", "pinhole", "spherical"}))
      ->capture_default_str();
  command
      ->add_option("--hfov-deg",
                   options->hfov_deg,
                   "width of the rectified image (default: all that is seen)")
      ->check(CLI::PositiveNumber);
  command
      ->add_option("--vfov-deg",
                   options->vfov_deg,
                   "height of the rectified image (default: all that is seen)")
      ->check(CLI::PositiveNumber);
  command->add_flag(
      "--fisheye", options->fisheye, "OpenCV: the four coefficients are those of cv::fisheye");
  command->add_option("--size", options->size, "image size, where the files do not say it")
      ->type_name("WxH");
  command->add_option("--name", options->name, "name of the rig (default: the format's)");
  add_common_options(*command, options->common);
  command->callback([options] { import_rig(*options); });
}

void add_check(CLI::App& rig) {
  auto options = std::make_shared<CheckCommand>();
  CLI::App* command = rig.add_subcommand(
      "check",
      "what a rig file comes to, and what looks wrong in it\n"
      "Prints baseline, field of view, optical axes in the body frame and ranges of each pair;\n"
      "warns of lengths in millimetres, swapped cameras, inverted extrinsics, odd rotations.\n"
      "T_a_b takes coordinates in frame b to frame a; body is x forward, y left, z up; a camera\n"
      "is x right, y down, z forward. T_body_camera belongs to the right camera.");
  command->add_option("RIG", options->file, "the rig file (YAML)")->required();
  add_common_options(*command, options->common);
  command->callback([options] { check(*options); });
}

}  // namespace

void add_rig(CLI::App& program) {
  CLI::App* rig = program.add_subcommand("rig", "import calibrations, check rig files");
  rig->require_subcommand(1);
  add_import(*rig);
  add_check(*rig);
  CLI::App* schema =
      rig->add_subcommand("schema", "print the JSON Schema of rig files, for editors");
  schema->callback([] {
    std::cout << kRigSchema;
    flush_stdout();
  });
}

}  // namespace skyhalo::app

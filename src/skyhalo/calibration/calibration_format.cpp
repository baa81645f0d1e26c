#include "skyhalo/calibration/calibration_format.hpp"

#include <algorithm>
#include <set>
#include <string>

#include "skyhalo/base/error.hpp"
#include "skyhalo/calibration/euroc_file.hpp"
#include "skyhalo/calibration/file_status.hpp"
#include "skyhalo/calibration/opencv_file.hpp"
#include "skyhalo/io/text_file.hpp"

namespace skyhalo {
namespace {

using std::filesystem::path;
using Keys = std::set<std::string, std::less<>>;

constexpr std::string_view kBlanks = " \t\r\n";

std::string read_text(const path& file) {
  std::string text = read_bytes(file);
  if (text.find_first_not_of(kBlanks) == std::string::npos) {
    throw input_error(file, "is empty");
  }
  if (text.find('\0') != std::string::npos) {
    throw input_error(file, "is a binary file, expected the text of a calibration");
  }
  return text;
}

/// `"key" :` of JSON, at any depth.
void collect_json_keys(std::string_view text, Keys& keys) {
  std::size_t from = text.find('"');
  while (from != std::string_view::npos) {
    const std::size_t end = text.find('"', from + 1);
    if (end == std::string_view::npos) {
      return;
    }
    const std::size_t next = text.find_first_not_of(kBlanks, end + 1);
    if (next != std::string_view::npos && text[next] == ':') {
      keys.emplace(text.substr(from + 1, end - from - 1));
    }
    from = text.find('"', end + 1);
  }
}

/// `<key` of XML, at any depth.
void collect_xml_keys(std::string_view text, Keys& keys) {
  for (std::size_t from = text.find('<'); from != std::string_view::npos;
       from = text.find('<', from + 1)) {
    const std::size_t end = text.find_first_of(" \t\r\n/>", from + 1);
    keys.emplace(text.substr(from + 1, std::min(end, text.size()) - from - 1));
  }
}

/// `key:` or `key ` at the start of a line.
void collect_line_keys(std::string_view text, Keys& keys) {
  for (std::size_t from = 0; from < text.size();) {
    const std::size_t end = std::min(text.find('\n', from), text.size());
    const std::string_view line = text.substr(from, end - from);
    keys.emplace(line.substr(0, std::min(line.find_first_of(": \t\r"), line.size())));
    from = end + 1;
  }
}

void collect_keys(const std::string& text, Keys& keys) {
  const char first = text[text.find_first_not_of(kBlanks)];
  if (first == '{') {
    collect_json_keys(text, keys);
  } else if (first == '<') {
    collect_xml_keys(text, keys);
  } else {
    collect_line_keys(text, keys);
  }
}

bool looks_like_opencv(const Keys& keys) {
  const auto has = [&](std::string_view key) { return keys.contains(key); };
  for (const int camera : {0, 1}) {
    const auto names = opencv_camera_matrix_keys(camera);
    if (std::any_of(names.begin(), names.end(), has)) {
      return true;
    }
  }
  return has("opencv_storage") || (has("R") && has("T") && has("Q"));
}

CalibrationFormat format_of(const Keys& keys) {
  const auto has = [&](std::string_view key) { return keys.contains(key); };
  if (has("value0")) {
    return CalibrationFormat::kBasalt;
  }
  if (has("cam0")) {
    return CalibrationFormat::kKalibr;
  }
  if (has("P_rect_00") || has("P_rect_02")) {
    return CalibrationFormat::kKittiRaw;
  }
  if (has("P2") && has("P3")) {
    return CalibrationFormat::kKittiTracking;
  }
  if (has("T_BS")) {
    return CalibrationFormat::kEuroc;
  }
  if (looks_like_opencv(keys)) {
    return CalibrationFormat::kOpencv;
  }
  const bool ros = has("projection_matrix") || (has("camera_matrix") && has("camera_name"));
  return ros ? CalibrationFormat::kRos : CalibrationFormat::kAuto;
}

CalibrationFormat format_of_folder(const path& folder) {
  if (is_euroc_folder(folder)) {
    return CalibrationFormat::kEuroc;
  }
  return is_there(folder / "calib_cam_to_cam.txt") ? CalibrationFormat::kKittiRaw
                                                   : CalibrationFormat::kAuto;
}

CalibrationFormat format_of_files(const std::vector<path>& files) {
  Keys keys;
  for (const path& file : files) {
    collect_keys(read_text(file), keys);
  }
  return format_of(keys);
}

}  // namespace

std::string_view name_of(CalibrationFormat format) noexcept {
  switch (format) {
    case CalibrationFormat::kKalibr:
      return "kalibr";
    case CalibrationFormat::kEuroc:
      return "euroc";
    case CalibrationFormat::kOpencv:
      return "opencv";
    case CalibrationFormat::kRos:
      return "ros";
    case CalibrationFormat::kBasalt:
      return "basalt";
    case CalibrationFormat::kKittiRaw:
      return "kitti_raw";
    case CalibrationFormat::kKittiTracking:
      return "kitti_tracking";
    case CalibrationFormat::kAuto:
      break;
  }
  return "auto";
}

CalibrationFormat recognise_format(const std::vector<path>& files) {
  if (files.empty()) {
    throw Error(ErrorKind::kInput, "expected a calibration file");
  }
  const bool folder = files.size() == 1 && is_folder(files.front());
  const CalibrationFormat format =
      folder ? format_of_folder(files.front()) : format_of_files(files);
  if (format == CalibrationFormat::kAuto) {
    throw input_error(
        files.front(),
        "is no calibration that is known; known are Kalibr (cam0), EuRoC (T_BS, or a folder with "
        "cam0/sensor.yaml), OpenCV stereo (M1 or cameraMatrix1, R, T), ROS camera_info "
        "(camera_matrix, projection_matrix), Basalt (value0), KITTI raw (P_rect_00, or a day "
        "folder) and KITTI tracking (P2, P3)");
  }
  return format;
}

}  // namespace skyhalo

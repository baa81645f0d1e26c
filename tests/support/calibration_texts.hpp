#pragma once

#include <string>
#include <utility>
#include <vector>

#include "support/rig_texts.hpp"

namespace skyhalo::testing {

/// A calibration as another program writes it: its files, and how to spoil the first of them.
struct CalibrationText {
  std::string format;                                      ///< word for `--format`
  std::vector<std::pair<std::string, std::string>> files;  ///< name and content
  std::vector<WrongRig> wrong;                             ///< changes to the first file
};

inline std::string kalibr_text() {
  const std::string camera =
      "  camera_model: pinhole\n"
      "  intrinsics: [458, 457, 367, 248]\n"
      "  distortion_model: radtan\n"
      "  distortion_coeffs: [-0.28, 0.07, 0.0002, 0.00002]\n"
      "  resolution: [752, 480]\n";
  return "cam0:\n" + camera + "cam1:\n" + camera +
         "  T_cn_cnm1:\n"
         "  - [1, 0, 0, -0.11]\n"
         "  - [0, 1, 0, 0]\n"
         "  - [0, 0, 1, 0]\n"
         "  - [0, 0, 0, 1]\n";
}

inline std::string euroc_text(const std::string& y_m) {
  return "sensor_type: camera\n"
         "T_BS:\n"
         "  cols: 4\n"
         "  rows: 4\n"
         "  data: [0, -1, 0, -0.02, 1, 0, 0, " +
         y_m +
         ", 0, 0, 1, 0.01, 0, 0, 0, 1]\n"
         "rate_hz: 20\n"
         "resolution: [752, 480]\n"
         "camera_model: pinhole\n"
         "intrinsics: [458, 457, 367, 248]\n"
         "distortion_model: radial-tangential\n"
         "distortion_coefficients: [-0.28, 0.07, 0.0002, 0.00002]\n";
}

inline std::string opencv_matrix(const std::string& key,
                                 const std::string& rows,
                                 const std::string& cols,
                                 const std::string& data) {
  return key + ": !!opencv-matrix\n   rows: " + rows + "\n   cols: " + cols +
         "\n   dt: d\n   data: [ " + data + " ]\n";
}

inline std::string opencv_text() {
  return "%YAML:1.0\n---\n" +
         opencv_matrix("M1", "3", "3", "400., 0., 320., 0., 401., 240., 0., 0., 1.") +
         opencv_matrix("D1", "1", "5", "-0.1, 0.02, 0.001, -0.002, 0.003") +
         opencv_matrix("M2", "3", "3", "402., 0., 321., 0., 403., 241., 0., 0., 1.") +
         opencv_matrix("D2", "1", "4", "-0.2, 0.03, 0.002, -0.001") +
         opencv_matrix("R", "3", "3", "1., 0., 0., 0., 1., 0., 0., 0., 1.") +
         opencv_matrix("T", "3", "1", "-0.2, 0.01, 0.02") + "image_size: [ 640, 480 ]\n";
}

/// A camera with the fourth number of P as given.
inline std::string ros_text(const std::string& shift) {
  return "image_width: 640\n"
         "image_height: 480\n"
         "camera_name: narrow\n"
         "camera_matrix:\n"
         "  rows: 3\n"
         "  cols: 3\n"
         "  data: [400.0, 0.0, 320.0, 0.0, 401.0, 240.0, 0.0, 0.0, 1.0]\n"
         "distortion_model: plumb_bob\n"
         "distortion_coefficients:\n"
         "  rows: 1\n"
         "  cols: 5\n"
         "  data: [-0.1, 0.02, 0.001, -0.002, 0.0]\n"
         "rectification_matrix:\n"
         "  rows: 3\n"
         "  cols: 3\n"
         "  data: [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0]\n"
         "projection_matrix:\n"
         "  rows: 3\n"
         "  cols: 4\n"
         "  data: [500.0, 0.0, 322.0, " +
         shift + ", 0.0, 500.0, 242.0, 0.0, 0.0, 0.0, 1.0, 0.0]\n";
}

inline std::string basalt_text() {
  const std::string camera =
      R"({"camera_type": "ds",
     "intrinsics": {"fx": 350, "fy": 351, "cx": 366, "cy": 249, "xi": -0.25, "alpha": 0.6}})";
  return R"({"value0": {
  "T_imu_cam": [
    {"px": 0.1, "py": 0, "pz": 0, "qx": 0, "qy": 0, "qz": 0, "qw": 1},
    {"px": 0.3, "py": 0, "pz": 0, "qx": 0, "qy": 0, "qz": 0, "qw": 1}],
  "intrinsics": [
    )" + camera +
         ",\n    " + camera + R"(],
  "resolution": [[752, 480], [752, 480]]}})";
}

inline std::string kitti_raw_text() {
  return "calib_time: 09-Jan-2012 13:57:47\n"
         "S_rect_00: 1.242000e+03 3.750000e+02\n"
         "R_rect_00: 1 0 0 0 1 0 0 0 1\n"
         "P_rect_00: 256 0 160 0 0 256 48 0 0 0 1 0\n"
         "S_rect_01: 1.242000e+03 3.750000e+02\n"
         "P_rect_01: 256 0 160 -128 0 256 48 0 0 0 1 0\n";
}

inline std::string kitti_tracking_text() {
  return "P2: 256 0 160 0 0 256 48 0 0 0 1 0\n"
         "P3: 256 0 160 -128 0 256 48 0 0 0 1 0\n"
         "R_rect 1 0 0 0 1 0 0 0 1\n"
         "Tr_velo_cam 0 -1 0 0 0 0 -1 0 1 0 0 -0.27\n"
         "Tr_imu_velo 1 0 0 -0.8 0 1 0 0.3 0 0 1 -0.8\n";
}

inline std::vector<CalibrationText> kalibr_euroc_and_opencv_texts() {
  return {
      {"kalibr",
       {{"camchain.yaml", kalibr_text()}},
       {{"  intrinsics: [458, 457, 367, 248]\n", "", {"cam0.intrinsics", "missing"}},
        {"  distortion_model: radtan\n", "", {"cam0.distortion_model", "missing"}},
        {"  resolution: [752, 480]\n", "", {"cam0.resolution", "missing"}},
        {"[458, 457, 367, 248]", "[458, 457, 367]", {":3: cam0.intrinsics", "found 3"}},
        {"0.07, 0.0002, 0.00002]", "0.07, 0.0002]", {":5: cam0.distortion_coeffs", "found 3"}},
        {"[458, 457", "[.nan, 457", {":3: cam0.intrinsics", "finite"}},
        {"0, -0.11]", "0, .inf]", {"cam1.T_cn_cnm1", "finite"}},
        {"0, -0.11]", "0, 0]", {"baseline"}},
        {"radtan", "fisheye9", {":4: cam0.distortion_model", "fisheye9"}},
        {"camera_model: pinhole", "camera_model: cubic", {":2: cam0.camera_model", "cubic"}},
        {"[752, 480]", "[752]", {":6: cam0.resolution"}},
        {"[752, 480]", "[752, 0]", {":6: cam0.resolution"}},
        {"[752, 480]", "[752, 20000]", {":6: cam0.resolution"}},  // no rig can have it
        {"[458, 457", "[&a [*a], 457", {":3: cam0.intrinsics"}},
        {"[0, 1, 0, 0]", "[0, 1.1, 0, 0]", {"cam1.T_cn_cnm1", "not orthonormal"}}}},
      {"euroc",
       {{"left.yaml", euroc_text("-0.06")}, {"right.yaml", euroc_text("0.05")}},
       {{"intrinsics: [458, 457, 367, 248]\n", "", {"intrinsics", "missing"}},
        {"[458, 457, 367, 248]", "[458, 457, 367]", {":9: intrinsics", "found 3"}},
        {"1, 0.01, 0, 0, 0, 1]", "1, 0.01]", {":5: T_BS.data", "found 12"}},
        {"[458, 457", "[nan, 457", {":9: intrinsics", "finite"}},
        {"-0.06", "0.05", {"baseline"}},
        {"radial-tangential", "radtan9", {":10: distortion_model", "radtan9"}}}},
      {"opencv",
       {{"stereo.yml", opencv_text()}},
       {{"M2: ", "M3: ", {"M2"}},
        {"R: ", "R9: ", {"R", "missing"}},
        {"400., 0., 320., 0., 401.", "400., 0., 320., 401.", {"M1", "found 8"}},
        {"-0.1, 0.02, 0.001, -0.002, 0.003", "-0.1, 0.02", {"D1"}},
        {"400., 0., 320.", ".Nan, 0., 320.", {"M1", "finite"}},
        {"-0.2, 0.01, 0.02", "0., 0., 0.", {"baseline"}}}},
  };
}

inline std::vector<CalibrationText> other_calibration_texts() {
  return {
      {"ros",
       {{"left.yaml", ros_text("0.0")}, {"right.yaml", ros_text("-100.0")}},
       {{"image_width: 640\n", "", {"image_width", "missing"}},
        {"400.0, 0.0, 320.0, 0.0,", "400.0, 0.0, 320.0,", {":7: camera_matrix", "found 8"}},
        {"-0.1, 0.02,", ".nan, 0.02,", {":12: distortion_coefficients", "finite"}},
        {"322.0, 0.0, 0.0, 500.0", "322.0, -100.0, 0.0, 500.0", {"baseline"}},
        {"image_height: 480", "image_height: 20000", {":2: image_height"}},
        {"plumb_bob", "plumb_bill", {":8: distortion_model", "plumb_bill"}}}},
      {"basalt",
       {{"calibration.json", basalt_text()}},
       {{"\"fx\": 350, ", "", {"value0.intrinsics[0].intrinsics.fx", "missing"}},
        {"\"qw\": 1}", "\"qz\": 1}", {"value0.T_imu_cam[0].qw", "missing"}},
        {"[[752, 480], ", "[[752], ", {"value0.resolution[0]"}},
        {"\"fx\": 350", "\"fx\": null", {"value0.intrinsics[0].intrinsics.fx"}},
        {"\"fx\": 350", "\"fx\": NaN", {"calibration.json"}},
        {"\"px\": 0.1", "\"px\": 0.3", {"baseline"}},
        {"[[752, 480], ", "[[752, 20000], ", {"value0.resolution[0]"}},
        {"\"ds\"", "\"dss\"", {"value0.intrinsics[0].camera_type", "dss"}}}},
      {"kitti-raw",
       {{"calib_cam_to_cam.txt", kitti_raw_text()}},
       {{"P_rect_01: ", "P_rect_09: ", {"P_rect_01", "missing"}},
        {"S_rect_01: ", "S_rect_09: ", {"S_rect_01", "missing"}},
        {"256 0 160 0 0", "256 0 160 0", {":4: P_rect_00", "12"}},
        {"256 0 160 -128", "256 0 160 nan", {":6: P_rect_01", "nan"}},
        {"256 0 160 -128", "256 0 160 0", {":6: P_rect_01", "right of the left"}}}},
      {"kitti-tracking",
       {{"0003.txt", kitti_tracking_text()}},
       {{"P3: ", "P4: ", {"P3"}},
        {"256 0 160 0 0", "256 0 160 0", {":1: P2", "12"}},
        {"256 0 160 -128", "256 0 160 inf", {":2: P3", "inf"}},
        {"256 0 160 -128", "256 0 160 0", {":2: P3", "right of the left"}}}},
  };
}

/// The formats that `rig import` knows, each with a missing key, a wrong count, a number that is
/// none, no baseline and an unknown distortion, where it can have them.
inline std::vector<CalibrationText> calibration_texts() {
  std::vector<CalibrationText> all = kalibr_euroc_and_opencv_texts();
  for (const CalibrationText& more : other_calibration_texts()) {
    all.push_back(more);
  }
  return all;
}

}  // namespace skyhalo::testing

#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace skyhalo::testing {

/// The text with the first `from` in it replaced; fails the test when there is none.
inline std::string changed(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

/// A rig of one raw pair, 0.1 m apart, that looks forward.
inline const std::string kRawRig =
    "rig: made up\n"                                   // 1
    "pairs:\n"                                         // 2
    "  - name: front\n"                                // 3
    "    left:\n"                                      // 4
    "      size_px: [640, 480]\n"                      // 5
    "      lens: radial-tangential\n"                  // 6
    "      intrinsics_px: [400, 404, 319.5, 241]\n"    // 7
    "      distortion: [-0.2, 0.05, 0.001, -0.002]\n"  // 8
    "    right:\n"                                     // 9
    "      size_px: [640, 480]\n"                      // 10
    "      lens: pinhole\n"                            // 11
    "      intrinsics_px: [410, 412, 321, 239]\n"      // 12
    "    T_right_left:\n"                              // 13
    "      - [1, 0, 0, -0.1]\n"                        // 14
    "      - [0, 1, 0, 0]\n"                           // 15
    "      - [0, 0, 1, 0]\n"                           // 16
    "      - [0, 0, 0, 1]\n"                           // 17
    "    rectify_to:\n"                                // 18
    "      model: pinhole\n"                           // 19
    "      hfov_deg: 60\n"                             // 20
    "    T_body_camera:\n"                             // 21
    "      position_m: [0.1, -0.05, 0.02]\n"           // 22
    "    downscale: 2\n"                               // 23
    "    min_range_m: 0.5\n"                           // 24
    "    max_range_m: 20\n";                           // 25

/// A rig of one pair whose images come rectified.
inline const std::string kRectifiedRig =
    "rig: made up\n"                              // 1
    "pairs:\n"                                    // 2
    "  - name: front\n"                           // 3
    "    rectified:\n"                            // 4
    "      model: pinhole\n"                      // 5
    "      size_px: [640, 480]\n"                 // 6
    "      focal_px: 400\n"                       // 7
    "      principal_point_px: [319.5, 239.5]\n"  // 8
    "      baseline_m: 0.1\n"                     // 9
    "    T_body_camera:\n"                        // 10
    "      position_m: [0.1, -0.05, 0.02]\n";     // 11

/// A change to a text that makes it wrong, and words that the complaint must have.
struct WrongRig {
  std::string from;
  std::string to;
  std::vector<std::string> words;
};

/// Keys of `kRawRig` that are missing, unknown or given twice.
inline std::vector<WrongRig> wrong_raw_keys() {
  return {
      // A key is missing: the line is that of the section, where it has one.
      {"rig: made up\n", "", {": rig: ", "missing"}},
      {"  - name: front\n    left:", "  - left:", {":3: pairs[0].name: ", "missing"}},
      {"      size_px: [640, 480]\n", "", {":4: pairs[0].left.size_px: ", "missing"}},
      {"      lens: radial-tangential\n", "", {":4: pairs[0].left.lens: ", "missing"}},
      {"      distortion: [-0.2, 0.05, 0.001, -0.002]\n",
       "",
       {":4: pairs[0].left.distortion: ", "missing"}},
      {"      model: pinhole\n", "", {":18: pairs[0].rectify_to.model: ", "missing"}},
      {"      position_m: [0.1, -0.05, 0.02]\n",
       "      yaw_deg: 0\n",
       {":21: pairs[0].T_body_camera.position_m: ", "missing"}},
      // An unknown key.
      {"rig: made up", "rigs: 1\nrig: made up", {":1: rigs: ", "unknown key"}},
      {"downscale", "down_scale", {":23: pairs[0].down_scale: ", "unknown key"}},
      {"hfov_deg", "hfov_rad", {":20: pairs[0].rectify_to.hfov_rad: ", "unknown key"}},
      {"lens: radial",
       "focal: 1\n      lens: radial",
       {":6: pairs[0].left.focal: ", "unknown key"}},
      {"[0.1, -0.05, 0.02]",
       "[0, 0, 0]\n      yaw: 3",
       {":23: pairs[0].T_body_camera.yaw: ", "unknown key"}},
      {"    left:", "    baseline_m: 1\n    left:", {":4: pairs[0].baseline_m: ", "unknown key"}},
      // A key is given twice.
      {"rig: made up\n", "rig: a\nrig: b\n", {"rig: ", "twice"}},
      {"    downscale: 2\n", "    downscale: 2\n    downscale: 4\n", {"downscale: ", "twice"}},
      {"hfov_deg: 60", "hfov_deg: 60\n      hfov_deg: 61", {"rectify_to.hfov_deg: ", "twice"}},
  };
}

/// Values of `kRawRig` that are too few, too many, no numbers or unknown words.
inline std::vector<WrongRig> wrong_raw_values() {
  const std::string left_distortion = ":8: pairs[0].left.distortion: ";
  return {
      // A wrong count.
      {"[400, 404, 319.5, 241]",
       "[400, 319.5, 241]",
       {":7: pairs[0].left.intrinsics_px: ", "expected 4 numbers, found 3"}},
      {"[640, 480]", "[640]", {":5: pairs[0].left.size_px: ", "expected 2", "found 1"}},
      {"[640, 480]", "[640, 480, 3]", {":5: pairs[0].left.size_px: ", "expected 2", "found 3"}},
      {"[-0.2, 0.05, 0.001, -0.002]", "[-0.2, 0.05]", {left_distortion, "4, 5 or 8", "found 2"}},
      {"[-0.2, 0.05, 0.001, -0.002]", "[]", {left_distortion, "4, 5 or 8", "found 0"}},
      {"      - [0, 0, 0, 1]\n", "", {":13: pairs[0].T_right_left: ", "expected 16", "found 12"}},
      {"[0.1, -0.05, 0.02]",
       "[0.1, -0.05]",
       {":22: pairs[0].T_body_camera.position_m: ", "expected 3 numbers, found 2"}},
      // Not a number.
      {"[400,", "[.nan,", {":7: pairs[0].left.intrinsics_px: ", "finite number", ".nan"}},
      {"[400,", "[.inf,", {":7: pairs[0].left.intrinsics_px: ", "finite number", ".inf"}},
      {"[-0.2,", "[nan,", {left_distortion, "finite number", "nan"}},
      {"hfov_deg: 60", "hfov_deg: .nan", {":20: pairs[0].rectify_to.hfov_deg: ", "finite"}},
      {"0, -0.1]", "0, -.inf]", {":13: pairs[0].T_right_left: ", "finite number", "-.inf"}},
      {"max_range_m: 20", "max_range_m: 1e999", {":25: pairs[0].max_range_m: ", "finite number"}},
      {"max_range_m: 20", "max_range_m:", {":25: pairs[0].max_range_m: ", "finite number"}},
      {"[0.1, -0.05", "[0.1 m, -0.05", {":22: pairs[0].T_body_camera.position_m: ", "0.1 m"}},
      // A value that does not exist.
      {"lens: radial-tangential",
       "lens: radtan",
       {":6: pairs[0].left.lens: ", "radial-tangential", "'radtan'"}},
      {"model: pinhole", "model: sphere", {":19: pairs[0].rectify_to.model: ", "'sphere'"}},
      {"lens: pinhole", "lens: [pinhole]", {":11: pairs[0].right.lens: ", "a list"}},
  };
}

/// Values of `kRawRig` outside their domain, and texts that are no YAML.
inline std::vector<WrongRig> raw_rigs_beyond_limits() {
  const std::string left_distortion = ":8: pairs[0].left.distortion: ";
  return {
      // A value outside its domain.
      {"[400,", "[0,", {":7: pairs[0].left.intrinsics_px: ", "above 0"}},
      {"[400,", "[-400,", {":7: pairs[0].left.intrinsics_px: ", "above 0"}},
      {"[-0.2,", "[-1e6,", {left_distortion, "folds back"}},
      {"[640, 480]", "[0, 480]", {":5: pairs[0].left.size_px: ", "1...16384"}},
      {"[640, 480]", "[640, -1]", {":5: pairs[0].left.size_px: ", "1...16384"}},
      {"[640, 480]", "[20000, 480]", {":5: pairs[0].left.size_px: ", "1...16384"}},
      {"[640, 480]", "[640.5, 480]", {"pairs[0].left.size_px[0]: ", "whole number", "640.5"}},
      {"hfov_deg: 60", "hfov_deg: 0", {":20: pairs[0].rectify_to.hfov_deg: ", "above 0"}},
      {"downscale: 2", "downscale: 0", {":23: pairs[0].downscale: ", "1...16"}},
      {"downscale: 2", "downscale: 17", {":23: pairs[0].downscale: ", "1...16"}},
      {"downscale: 2", "rcrop_px: -1", {":23: pairs[0].rcrop_px: ", "0...16384"}},
      {"downscale: 2", "line_time_s: -1", {":23: pairs[0].line_time_s: ", "above 0"}},
      {"downscale: 2", "masks_px: [[1, 2, 0, 4]]", {"pairs[0].masks_px[0]: ", "above 0"}},
      {"downscale: 2", "masks_px: [[1, 2, 3]]", {"pairs[0].masks_px[0]: ", "expected 4"}},
      {"min_range_m: 0.5", "min_range_m: 20", {":24: pairs[0].min_range_m: ", "max_range_m"}},
      {"min_range_m: 0.5", "min_range_m: 21", {":24: pairs[0].min_range_m: ", "max_range_m"}},
      {"min_range_m: 0.5", "min_range_m: -1", {":24: pairs[0].min_range_m: ", "above 0"}},
      // A transform that is none.
      {"[0, 1, 0, 0]", "[0, 1.01, 0, 0]", {":13: pairs[0].T_right_left: ", "not orthonormal"}},
      {"[0, 1, 0, 0]", "[0, 0, 0, 0]", {":13: pairs[0].T_right_left: ", "not orthonormal"}},
      {"[0, 1, 0, 0]", "[0, -1, 0, 0]", {":13: pairs[0].T_right_left: ", "mirror image"}},
      {"[0, 0, 0, 1]", "[0, 0, 0.5, 1]", {":13: pairs[0].T_right_left: ", "last row"}},
      // Names.
      {"name: front", "name: a/b", {":3: pairs[0].name: ", "file's name"}},
      {"name: front", "name: ''", {":3: pairs[0].name: ", "file's name"}},
      {"name: front", "name: .hidden", {":3: pairs[0].name: ", "file's name"}},
      // The text itself.
      {"      size_px", "\t    size_px", {":5: "}},
      {"[640, 480]", "[640, 480", {":"}},
      {"rig: made up", "rig: \"made up", {":"}},
      {"rig: made up", "rig: [made up]", {":1: rig: ", "a list"}},
  };
}

/// What can be wrong in `kRawRig` by itself, without a look at what its numbers come to.
inline std::vector<WrongRig> wrong_raw_rigs() {
  std::vector<WrongRig> all = wrong_raw_keys();
  for (const auto& more : {wrong_raw_values(), raw_rigs_beyond_limits()}) {
    all.insert(all.end(), more.begin(), more.end());
  }
  return all;
}

/// What can be wrong in the numbers of `kRawRig` taken together.
inline std::vector<WrongRig> wrong_raw_pairs() {
  const std::string extrinsics = ":13: pairs[0].T_right_left: ";
  return {
      {"0, -0.1]", "0, 0]", {extrinsics, "the baseline is zero"}},
      {"0, -0.1]", "0, 0.1]", {extrinsics, "swapped"}},  // as if B were negative
      {"[1, 0, 0, -0.1]", "[1, 0, 0, 0]", {extrinsics, "zero"}},
      {"hfov_deg: 60", "hfov_deg: 185", {":20: pairs[0].rectify_to.hfov_deg: ", "150", "185"}},
      {"hfov_deg: 60", "hfov_deg: 151", {":20: pairs[0].rectify_to.hfov_deg: ", "150", "151"}},
      {"hfov_deg: 60", "vfov_deg: 151", {":20: pairs[0].rectify_to.vfov_deg: ", "150", "151"}},
      {"pinhole\n      hfov_deg: 60",
       "spherical\n      hfov_deg: 180",
       {":20: pairs[0].rectify_to.hfov_deg: ", "179", "180"}},
      {"pinhole\n      hfov_deg: 60",
       "spherical\n      hfov_deg: 178.5",  // these lenses end at 89 degrees
       {":20: pairs[0].rectify_to.hfov_deg: ", "beyond the lens", "178.5"}},
      {"hfov_deg: 60",
       "hfov_deg: 0.001",
       {":20: pairs[0].rectify_to.hfov_deg: ", "1 to 150 degrees"}},
      {"hfov_deg: 60",
       "hfov_deg: 1e-300",
       {":20: pairs[0].rectify_to.hfov_deg: ", "1 to 150 degrees"}},
      {"hfov_deg: 60", "size_px: [8, 480]", {":20: pairs[0].rectify_to.size_px: ", "16...16384"}},
  };
}

/// What can be wrong in `kRectifiedRig`.
inline std::vector<WrongRig> wrong_rectified_rigs() {
  const std::string theta = "delta_theta_rad: ";
  return {
      {"baseline_m: 0.1", "baseline_m: 0", {":9: pairs[0].rectified.baseline_m: ", "above 0"}},
      {"baseline_m: 0.1", "baseline_m: -0.1", {":9: pairs[0].rectified.baseline_m: ", "above 0"}},
      {"baseline_m: 0.1", "baseline_m: .nan", {":9: pairs[0].rectified.baseline_m: ", "finite"}},
      {"      baseline_m: 0.1\n", "", {":4: pairs[0].rectified.baseline_m: ", "missing"}},
      {"focal_px: 400", "focal_px: 0", {":7: pairs[0].rectified.focal_px: ", "above 0"}},
      {"model: pinhole", "model: fisheye", {":5: pairs[0].rectified.model: ", "'fisheye'"}},
      {"focal_px: 400", "delta_theta_rad: [1, 1]", {":7: pairs[0].rectified." + theta, "unknown"}},
      {"model: pinhole", "model: spherical", {":7: pairs[0].rectified.focal_px: ", "unknown"}},
      {"model: pinhole\n      size_px: [640, 480]\n      focal_px: 400",
       "model: spherical\n      size_px: [640, 480]\n      delta_theta_rad: [0.004, 0]",
       {":7: pairs[0].rectified." + theta, "above 0"}},
      {"[319.5, 239.5]", "[319.5]", {":8: pairs[0].rectified.principal_point_px: ", "found 1"}},
      {"    rectified:", "    left: 1\n    rectified:", {":4: pairs[0].left: ", "unknown key"}},
      {"    rectified:", "    rectify:", {"pairs[0].", "unknown key"}},
      {"    T_body_camera:\n      position_m: [0.1, -0.05, 0.02]\n",
       "",
       {":3: pairs[0].T_body_camera: ", "missing"}},
  };
}

}  // namespace skyhalo::testing

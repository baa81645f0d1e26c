#pragma once

#include <opencv2/core/types.hpp>
#include <string>
#include <vector>

#include "skyhalo/calibration/rotation_input.hpp"
#include "skyhalo/calibration/yaml_value.hpp"
#include "skyhalo/camera/intrinsics.hpp"

namespace skyhalo {

/// Complains about a value of a YAML file. Internal to this layer, as all of this header.
[[nodiscard]] ErrorAt error_at(const YamlValue& value);

/// Complains about an entry of a map, whether it is there or not.
[[nodiscard]] ErrorAt error_at(const YamlValue& map, const std::string& key);

/// The numbers of a matrix, row by row: `{rows: , cols: , data: []}` as OpenCV and ROS write it, or
/// a list of rows. Throws `Error` (input) when rows or cols, where given, do not fit `data`.
[[nodiscard]] std::vector<double> matrix_numbers(const YamlValue& value);

/// A rigid transform given as a 4x4 matrix in either form (m). Throws and warns as `pose_from`.
[[nodiscard]] Pose read_pose(const YamlValue& value, std::vector<std::string>& warnings);

/// An image size of two whole numbers in 1...16384, `[width, height]`.
[[nodiscard]] cv::Size read_size_px(const YamlValue& value);

/// One side of an image, 1...16384 (px).
[[nodiscard]] int read_side_px(const YamlValue& value);

/// Focal lengths and principal point `[fu, fv, cu, cv]`.
[[nodiscard]] Intrinsics read_intrinsics(const YamlValue& value);

}  // namespace skyhalo

#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "skyhalo/geometry/oriented_box.hpp"

namespace skyhalo {

/// One annotated object of a KITTI tracking label file.
struct TrackedObject {
  int frame = 0;
  int track = -1;
  std::string type;  ///< Car, Pedestrian, ...; never DontCare
  OrientedBox box;   ///< m, rectified camera 00
};

/// The annotated objects of a drive, frame by frame.
class TrackLabels {
 public:
  TrackLabels() = default;

  /// Reads a `label_02/NNNN.txt` file: 17 columns, or 18 with a score. `DontCare` regions have no
  /// box and are left out. Throws `Error` (input) with file and line for a wrong number of columns,
  /// a word that is no number, or a box without extent.
  explicit TrackLabels(const std::filesystem::path& file);

  /// The objects of a frame; none outside the labelled frames.
  [[nodiscard]] std::span<const TrackedObject> objects(int frame) const noexcept;

  /// The last frame with any entry, `DontCare` included; -1 for an empty file.
  [[nodiscard]] int last_frame() const noexcept { return last_frame_; }

  /// The line (from 1) of the first entry of the last frame; 0 for an empty file.
  [[nodiscard]] int last_frame_line() const noexcept { return last_frame_line_; }

 private:
  std::vector<std::vector<TrackedObject>> frames_;
  int last_frame_ = -1;
  int last_frame_line_ = 0;
};

/// The box of label values: height, width, length (m), the bottom centre x, y, z (m) and the
/// rotation about the camera's y axis (KITTI development kit).
struct LabelBox {
  double height_m = 0.0;
  double width_m = 0.0;
  double length_m = 0.0;
  Eigen::Vector3d bottom_center_m = Eigen::Vector3d::Zero();
  double rotation_y_rad = 0.0;
};

[[nodiscard]] OrientedBox to_oriented_box(const LabelBox& label);

}  // namespace skyhalo

#pragma once

#include <Eigen/Core>
#include <opencv2/core/types.hpp>
#include <optional>
#include <vector>

#include "skyhalo/geometry/pose.hpp"

namespace skyhalo {

/// One turn of a laser scanner: points in the scanner's frame (m).
using LaserScan = std::vector<Eigen::Vector3f>;

/// The pinhole camera whose image limits what counts as ground truth.
struct TruthCamera {
  double focal_px = 0.0;
  double principal_u_px = 0.0;
  double principal_v_px = 0.0;
  cv::Size image_size_px;
  Pose T_camera_laser = Pose::Identity();  ///< scanner to this camera
};

/// A recording that also has a laser scanner. Reading is `const` and may be done by several
/// threads.
class LaserSource {
 public:
  LaserSource() = default;
  LaserSource(const LaserSource&) = delete;
  LaserSource& operator=(const LaserSource&) = delete;
  LaserSource(LaserSource&&) = delete;
  LaserSource& operator=(LaserSource&&) = delete;
  virtual ~LaserSource() = default;

  /// A frame's scan; none when the recording lacks it, as some of KITTI's do. Throws `Error`
  /// (input) naming the file when it is there but cut off or unreadable.
  [[nodiscard]] virtual std::optional<LaserScan> read_scan(int frame) const = 0;

  [[nodiscard]] virtual Pose T_body_laser() const = 0;

  [[nodiscard]] virtual TruthCamera truth_camera() const = 0;

  /// The camera frame that annotations are given in, seen from the scanner.
  [[nodiscard]] virtual Pose T_annotation_laser() const = 0;
};

}  // namespace skyhalo

#pragma once

#include <optional>

#include "skyhalo/camera/pair_model.hpp"
#include "skyhalo/camera/raw_pair.hpp"

namespace skyhalo {

/// The two rectified models.
enum class PairModelKind { kPinhole, kSpherical };

/// What is asked of a virtual pair; what is left out is chosen.
struct VirtualPairWish {
  PairModelKind model = PairModelKind::kPinhole;
  std::optional<double> hfov_rad = {};   ///< width of the image, edge to edge
  std::optional<double> vfov_rad = {};   ///< height of the image, edge to edge
  std::optional<cv::Size> size_px = {};  ///< of the virtual images at full resolution
};

/// The pair that a raw pair is warped to: both cameras keep their place and turn to one common
/// orientation, x along the baseline and z between the two optical axes (METHOD 1).
struct VirtualPair {
  cv::Size size_px;
  PairModel model;                                            ///< at that size
  Eigen::Matrix3d R_left_cam = Eigen::Matrix3d::Identity();   ///< `cam` to raw left camera
  Eigen::Matrix3d R_right_cam = Eigen::Matrix3d::Identity();  ///< `cam` to raw right camera
};

/// Chooses the virtual pair. Without a wished field of view, the image reaches as far along its
/// middle row and column as both raw cameras see, at most 60 degrees to each side for the pinhole
/// model, 87 (across) and 80 (up and down) for the spherical one. Without a wished size, a pixel in
/// the middle is as large as a raw one, and the sides are multiples of 16 px. A wished field lies
/// centred on the optical axis. It can be from 1 degree on up to 150 for the pinhole model, 179
/// across and 340 upright for the spherical one; sizes are 16...16384 px.
///
/// Throws `Error` (input) naming `T_right_left` when the baseline is zero or the left camera is not
/// on the left (swapped cameras or inverted extrinsics), and `hfov_deg`, `vfov_deg` or `size_px`
/// when the wish is beyond what the model or the lenses can show.
[[nodiscard]] VirtualPair make_virtual_pair(const RawPair& raw, const VirtualPairWish& wish);

/// Field of view across and upright (rad), edge to edge, of images of this size.
struct FieldOfView {
  double horizontal_rad = 0.0;
  double vertical_rad = 0.0;
};

[[nodiscard]] FieldOfView field_of_view(const PairModel& pair, const cv::Size& size_px) noexcept;

}  // namespace skyhalo

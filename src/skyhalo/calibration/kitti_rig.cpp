#include "skyhalo/calibration/kitti_rig.hpp"

#include <string>
#include <vector>

#include "skyhalo/calibration/file_status.hpp"
#include "skyhalo/calibration/image_size.hpp"
#include "skyhalo/calibration/imported_cameras.hpp"
#include "skyhalo/calibration/key_value_file.hpp"
#include "skyhalo/calibration/kitti_projection.hpp"
#include "skyhalo/calibration/rotation_input.hpp"

namespace skyhalo {
namespace {

using std::filesystem::path;

RigDescription rectified_rig(const cv::Size& size_px,
                             const PinholePair& pair,
                             const Pose& T_body_camera) {
  return {.name = "kitti",
          .T_body_imu = std::nullopt,
          .pairs = {{.name = "front",
                     .images = RectifiedPairDescription{size_px, pair},
                     .T_body_camera = T_body_camera,
                     .downscale = {},
                     .rcrop_px = {},
                     .masks_px = {},
                     .min_range_m = {},
                     .max_range_m = {}}}};
}

cv::Size read_size_px(const KeyValueFile& file, const std::string& key) {
  const std::vector<double> size = file.numbers(key, 2);
  const ErrorAt error_at = [&](std::string_view message) {
    return file.error(key, std::string(message));
  };
  return {image_side_px(size[0], error_at), image_side_px(size[1], error_at)};
}

/// The size of both rectified images.
cv::Size read_pair_size_px(const KeyValueFile& file, KittiPair pair) {
  const std::string left_key = "S_rect_0" + std::to_string(left_camera(pair));
  const std::string right_key = "S_rect_0" + std::to_string(left_camera(pair) + 1);
  const cv::Size size_px = read_size_px(file, right_key);
  if (read_size_px(file, left_key) != size_px) {
    throw file.error(right_key, "the image size differs from the left camera's");
  }
  return size_px;
}

constexpr const char* kCamerasFile = "calib_cam_to_cam.txt";

/// Whether the day's files that lead to the INS lie beside the cameras' one; one is enough, so that
/// a missing other is complained about.
bool leads_to_imu(const path& cameras_file) {
  const path folder = cameras_file.parent_path();
  return cameras_file.filename() == kCamerasFile &&
         (is_there(folder / "calib_velo_to_cam.txt") || is_there(folder / "calib_imu_to_velo.txt"));
}

}  // namespace

RigDescription read_kitti_raw_rig(const path& day_folder_or_file, KittiPair pair) {
  const path cameras_file =
      is_folder(day_folder_or_file) ? day_folder_or_file / kCamerasFile : day_folder_or_file;
  const KeyValueFile cameras(cameras_file);
  const cv::Size size_px = read_pair_size_px(cameras, pair);
  if (!leads_to_imu(cameras_file)) {
    const int left = left_camera(pair);
    const KittiProjections projections = read_kitti_projections(
        cameras, "P_rect_0" + std::to_string(left), "P_rect_0" + std::to_string(left + 1));
    return rectified_rig(size_px,
                         projections.pair,
                         make_pose(R_body_camera(Facing::kForward), Eigen::Vector3d::Zero()));
  }
  const KittiCalibration calibration = read_kitti_raw_calibration(cameras_file.parent_path(), pair);
  RigDescription rig = rectified_rig(size_px, calibration.pair, calibration.T_body_right());
  rig.T_body_imu = Pose::Identity();
  return rig;
}

RigDescription read_kitti_tracking_rig(const path& file, std::optional<cv::Size> size_px) {
  const KittiCalibration calibration = read_kitti_tracking_calibration(file);
  if (!size_px) {
    throw input_error(file, "the size of the images is not in this file and must be given");
  }
  RigDescription rig = rectified_rig(*size_px, calibration.pair, calibration.T_body_right());
  rig.T_body_imu = Pose::Identity();
  return rig;
}

}  // namespace skyhalo

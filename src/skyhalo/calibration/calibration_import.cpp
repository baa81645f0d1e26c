#include "skyhalo/calibration/calibration_import.hpp"

#include <utility>
#include <variant>

#include "skyhalo/base/error.hpp"
#include "skyhalo/calibration/basalt_file.hpp"
#include "skyhalo/calibration/euroc_file.hpp"
#include "skyhalo/calibration/image_size.hpp"
#include "skyhalo/calibration/kalibr_file.hpp"
#include "skyhalo/calibration/kitti_rig.hpp"
#include "skyhalo/calibration/opencv_file.hpp"
#include "skyhalo/calibration/ros_camera_info.hpp"

namespace skyhalo {
namespace {

using std::filesystem::path;
using Files = std::vector<path>;

std::string size_text(const cv::Size& size_px) {
  return std::to_string(size_px.width) + "x" + std::to_string(size_px.height);
}

void expect_count(const Files& files, CalibrationFormat format) {
  const bool one = format == CalibrationFormat::kKalibr || format == CalibrationFormat::kBasalt ||
                   format == CalibrationFormat::kKittiRaw ||
                   format == CalibrationFormat::kKittiTracking;
  const std::size_t least = format == CalibrationFormat::kRos ? 2 : 1;
  const std::size_t most = one ? 1 : format == CalibrationFormat::kEuroc ? files.size() : 2;
  if (files.size() < least || files.size() > most) {
    const std::string range = one ? "1 file" : least == most ? "2 files" : "1 or 2 files";
    throw Error(ErrorKind::kInput,
                std::string(name_of(format)) + ": expected " + range + ", found " +
                    std::to_string(files.size()));
  }
}

ImportedCameras read_cameras(const Files& files, CalibrationFormat format, const ImportOptions& o) {
  switch (format) {
    case CalibrationFormat::kKalibr:
      return read_kalibr(files.front());
    case CalibrationFormat::kEuroc:
      return read_euroc(files);
    case CalibrationFormat::kRos:
      return read_ros_camera_info(files.front(), files.back());
    case CalibrationFormat::kBasalt:
      return read_basalt(files.front());
    default:
      return read_opencv_stereo(files, o.size_px, o.opencv_fisheye);
  }
}

/// Puts the first camera at the body's origin, looking that way.
void mount_at_camera(RigDescription& rig, Facing facing) {
  const Pose T_new_camera = make_pose(R_body_camera(facing), Eigen::Vector3d::Zero());
  const Pose T_new_body = T_new_camera * rig.pairs.front().T_body_camera.inverse();
  for (PairDescription& pair : rig.pairs) {
    pair.T_body_camera = T_new_body * pair.T_body_camera;
  }
  if (rig.T_body_imu) {
    rig.T_body_imu = T_new_body * *rig.T_body_imu;
  }
}

RigDescription read_kitti(const path& file,
                          CalibrationFormat format,
                          const ImportOptions& options,
                          std::vector<std::string>& warnings) {
  RigDescription rig = format == CalibrationFormat::kKittiRaw
                           ? read_kitti_raw_rig(file, KittiPair::kGrey)
                           : read_kitti_tracking_rig(file, options.size_px);
  if (!rig.T_body_imu || !options.mounting.body_at_imu) {
    mount_at_camera(rig, options.mounting.facing);
  } else if (options.mounting.facing != Facing::kForward) {
    warnings.emplace_back(
        input_error(file,
                    "KITTI's files say which way the cameras look; the facing that is asked for is "
                    "left out")
            .what());
  }
  return rig;
}

/// The rig of the cameras; what it complains about is in these files.
RigDescription assemble(const ImportedCameras& imported,
                        const Files& files,
                        const ImportOptions& options) {
  try {
    return assemble_rig(imported, options.mounting, "");
  } catch (const Error& error) {
    throw input_error(files.front(), error.what());
  }
}

void check_given_size(const Files& files, const cv::Size& size_px) {
  (void)checked_image_size_px(size_px, [&](std::string_view message) {
    return input_error(files.front(), "size_px: " + std::string(message));
  });
}

void expect_size(const RigDescription& rig, const Files& files, const cv::Size& wanted_px) {
  for (const PairDescription& pair : rig.pairs) {
    const auto* const raw = std::get_if<RawPairDescription>(&pair.images);
    const cv::Size found_px = raw != nullptr
                                  ? raw->cameras.right.size_px
                                  : std::get<RectifiedPairDescription>(pair.images).size_px;
    if (found_px != wanted_px) {
      throw input_error(files.front(),
                        "its images are " + size_text(found_px) + " px, not " +
                            size_text(wanted_px) + " as asked for");
    }
  }
}

}  // namespace

ImportResult import_calibration(const Files& files, const ImportOptions& options) {
  const bool recognise = options.format == CalibrationFormat::kAuto || files.empty();
  ImportResult result;
  result.format = recognise ? recognise_format(files) : options.format;
  expect_count(files, result.format);
  if (options.size_px) {
    check_given_size(files, *options.size_px);
  }
  if (result.format == CalibrationFormat::kKittiRaw ||
      result.format == CalibrationFormat::kKittiTracking) {
    result.rig = read_kitti(files.front(), result.format, options, result.warnings);
  } else {
    ImportedCameras imported = read_cameras(files, result.format, options);
    result.rig = assemble(imported, files, options);
    result.warnings = std::move(imported.warnings);
  }
  result.rig.name = options.name.empty() ? std::string(name_of(result.format)) : options.name;
  if (options.size_px) {
    expect_size(result.rig, files, *options.size_px);
  }
  return result;
}

}  // namespace skyhalo

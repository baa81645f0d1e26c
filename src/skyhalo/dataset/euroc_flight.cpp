#include "skyhalo/dataset/euroc_flight.hpp"

#include <optional>
#include <utility>

#include "skyhalo/base/error.hpp"
#include "skyhalo/dataset/euroc_poses.hpp"
#include "skyhalo/dataset/euroc_table.hpp"
#include "skyhalo/dataset/frame_checks.hpp"
#include "skyhalo/io/image_file.hpp"

namespace skyhalo {
namespace {

namespace fs = std::filesystem;

bool has_cameras(const fs::path& folder) {
  return fs::is_directory(folder / "cam0") && fs::is_directory(folder / "cam1");
}

/// An absolute path without a slash at its end.
fs::path plain_path(const fs::path& folder) {
  fs::path plain = fs::absolute(folder).lexically_normal();
  return plain.filename().empty() ? plain.parent_path() : plain;
}

fs::path find_mav0(const fs::path& folder) {
  const fs::path plain = plain_path(folder);
  if (!fs::is_directory(plain)) {
    throw input_error(plain, "no such folder; expected a EuRoC flight (mav0/cam0, mav0/cam1)");
  }
  fs::path mav0 = has_cameras(plain) ? plain : plain / "mav0";
  if (!has_cameras(mav0)) {
    throw input_error(plain, "is no EuRoC flight; expected mav0/cam0 and mav0/cam1 in it");
  }
  return mav0;
}

std::string name_of(const fs::path& mav0) {
  const fs::path parent = mav0.parent_path().filename();
  return (mav0.filename() == "mav0" && !parent.empty() ? parent : mav0.filename()).string();
}

/// The file of a listed image, perhaps in the other of the two formats; empty when there is none.
fs::path find_image(const fs::path& camera, const EurocRow& row) {
  const fs::path name = row.fields.front();
  if (name.empty() || name.has_parent_path() || name == "." || name == "..") {
    throw input_error(
        camera / "data.csv", row.line, "expected a file name, found '" + name.string() + "'");
  }
  for (const fs::path& candidate :
       {name, fs::path(name).replace_extension(".png"), fs::path(name).replace_extension(".jpg")}) {
    std::error_code ignored;
    if (fs::is_regular_file(camera / "data" / candidate, ignored)) {
      return camera / "data" / candidate;
    }
  }
  return {};
}

/// `T_map_world` (both z up) for a map frame with the origin and heading of the body.
Pose level_map(const Pose& T_world_body) {
  const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  const Eigen::Matrix3d& R = T_world_body.linear();
  constexpr double kUpright = 1e-3;
  Eigen::Vector3d ahead(R(0, 0), R(1, 0), 0.0);
  if (ahead.norm() < kUpright) {
    ahead = R.col(1).cross(up);
  }
  Eigen::Matrix3d R_world_map;
  R_world_map.col(0) = ahead.normalized();
  R_world_map.col(1) = up.cross(R_world_map.col(0));
  R_world_map.col(2) = up;
  return make_pose(R_world_map, T_world_body.translation()).inverse();
}

}  // namespace

bool is_euroc_flight(const fs::path& folder) {
  return has_cameras(folder) || has_cameras(folder / "mav0");
}

EurocFlight::EurocFlight(const fs::path& folder, StereoRig rig, const Pose& T_body_imu)
    : folder_(find_mav0(folder)), name_(name_of(folder_)), rig_(std::move(rig)) {
  if (rig_.pairs.size() != 1) {
    throw input_error(folder_,
                      "is a flight with one stereo pair (cam0, cam1); the rig has " +
                          std::to_string(rig_.pairs.size()));
  }
  find_frames();
  find_poses(T_body_imu);
}

void EurocFlight::find_frames() {
  const std::vector<EurocRow> left = read_euroc_table(folder_ / "cam0" / "data.csv", 1);
  const std::vector<EurocRow> right = read_euroc_table(folder_ / "cam1" / "data.csv", 1);
  std::size_t r = 0;
  std::size_t paired = 0;
  for (const EurocRow& row : left) {
    while (r < right.size() && right[r].stamp < row.stamp) {
      ++r;
    }
    if (r == right.size() || right[r].stamp != row.stamp) {
      continue;
    }
    ++paired;
    Frame frame{
        row.stamp, find_image(folder_ / "cam0", row), find_image(folder_ / "cam1", right[r])};
    if (frame.left.empty() || frame.right.empty()) {
      ++dropped_.without_image;
    } else {
      frames_.push_back(std::move(frame));
    }
  }
  dropped_.unpaired = static_cast<int>(left.size() + right.size() - 2 * paired);
  if (frames_.empty()) {
    throw input_error(folder_,
                      "has no image pair: cam0 and cam1 list " + std::to_string(paired) +
                          " time stamps in common, and none has both image files in data/");
  }
}

void EurocFlight::find_poses(const Pose& T_body_imu) {
  const fs::path file = folder_ / "state_groundtruth_estimate0" / "data.csv";
  if (!fs::exists(file)) {
    return;
  }
  const std::vector<EurocPose> truth = read_euroc_poses(file);
  const Pose T_imu_body = T_body_imu.inverse();
  std::vector<Frame> kept;
  for (Frame& frame : frames_) {
    if (const std::optional<Pose> imu = T_world_imu(truth, frame.stamp)) {
      poses_.push_back(*imu * T_imu_body);
      kept.push_back(std::move(frame));
    }
  }
  dropped_.without_pose = static_cast<int>(frames_.size() - kept.size());
  frames_ = std::move(kept);
  if (frames_.empty()) {
    throw input_error(file,
                      "has no pose for any of the " + std::to_string(dropped_.without_pose) +
                          " image pairs; do the two belong together?");
  }
  const Pose T_map_world = level_map(poses_.front());
  for (Pose& pose : poses_) {
    pose = T_map_world * pose;
  }
}

Timestamp EurocFlight::stamp(int frame) const {
  return frames_.at(static_cast<std::size_t>(frame)).stamp;
}

Pose EurocFlight::T_map_body(int frame) const {
  if (!has_poses()) {
    throw input_error(folder_ / "state_groundtruth_estimate0" / "data.csv",
                      "no such file; without it the flight has images but no poses");
  }
  return poses_.at(static_cast<std::size_t>(frame));
}

FrameSet EurocFlight::read(int frame) const {
  const Frame& files = frames_.at(static_cast<std::size_t>(frame));
  const StereoPair& pair = rig_.pairs.front();
  FrameSet frames{.stamp = files.stamp, .pairs = {{}}};
  frames.pairs.front() = {read_image_of_size(files.left, left_image_size_px(pair)),
                          read_image_of_size(files.right, right_image_size_px(pair))};
  return frames;
}

}  // namespace skyhalo

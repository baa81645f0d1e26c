#include <algorithm>
#include <array>
#include <cmath>

#include "skyhalo/base/number_text.hpp"
#include "skyhalo/dataset/kitti_oxts.hpp"
#include "skyhalo/geometry/angle.hpp"

namespace skyhalo {
namespace {

constexpr double kStepS = 0.1;
constexpr double kGravityMps2 = 9.81;
constexpr InsReading kFirst{.latitude_deg = 49.0, .longitude_deg = 8.4, .altitude_m = 116.0};

/// How the body moves at a frame, in the map frame but for the turn rate, which is in the body's.
struct Motion {
  Eigen::Vector3d velocity_mps = Eigen::Vector3d::Zero();
  Eigen::Vector3d acceleration_mps2 = Eigen::Vector3d::Zero();
  Eigen::Vector3d rate_body_rad_per_s = Eigen::Vector3d::Zero();
};

/// The frames before and after one that its differences are taken between; at the ends the frame
/// itself stands in for what is not there.
struct Neighbours {
  std::size_t before = 0;
  std::size_t after = 0;
};

Neighbours neighbours(std::size_t frame, std::size_t count) {
  return {frame == 0 ? 0 : frame - 1, std::min(frame + 1, count - 1)};
}

/// A difference between the two neighbours per second; 0 for a single frame.
Eigen::Vector3d per_second(const Eigen::Vector3d& difference, const Neighbours& n) {
  return n.after == n.before
             ? Eigen::Vector3d::Zero()
             : Eigen::Vector3d(difference / (kStepS * static_cast<double>(n.after - n.before)));
}

std::vector<Motion> motions_of(std::span<const Pose> poses) {
  std::vector<Motion> motions(poses.size());
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const Neighbours n = neighbours(i, poses.size());
    const Pose& from = poses[n.before];
    const Pose& to = poses[n.after];
    motions[i].velocity_mps = per_second(to.translation() - from.translation(), n);
    const Eigen::AngleAxisd turn(from.linear().transpose() * to.linear());
    motions[i].rate_body_rad_per_s = per_second(turn.angle() * turn.axis(), n);
  }
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const Neighbours n = neighbours(i, poses.size());
    motions[i].acceleration_mps2 =
        per_second(motions[n.after].velocity_mps - motions[n.before].velocity_mps, n);
  }
  return motions;
}

/// A line: latitude longitude altitude roll pitch yaw, vn ve vf vl vu, ax ay az af al au, wx wy wz
/// wf wl wu, accuracies of position and velocity, navstat numsats posmode velmode orimode.
std::string line_of(const InsReading& reading, const Motion& motion, const Eigen::Matrix3d& R) {
  // Forward, left and up along the ground.
  const Eigen::Matrix3d R_level_map =
      Eigen::AngleAxisd(-reading.yaw_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  const Eigen::Vector3d v = motion.velocity_mps;
  const Eigen::Vector3d v_level = R_level_map * v;
  const Eigen::Vector3d felt = motion.acceleration_mps2 + Eigen::Vector3d(0.0, 0.0, kGravityMps2);
  const Eigen::Vector3d a = R.transpose() * felt;
  const Eigen::Vector3d a_level = R_level_map * felt;
  const Eigen::Vector3d w = motion.rate_body_rad_per_s;
  const Eigen::Vector3d w_level = R_level_map * (R * w);
  const std::array<double, 19> rest{v.y(),
                                    v.x(),
                                    v_level.x(),
                                    v_level.y(),
                                    v_level.z(),
                                    a.x(),
                                    a.y(),
                                    a.z(),
                                    a_level.x(),
                                    a_level.y(),
                                    a_level.z(),
                                    w.x(),
                                    w.y(),
                                    w.z(),
                                    w_level.x(),
                                    w_level.y(),
                                    w_level.z(),
                                    0.01,
                                    0.01};
  std::string line = exact_number_text(reading.latitude_deg);
  for (const double exact : {reading.longitude_deg,
                             reading.altitude_m,
                             reading.roll_rad,
                             reading.pitch_rad,
                             reading.yaw_rad}) {
    line += " " + exact_number_text(exact);
  }
  for (const double value : rest) {
    line += " " + number_text("%.9g", value);
  }
  return line + " 4 10 4 4 4\n";
}

}  // namespace

std::string oxts_text(std::span<const Pose> poses) {
  if (poses.empty()) {
    return "";
  }
  const Eigen::Vector3d start_m = T_enu_body(kFirst, kFirst.latitude_deg).translation();
  const std::vector<Motion> motions = motions_of(poses);
  std::string text;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const Eigen::Vector3d t_m = start_m + (poses[i].translation() - poses.front().translation());
    const Eigen::Matrix3d& R = poses[i].linear();
    text += line_of(ins_reading(make_pose(R, t_m), kFirst.latitude_deg), motions[i], R);
  }
  return text;
}

}  // namespace skyhalo

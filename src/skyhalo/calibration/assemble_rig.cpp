#include <array>
#include <cmath>
#include <limits>
#include <set>
#include <string_view>
#include <utility>

#include "skyhalo/base/error.hpp"
#include "skyhalo/calibration/imported_cameras.hpp"

namespace skyhalo {
namespace {

constexpr double kLeastBaseline = 1e-6;  // m

/// All rotations by quarter turns: the signed permutations of the axes that are no mirror images.
std::vector<Eigen::Matrix3d> quarter_turns() {
  std::vector<Eigen::Matrix3d> turns;
  for (int x_axis = 0; x_axis < 3; ++x_axis) {
    for (int step = 1; step < 3; ++step) {
      for (const double x_sign : {1.0, -1.0}) {
        for (const double y_sign : {1.0, -1.0}) {
          const Eigen::Vector3d x = x_sign * Eigen::Vector3d::Unit(x_axis);
          const Eigen::Vector3d y = y_sign * Eigen::Vector3d::Unit((x_axis + step) % 3);
          Eigen::Matrix3d turn;
          turn << x, y, x.cross(y);
          turns.emplace_back(turn.array() + 0.0);  // no -0
        }
      }
    }
  }
  return turns;
}

/// The quarter turn that brings the pair's mean orientation nearest to the wanted one.
Eigen::Matrix3d nearest_quarter_turn(const Eigen::Matrix3d& R_imu_pair,
                                     const Eigen::Matrix3d& R_body_pair) {
  Eigen::Matrix3d best = Eigen::Matrix3d::Identity();
  double best_agreement = -std::numeric_limits<double>::infinity();
  for (const Eigen::Matrix3d& turn : quarter_turns()) {
    const double agreement = (R_body_pair.transpose() * turn * R_imu_pair).trace();
    if (agreement > best_agreement) {
      best = turn;
      best_agreement = agreement;
    }
  }
  return best;
}

Pose T_body_reference(const ImportedCameras& imported, const Mounting& mounting) {
  const Eigen::Matrix3d R_body_pair = R_body_camera(mounting.facing);
  const Pose& T_reference_left = imported.cameras[0].T_reference_camera;
  const Pose& T_reference_right = imported.cameras[1].T_reference_camera;
  if (imported.reference_is_imu && mounting.body_at_imu) {
    const Eigen::Matrix3d R_imu_pair = T_reference_left.linear() + T_reference_right.linear();
    return make_pose(nearest_quarter_turn(R_imu_pair, R_body_pair), Eigen::Vector3d::Zero());
  }
  return make_pose(R_body_pair, Eigen::Vector3d::Zero()) * T_reference_right.inverse();
}

/// Where a camera looks, by the largest component of its optical axis in the body.
std::string_view direction_of(const Pose& T_body_camera) {
  constexpr std::array<std::pair<std::string_view, std::string_view>, 3> kDirections = {
      {{"front", "back"}, {"left", "right"}, {"up", "down"}}};
  const Eigen::Vector3d axis = T_body_camera.linear().col(2);
  Eigen::Index largest = 0;
  axis.cwiseAbs().maxCoeff(&largest);
  const auto& [positive, negative] = kDirections[static_cast<std::size_t>(largest)];
  return axis[largest] > 0.0 ? positive : negative;
}

/// The name, with the first number from 2 that makes it a new one where it is taken.
std::string unique(std::string_view name, std::set<std::string>& taken) {
  std::string candidate(name);
  for (int number = 2; !taken.insert(candidate).second; ++number) {
    candidate = std::string(name) + std::to_string(number);
  }
  return candidate;
}

RawPair raw_pair(const ImportedCamera& left, const ImportedCamera& right) {
  const Pose T_right_left = right.T_reference_camera.inverse() * left.T_reference_camera;
  if (!(T_right_left.translation().norm() > kLeastBaseline)) {
    throw Error(ErrorKind::kInput,
                left.name + " and " + right.name +
                    ": the two cameras are in the same place, expected a baseline");
  }
  return {left.camera, right.camera, T_right_left};
}

PairDescription pair_description(RawPair cameras, const Pose& T_body_camera, std::string name) {
  return {.name = std::move(name),
          .images = RawPairDescription{std::move(cameras), {}},
          .T_body_camera = T_body_camera,
          .downscale = {},
          .rcrop_px = {},
          .masks_px = {},
          .min_range_m = {},
          .max_range_m = {}};
}

}  // namespace

Eigen::Matrix3d R_body_camera(Facing facing) noexcept {
  Eigen::Matrix3d R;
  switch (facing) {
    case Facing::kForward:
      R << 0, 0, 1, -1, 0, 0, 0, -1, 0;
      break;
    case Facing::kLeft:
      R << 1, 0, 0, 0, 0, 1, 0, -1, 0;
      break;
    case Facing::kRight:
      R << -1, 0, 0, 0, 0, -1, 0, -1, 0;
      break;
    case Facing::kBack:
      R << 0, 0, -1, 1, 0, 0, 0, -1, 0;
      break;
    case Facing::kDown:
      R << 0, -1, 0, -1, 0, 0, 0, 0, -1;
      break;
    case Facing::kUp:
      R << 0, 1, 0, -1, 0, 0, 0, 0, 1;
      break;
  }
  return R;
}

RigDescription assemble_rig(const ImportedCameras& imported,
                            const Mounting& mounting,
                            const std::string& name) {
  const std::vector<ImportedCamera>& cameras = imported.cameras;
  if (cameras.empty() || cameras.size() % 2 != 0) {
    throw Error(ErrorKind::kInput,
                "expected the cameras of stereo pairs, two by two, found " +
                    std::to_string(cameras.size()));
  }
  const Pose T_body_ref = T_body_reference(imported, mounting);
  RigDescription rig{.name = name, .T_body_imu = std::nullopt, .pairs = {}};
  if (imported.reference_is_imu) {
    rig.T_body_imu = T_body_ref;
  }
  std::set<std::string> taken;
  for (std::size_t i = 0; i < cameras.size(); i += 2) {
    const Pose T_body_camera = T_body_ref * cameras[i + 1].T_reference_camera;
    rig.pairs.push_back(pair_description(raw_pair(cameras[i], cameras[i + 1]),
                                         T_body_camera,
                                         unique(direction_of(T_body_camera), taken)));
  }
  return rig;
}

}  // namespace skyhalo

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "calibration/bad_input.hpp"
#include "skyhalo/calibration/imported_cameras.hpp"

namespace skyhalo {
namespace {

using ::testing::AllOf;
using testing::expect_matrix;
using ::testing::HasSubstr;
using testing::message_of;

const Lens kLens = RadialTangentialLens({400.0, 400.0, 320.0, 240.0}, {});

ImportedCamera camera(const std::string& name, const Pose& T_reference_camera) {
  return {name, {{640, 480}, kLens}, T_reference_camera};
}

Pose shifted(double x_m, double y_m, double z_m) {
  return make_pose(Eigen::Matrix3d::Identity(), {x_m, y_m, z_m});
}

const RawPair& raw(const PairDescription& pair) {
  return std::get<RawPairDescription>(pair.images).cameras;
}

TEST(AssembleRigTest, EveryFacingLooksThatWayAndLevel) {
  const Eigen::Vector3d ahead(0, 0, 1);
  const Eigen::Vector3d down(0, 1, 0);
  const auto looks = [&](Facing facing) -> Eigen::Vector3d {
    return R_body_camera(facing) * ahead;
  };
  const auto below = [&](Facing facing) -> Eigen::Vector3d { return R_body_camera(facing) * down; };
  expect_matrix(looks(Facing::kForward), Eigen::Vector3d(1, 0, 0), 0.0);
  expect_matrix(looks(Facing::kLeft), Eigen::Vector3d(0, 1, 0), 0.0);
  expect_matrix(looks(Facing::kRight), Eigen::Vector3d(0, -1, 0), 0.0);
  expect_matrix(looks(Facing::kBack), Eigen::Vector3d(-1, 0, 0), 0.0);
  expect_matrix(looks(Facing::kDown), Eigen::Vector3d(0, 0, -1), 0.0);
  expect_matrix(looks(Facing::kUp), Eigen::Vector3d(0, 0, 1), 0.0);
  for (const Facing facing : {Facing::kForward, Facing::kLeft, Facing::kRight, Facing::kBack}) {
    expect_matrix(below(facing), Eigen::Vector3d(0, 0, -1), 0.0);
  }
  // The vehicle's front is at the top of the image of a camera that looks down.
  expect_matrix(below(Facing::kDown), Eigen::Vector3d(-1, 0, 0), 0.0);
  expect_matrix(below(Facing::kUp), Eigen::Vector3d(1, 0, 0), 0.0);
  for (const Facing facing : {Facing::kForward,
                              Facing::kLeft,
                              Facing::kRight,
                              Facing::kBack,
                              Facing::kDown,
                              Facing::kUp}) {
    EXPECT_TRUE(is_rotation(R_body_camera(facing), 0.0));
  }
}

TEST(AssembleRigTest, WithoutAnImuTheRightCameraIsTheOrigin) {
  // The right camera 0.2 m to the right of the left one, in whose frame both are given.
  const ImportedCameras imported{
      .cameras = {camera("l", Pose::Identity()), camera("r", shifted(0.2, 0, 0))},
      .reference_is_imu = false,
      .warnings = {}};
  const RigDescription rig = assemble_rig(imported, {.facing = Facing::kLeft}, "drone");
  EXPECT_EQ(rig.name, "drone");
  EXPECT_FALSE(rig.T_body_imu);
  ASSERT_EQ(rig.pairs.size(), 1U);
  EXPECT_EQ(rig.pairs[0].name, "left");
  expect_matrix(rig.pairs[0].T_body_camera.matrix(),
                make_pose(R_body_camera(Facing::kLeft), Eigen::Vector3d::Zero()).matrix());
  expect_matrix(raw(rig.pairs[0]).T_right_left.translation(), Eigen::Vector3d(-0.2, 0, 0));
}

TEST(AssembleRigTest, WithAnImuItsAxesAreOnlyRenamed) {
  // An IMU with x down, y to the left and z ahead; the cameras are a tenth of a radian off level,
  // the right one is 0.3 m ahead of it and 0.1 m to its right.
  Eigen::Matrix3d R_exact;
  R_exact << 0, 1, 0,  // camera's y (down) is the IMU's x
      -1, 0, 0,        // camera's x (right) is the IMU's -y
      0, 0, 1;
  const Eigen::Matrix3d R_imu_cam =
      R_exact * Eigen::AngleAxisd(0.1, Eigen::Vector3d::UnitX()).matrix();
  const Eigen::Vector3d right_m(0.0, -0.1, 0.3);
  const ImportedCameras imported{
      .cameras = {camera("l", make_pose(R_imu_cam, right_m - R_imu_cam.col(0) * 0.2)),
                  camera("r", make_pose(R_imu_cam, right_m))},
      .reference_is_imu = true,
      .warnings = {}};
  const RigDescription rig = assemble_rig(imported, {}, "");
  ASSERT_TRUE(rig.T_body_imu);
  // Body x is the IMU's z, body y the IMU's y (left), body z the IMU's -x.
  Eigen::Matrix3d R_body_imu;
  R_body_imu << 0, 0, 1, 0, 1, 0, -1, 0, 0;
  expect_matrix(
      rig.T_body_imu->matrix(), make_pose(R_body_imu, Eigen::Vector3d::Zero()).matrix(), 0.0);
  const Pose& T_body_camera = rig.pairs[0].T_body_camera;
  expect_matrix(T_body_camera.translation(), Eigen::Vector3d(0.3, -0.1, 0.0));
  // Turned about x (right) by 0.1 the camera looks up by as much.
  expect_matrix(T_body_camera.linear().col(2), Eigen::Vector3d(std::cos(0.1), 0.0, std::sin(0.1)));
}

TEST(AssembleRigTest, TheImuNeedNotBeTheBody) {
  Eigen::Matrix3d R_imu_cam = R_body_camera(Facing::kForward);
  const ImportedCameras imported{.cameras = {camera("l", make_pose(R_imu_cam, {1.0, 0.1, 0.0})),
                                             camera("r", make_pose(R_imu_cam, {1.0, -0.1, 0.0}))},
                                 .reference_is_imu = true,
                                 .warnings = {}};
  const RigDescription rig = assemble_rig(imported, {.body_at_imu = false}, "");
  expect_matrix(rig.pairs[0].T_body_camera.matrix(),
                make_pose(R_imu_cam, Eigen::Vector3d::Zero()).matrix());
  ASSERT_TRUE(rig.T_body_imu);
  expect_matrix(rig.T_body_imu->matrix(), shifted(-1.0, 0.1, 0.0).matrix());
}

TEST(AssembleRigTest, PairsAreNamedByWhereTheyLookAndNumbered) {
  ImportedCameras imported{.cameras = {}, .reference_is_imu = true, .warnings = {}};
  for (const Facing facing : {Facing::kForward,
                              Facing::kLeft,
                              Facing::kForward,
                              Facing::kRight,
                              Facing::kBack,
                              Facing::kDown,
                              Facing::kUp,
                              Facing::kForward}) {
    const Pose T = make_pose(R_body_camera(facing), {1.0, 2.0, 3.0});
    imported.cameras.push_back(camera("l", T));
    imported.cameras.push_back(camera("r", T * shifted(0.1, 0, 0)));
  }
  std::vector<std::string> names;
  for (const PairDescription& pair : assemble_rig(imported, {}, "").pairs) {
    names.push_back(pair.name);
  }
  EXPECT_THAT(
      names,
      ::testing::ElementsAre("front", "left", "front2", "right", "back", "down", "up", "front3"));
}

TEST(AssembleRigTest, CamerasMustComeTwoByTwoAndApart) {
  ImportedCameras imported;
  EXPECT_THAT(message_of([&] { (void)assemble_rig(imported, {}, ""); }), HasSubstr("found 0"));
  imported.cameras.push_back(camera("cam0", shifted(1, 2, 3)));
  EXPECT_THAT(message_of([&] { (void)assemble_rig(imported, {}, ""); }), HasSubstr("found 1"));
  imported.cameras.push_back(camera("cam1", shifted(1, 2, 3)));
  EXPECT_THAT(message_of([&] { (void)assemble_rig(imported, {}, ""); }),
              AllOf(HasSubstr("cam0 and cam1"), HasSubstr("baseline")));
}

TEST(AssembleRigProperty, ATurnedImuGivesTheSamePairAndTheFirstPairLooksThatWay) {
  std::mt19937 generator(11);
  std::uniform_real_distribution<double> small(-0.2, 0.2);
  for (int i = 0; i < 200; ++i) {
    const Eigen::Vector3d tilt(small(generator), small(generator), small(generator));
    const Eigen::Matrix3d R_tilt =
        Eigen::AngleAxisd(tilt.norm(), tilt.normalized()).toRotationMatrix();
    const Eigen::Matrix3d R_turned =
        R_body_camera(static_cast<Facing>(i % 6)) * R_body_camera(static_cast<Facing>(i / 6 % 6));
    const Pose T_imu_right = make_pose(R_turned * R_tilt, 10.0 * tilt);
    const ImportedCameras imported{
        .cameras = {camera("l", T_imu_right * shifted(-0.3, 0.01, 0.02)), camera("r", T_imu_right)},
        .reference_is_imu = true,
        .warnings = {}};
    const Facing facing = static_cast<Facing>(i % 5);
    const RigDescription rig = assemble_rig(imported, {.facing = facing}, "");
    const Pose& T_body_camera = rig.pairs[0].T_body_camera;
    expect_matrix(raw(rig.pairs[0]).T_right_left.translation(), Eigen::Vector3d(-0.3, 0.01, 0.02));
    expect_matrix((rig.T_body_imu->inverse() * T_body_camera).matrix(), T_imu_right.matrix());
    const Eigen::Matrix3d off = R_body_camera(facing).transpose() * T_body_camera.linear();
    EXPECT_LE(Eigen::AngleAxisd(off).angle(), tilt.norm() + 1e-9);
  }
}

}  // namespace
}  // namespace skyhalo

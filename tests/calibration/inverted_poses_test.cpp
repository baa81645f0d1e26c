#include "skyhalo/calibration/inverted_poses.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace skyhalo {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

const Lens kLens = RadialTangentialLens({400.0, 400.0, 320.0, 240.0}, {});

/// Two cameras 0.2 m apart, off an IMU whose axes are turned by a quarter about z against theirs.
ImportedCameras turned_cameras() {
  Eigen::Matrix3d R_imu_cam;
  R_imu_cam << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  const auto pose = [&](double x_m) {
    return make_pose(R_imu_cam, R_imu_cam * Eigen::Vector3d(x_m, 0.01, 0.02));
  };
  return {.cameras = {{"cam0", {{640, 480}, kLens}, pose(-0.1)},
                      {"cam1", {{640, 480}, kLens}, pose(0.1)}},
          .reference_is_imu = true,
          .warnings = {}};
}

TEST(InvertedPosesTest, RightPosesAreNotComplainedAbout) {
  ImportedCameras imported = turned_cameras();
  warn_if_poses_look_inverted(imported, "T_BS");
  warn_if_reference_is_camera(imported, "T_BS");
  EXPECT_THAT(imported.warnings, IsEmpty());
}

TEST(InvertedPosesTest, InvertedPosesAre) {
  ImportedCameras imported = turned_cameras();
  for (ImportedCamera& camera : imported.cameras) {
    camera.T_reference_camera = camera.T_reference_camera.inverse();
  }
  warn_if_poses_look_inverted(imported, "T_BS");
  ASSERT_THAT(imported.warnings, SizeIs(1));
  EXPECT_THAT(imported.warnings[0], AllOf(HasSubstr("T_BS looks inverted"), HasSubstr("rows")));
}

TEST(InvertedPosesTest, NothingIsSaidOfOneCameraOrNoBaseline) {
  ImportedCameras one = turned_cameras();
  one.cameras.pop_back();
  warn_if_poses_look_inverted(one, "T_BS");
  EXPECT_THAT(one.warnings, IsEmpty());
  ImportedCameras same = turned_cameras();
  same.cameras[1] = same.cameras[0];
  warn_if_poses_look_inverted(same, "T_BS");
  EXPECT_THAT(same.warnings, IsEmpty());
}

TEST(InvertedPosesTest, AReferenceThatIsTheFirstCameraIsNamed) {
  ImportedCameras imported = turned_cameras();
  imported.cameras[0].T_reference_camera = Pose::Identity();
  warn_if_reference_is_camera(imported, "T_imu_cam");
  ASSERT_THAT(imported.warnings, SizeIs(1));
  EXPECT_THAT(imported.warnings[0], HasSubstr("T_imu_cam of the first camera is the identity"));
}

}  // namespace
}  // namespace skyhalo

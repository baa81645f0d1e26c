#include "skyhalo/dataset/kitti_label_text.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "support/temp_folder.hpp"
#include "support/written_frames.hpp"

namespace skyhalo {
namespace {

using testing::TempFolder;

const LabelCamera kCamera{256.0, 156.0, 48.0, {320, 96}};

/// An object that looks the same way as the camera, with its bottom's centre at a point of it.
Pose facing_ahead(const Eigen::Vector3d& bottom_m) {
  return make_pose(testing::forward_camera().transpose(), bottom_m);
}

SceneObject car() {
  SceneObject object{.track = 7, .type = "Car"};
  object.size_m = {4.0, 2.0, 1.5};
  object.occluded = 2;
  return object;
}

TEST(KittiLabelTextTest, ALineIsAsWorkedOutByHand) {
  // x in -1...1, y in 0...1.5, z in 8...12: the near face spans 156 +- 256/8 across and 48 to
  // 48 + 256 1.5/8 = 96 down, of which the image has all but the last row.
  EXPECT_EQ(label_line(car(), 3, facing_ahead({0.0, 1.5, 10.0}), kCamera),
            "3 7 Car 1 2 -1.570796 124.000000 48.000000 188.000000 95.000000 1.500000 2.000000 "
            "4.000000 0.000000 1.500000 10.000000 -1.570796\n");
}

TEST(KittiLabelTextTest, AlphaIsSeenFromTheRay) {
  // 45 degrees to the right of the axis, looking to the right: along x is ry = 0.
  Pose to_the_right = facing_ahead({6.0, 1.0, 6.0});
  to_the_right.linear() << 1, 0, 0, 0, 0, -1, 0, 1, 0;
  const LabelBox box = label_box(car(), to_the_right);
  EXPECT_NEAR(box.rotation_y_rad, 0.0, 1e-15);
  const LabelCamera wide{60.0, 156.0, 48.0, {320, 96}};
  const std::string line = label_line(car(), 0, to_the_right, wide).value_or("");
  EXPECT_THAT(line, ::testing::StartsWith("0 7 Car 0 2 -0.785398 "));
}

TEST(KittiLabelTextTest, ThingsThatAreNotSeenHaveNoLine) {
  for (const Eigen::Vector3d& bottom_m : {Eigen::Vector3d(0.0, 1.5, -10.0),
                                          Eigen::Vector3d(0.0, 1.5, -2.1),
                                          Eigen::Vector3d(40.0, 1.5, 10.0),
                                          Eigen::Vector3d(0.0, -20.0, 10.0)}) {
    EXPECT_FALSE(label_line(car(), 0, facing_ahead(bottom_m), kCamera)) << bottom_m.transpose();
  }
}

TEST(KittiLabelTextTest, ABoxThatReachesBehindTheCameraIsCutOff) {
  const auto region = label_region(label_box(car(), facing_ahead({1.5, 1.0, 0.5})), kCamera);
  ASSERT_TRUE(region);
  EXPECT_EQ(region->truncated, 2);
  EXPECT_EQ(region->box_px.max().x(), 319.0);
  EXPECT_EQ(region->box_px.max().y(), 95.0);
  // Its innermost edge at z = 2.5 and x = 0.5 is as far left as it gets.
  EXPECT_NEAR(region->box_px.min().x(), 156.0 + 256.0 * 0.5 / 2.5, 1e-9);
}

TEST(KittiLabelTextProperty, TheBoxIsReadBack) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  const TempFolder folder;
  for (int i = 0; i < 50; ++i) {
    const double angle_rad = std::numbers::pi * unit(random);
    const Eigen::Matrix3d R_turned =
        Eigen::AngleAxisd(angle_rad, Eigen::Vector3d::UnitY()).toRotationMatrix();
    Eigen::Matrix3d R_lying;  // turned by 0: x to the right, z up, so y away
    R_lying << 1, 0, 0, 0, 0, -1, 0, 1, 0;
    const Pose T_camera_object = make_pose(R_turned * R_lying, {unit(random), 1.0, 15.0});
    const auto line = label_line(car(), 0, T_camera_object, kCamera);
    ASSERT_TRUE(line);
    const TrackLabels labels(folder.write("0000.txt", *line));
    ASSERT_EQ(labels.objects(0).size(), 1U);
    const OrientedBox& box = labels.objects(0)[0].box;
    for (int k = 0; k < 20; ++k) {
      const Eigen::Vector3d p(2.2 * unit(random), 1.2 * unit(random), 0.8 + 0.9 * unit(random));
      const bool inside =
          std::abs(p.x()) < 1.999 && std::abs(p.y()) < 0.999 && p.z() > 0.001 && p.z() < 1.499;
      const bool outside =
          std::abs(p.x()) > 2.001 || std::abs(p.y()) > 1.001 || p.z() < -0.001 || p.z() > 1.501;
      if (inside || outside) {
        EXPECT_EQ(contains(box, T_camera_object * p), inside) << p.transpose();
      }
    }
  }
}

}  // namespace
}  // namespace skyhalo

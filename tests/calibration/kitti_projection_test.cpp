#include "skyhalo/calibration/kitti_projection.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "calibration/bad_input.hpp"

namespace skyhalo {
namespace {

using testing::expect_matrix;
using testing::TempFolder;

const std::string kText =
    "P2: 200 0 100 10 0 200 50 45 0 0 1 0.5\n"
    "P3: 200 0 110 -105 0 200 50 45 0 0 1 0.5\n"
    "R: 0 -1 0 1 0 0 0 0 1\n";

TEST(KittiProjectionTest, ThePairIsReadOff) {
  // t = K^-1 p: left ((10 - 100 * 0.5) / 200, (45 - 50 * 0.5) / 200, 0.5), right
  // ((-105 - 110 * 0.5) / 200, 0.1, 0.5).
  const TempFolder folder;
  const KittiProjections p =
      read_kitti_projections(KeyValueFile(folder.write("calib.txt", kText)), "P2", "P3");
  EXPECT_EQ(p.pair.focal_px, 200.0);
  EXPECT_EQ(p.pair.principal_u_px, 110.0);
  EXPECT_EQ(p.pair.principal_v_px, 50.0);
  EXPECT_NEAR(p.pair.baseline_m, 0.6, 1e-12);
  EXPECT_EQ(p.pair.disparity_offset_px, 10.0);
  expect_matrix(p.T_left_reference.translation(), Eigen::Vector3d(-0.2, 0.1, 0.5));
  expect_matrix(p.T_right_reference.translation(), Eigen::Vector3d(-0.8, 0.1, 0.5));
}

TEST(KittiProjectionTest, WhatIsNoRectifiedPairIsNamed) {
  const auto read = [](const std::filesystem::path& file) {
    (void)read_kitti_projections(KeyValueFile(file), "P2", "P3");
  };
  testing::expect_refused(kText,
                          "calib.txt",
                          {{"P2", "Q", {"P2: this key is missing"}},
                           {"P3", "Q", {"P3: this key is missing"}},
                           {"-105", "105", {":2: P3: the right camera is not to the right"}},
                           {"110 -105 0 200 50", "110 -105 0 200 51", {":2: P3: the principal"}},
                           {"200 0 110 -105 0 200", "210 0 110 -105 0 210", {":2: P3: the focal"}},
                           {"200 0 100 10 0 200", "200 0 100 10 0 201", {":1: P2: is not the"}},
                           {" 0.5\nP3", "\nP3", {":1: P2: expected 12 numbers, found 11"}},
                           {"-105", "nan", {":2: P3", "nan"}}},
                          read);
}

TEST(KittiProjectionTest, ARotationIsOneOfSevenDigits) {
  const auto read = [](const std::filesystem::path& file) {
    (void)read_kitti_rotation(KeyValueFile(file), "R");
  };
  const TempFolder folder;
  Eigen::Matrix3d expected;
  expected << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  expect_matrix(
      read_kitti_rotation(KeyValueFile(folder.write("calib.txt", kText)), "R"), expected, 0.0);
  testing::expect_refused(kText,
                          "calib.txt",
                          {{"R: 0 -1", "R: 0 -1.001", {":3: R: is not a rotation"}},
                           {"R: 0 -1", "R: 0 1", {":3: R: is not a rotation"}},
                           {"R:", "Q:", {"R: this key is missing"}}},
                          read);
}

}  // namespace
}  // namespace skyhalo

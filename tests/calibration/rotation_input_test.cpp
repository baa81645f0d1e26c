#include "skyhalo/calibration/rotation_input.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "calibration/bad_input.hpp"

namespace skyhalo {
namespace {

using ::testing::AllOf;
using testing::expect_matrix;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::message_of;
using ::testing::SizeIs;

Error at_place(std::string_view message) {
  return input_error("cams.yaml", 7, message);
}

/// A quarter turn about z with one axis too long by `excess`: |R R' - I| is about 2 excess.
Eigen::Matrix3d stretched(double excess) {
  Eigen::Matrix3d R;
  R << 0, -1, 0, 1.0 + excess, 0, 0, 0, 0, 1;
  return R;
}

TEST(RotationInputTest, ARotationStaysWithoutAWord) {
  std::vector<std::string> warnings;
  expect_matrix(rotation_from(stretched(0.0), at_place, warnings), stretched(0.0), 1e-15);
  EXPECT_THAT(warnings, IsEmpty());
}

TEST(RotationInputTest, RoundedDigitsStayAsTheyAre) {
  std::vector<std::string> warnings;
  expect_matrix(rotation_from(stretched(4e-6), at_place, warnings), stretched(4e-6), 0.0);
  EXPECT_THAT(warnings, IsEmpty());
}

TEST(RotationInputTest, FewDigitsAreMadeARotationWithAWarning) {
  std::vector<std::string> warnings;
  expect_matrix(rotation_from(stretched(4e-4), at_place, warnings), stretched(0.0), 1e-12);
  ASSERT_THAT(warnings, SizeIs(1));
  EXPECT_THAT(warnings[0], AllOf(HasSubstr("cams.yaml:7:"), HasSubstr("orthonormal")));
}

TEST(RotationInputTest, WhatIsNoRotationIsRefused) {
  std::vector<std::string> warnings;
  Eigen::Matrix3d mirror = Eigen::Matrix3d::Identity();
  mirror(2, 2) = -1.0;
  Eigen::Matrix3d hole = Eigen::Matrix3d::Identity();
  hole(0, 1) = std::numeric_limits<double>::quiet_NaN();
  const Eigen::Matrix3d nothing = Eigen::Matrix3d::Zero();
  for (const Eigen::Matrix3d& bad : {stretched(6e-4), mirror, hole, nothing}) {
    SCOPED_TRACE(bad);
    EXPECT_THAT(message_of([&] { (void)rotation_from(bad, at_place, warnings); }),
                HasSubstr("cams.yaml:7: the rotation"));
  }
}

TEST(RotationInputTest, NineNumbersComeRowByRow) {
  std::vector<std::string> warnings;
  const std::vector<double> numbers = {0, -1, 0, 1, 0, 0, 0, 0, 1};
  expect_matrix(rotation_from(numbers, at_place, warnings), stretched(0.0), 1e-15);
  const std::vector<double> eight(8, 0.0);
  EXPECT_THAT(message_of([&] { (void)rotation_from(eight, at_place, warnings); }),
              HasSubstr("expected 9 numbers, found 8"));
}

TEST(RotationInputTest, SixteenNumbersAreATransform) {
  std::vector<std::string> warnings;
  std::vector<double> numbers = {0, -1, 0, 4, 1, 0, 0, 5, 0, 0, 1, 6, 0, 0, 0, 1};
  const Pose T = pose_from(numbers, at_place, warnings);
  expect_matrix(T.linear(), stretched(0.0), 1e-15);
  expect_matrix(T.translation(), Eigen::Vector3d(4.0, 5.0, 6.0), 0.0);
  numbers[12] = 0.5;
  EXPECT_THAT(message_of([&] { (void)pose_from(numbers, at_place, warnings); }),
              HasSubstr("expected 0 0 0 1 as the last row"));
  numbers.resize(12);
  EXPECT_THAT(message_of([&] { (void)pose_from(numbers, at_place, warnings); }),
              HasSubstr("expected 16 numbers, found 12"));
}

TEST(RotationInputTest, AQuaternionIsMadeAUnit) {
  // w = z: a quarter turn about z. Twice sqrt(0.5), each longer by 4e-4, is off 1 by as much.
  std::vector<std::string> warnings;
  const double c = std::sqrt(0.5);
  expect_matrix(
      rotation_from(Eigen::Quaterniond(c, 0, 0, c), at_place, warnings), stretched(0.0), 1e-15);
  EXPECT_THAT(warnings, IsEmpty());
  const double longer = c * 1.0004;
  expect_matrix(rotation_from(Eigen::Quaterniond(longer, 0, 0, longer), at_place, warnings),
                stretched(0.0),
                1e-12);
  EXPECT_THAT(warnings, SizeIs(1));
  for (const Eigen::Quaterniond& bad :
       {Eigen::Quaterniond(1, 0, 0, 1), Eigen::Quaterniond(0, 0, 0, 0)}) {
    EXPECT_THAT(message_of([&] { (void)rotation_from(bad, at_place, warnings); }),
                AllOf(HasSubstr("cams.yaml:7:"), HasSubstr("quaternion")));
  }
}

TEST(RotationInputProperty, TheNearestRotationIsOneAndFartherOnesAreFarther) {
  std::mt19937 generator(7);
  std::uniform_real_distribution<double> noise(-0.2, 0.2);
  for (int i = 0; i < 200; ++i) {
    const Eigen::Vector3d turn(noise(generator), noise(generator), noise(generator));
    Eigen::Matrix3d given = Eigen::AngleAxisd(10.0 * turn.norm(), turn.normalized()).matrix();
    for (double& value : given.reshaped()) {
      value += noise(generator);
    }
    const Eigen::Matrix3d nearest = nearest_rotation(given);
    EXPECT_TRUE(is_rotation(nearest, 1e-12));
    const Eigen::Matrix3d other = nearest * Eigen::AngleAxisd(0.01, turn.normalized()).matrix();
    EXPECT_LT((given - nearest).norm(), (given - other).norm());
  }
}

}  // namespace
}  // namespace skyhalo

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>
#include <random>

#include "skyhalo/dataset/kitti_oxts.hpp"
#include "skyhalo/io/text_file.hpp"
#include "support/expect_error.hpp"
#include "support/temp_folder.hpp"
#include "support/written_frames.hpp"

namespace skyhalo {
namespace {

using testing::difference;
using ::testing::HasSubstr;
using testing::message_of;
using testing::PoseDifference;
using testing::TempFolder;

std::vector<std::vector<double>> numbers_of(const std::filesystem::path& file) {
  std::vector<std::vector<double>> rows;
  for (const std::string& line : read_lines(file)) {
    rows.emplace_back();
    for (const std::string_view word : split_words(line)) {
      rows.back().push_back(parse_number(word).value());
    }
  }
  return rows;
}

void expect_poses_come_back(const std::vector<Pose>& poses) {
  const TempFolder folder;
  const std::vector<Pose> back =
      poses_of(read_oxts_table(folder.write("0000.txt", oxts_text(poses))));
  ASSERT_EQ(back.size(), poses.size());
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const PoseDifference d = difference(poses.front() * back[i], poses[i]);
    EXPECT_LT(d.distance_m, 1e-6) << i;
    EXPECT_LT(d.angle_rad, 1e-9) << i;
  }
}

TEST(KittiOxtsTextProperty, PosesComeBackOverKilometres) {
  std::mt19937 random(3);
  std::vector<Pose> driving;
  std::vector<Pose> any;
  for (int i = 0; i < 100; ++i) {
    driving.push_back(testing::driving_pose(random, 2000.0));
    any.push_back(testing::some_pose(random, 1000.0));
  }
  expect_poses_come_back(driving);
  expect_poses_come_back(any);
}

TEST(KittiOxtsTextTest, APoseThatPointsStraightUpComesBack) {
  const auto upright = [](double sign, double yaw_rad) {
    return make_pose((Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ()) *
                      Eigen::AngleAxisd(sign * std::numbers::pi / 2, Eigen::Vector3d::UnitY()))
                         .toRotationMatrix(),
                     {1.0, 2.0, 3.0});
  };
  expect_poses_come_back({Pose::Identity(), upright(1.0, 0.4), upright(-1.0, -1.4)});
}

TEST(KittiOxtsTextTest, TheFirstPoseStandsInKarlsruhe) {
  const TempFolder folder;
  const auto rows = numbers_of(folder.write(
      "0000.txt", oxts_text(std::vector{make_pose(Eigen::Matrix3d::Identity(), {7.0, 8.0, 9.0})})));
  ASSERT_EQ(rows.size(), 1U);
  ASSERT_EQ(rows[0].size(), 30U);
  EXPECT_NEAR(rows[0][0], 49.0, 1e-12);
  EXPECT_NEAR(rows[0][1], 8.4, 1e-12);
  EXPECT_NEAR(rows[0][2], 116.0, 1e-12);
  EXPECT_NEAR(rows[0][13], 9.81, 1e-9);  // the ground carries it
  for (const int at : {6, 7, 8, 9, 10, 11, 12, 17, 18, 19}) {
    EXPECT_EQ(rows[0][static_cast<std::size_t>(at)], 0.0) << at;
  }
}

TEST(KittiOxtsTextTest, VelocitiesAreDifferencesOfPoses) {
  // North at 20 m/s, looking north and slowly turning left by 0.1 rad/s, rising 1 m/s.
  std::vector<Pose> poses;
  for (int i = 0; i < 5; ++i) {
    poses.push_back(
        make_pose(Eigen::AngleAxisd(std::numbers::pi / 2 + 0.01 * (i - 2), Eigen::Vector3d::UnitZ())
                      .toRotationMatrix(),
                  {0.0, 2.0 * i, 0.1 * i}));
  }
  const TempFolder folder;
  const auto rows = numbers_of(folder.write("0000.txt", oxts_text(poses)));
  ASSERT_EQ(rows.size(), 5U);
  for (const auto& row : rows) {
    EXPECT_NEAR(row[6], 20.0, 1e-6);  // vn
    EXPECT_NEAR(row[7], 0.0, 1e-6);   // ve
    EXPECT_NEAR(row[10], 1.0, 1e-6);  // vu
    EXPECT_NEAR(row[19], 0.1, 1e-6);  // wz
  }
  EXPECT_NEAR(rows[2][8], 20.0, 1e-6);  // vf
  EXPECT_NEAR(rows[2][9], 0.0, 1e-6);   // vl
  EXPECT_NEAR(rows[4][8], 20.0 * std::cos(0.02), 1e-6);
  EXPECT_NEAR(rows[4][9], -20.0 * std::sin(0.02), 1e-6);  // it looks left of where it goes
  EXPECT_NEAR(rows[2][5], std::numbers::pi / 2, 1e-12);
}

TEST(KittiOxtsTextTest, AFaultyTableIsNamedByItsLine) {
  const TempFolder folder;
  const std::string good = oxts_text(std::vector{Pose::Identity(), Pose::Identity()});
  const auto refused = [&](const std::string& text) {
    const auto file = folder.write("0000.txt", text);
    return message_of([&] { (void)read_oxts_table(file); });
  };
  EXPECT_THAT(refused(""), HasSubstr("holds no line"));
  EXPECT_THAT(refused("\n\n"), HasSubstr("holds no line"));
  EXPECT_THAT(refused(good + "1 2 3\n"), HasSubstr("0000.txt:3: expected 30 numbers, found 3"));
  EXPECT_THAT(refused("\n" + good), HasSubstr(":1: expected 30 numbers"));
  std::string nan = good;
  nan.replace(nan.rfind("9.81"), 4, "nan");
  EXPECT_THAT(refused(nan), HasSubstr(":2: value 17: expected a finite number"));
}

TEST(KittiOxtsTextTest, NoPosesAreNoText) {
  EXPECT_EQ(oxts_text({}), "");
}

}  // namespace
}  // namespace skyhalo

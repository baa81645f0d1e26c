#include "skyhalo/io/trajectory_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <chrono>
#include <cmath>
#include <random>
#include <vector>

#include "skyhalo/io/text_file.hpp"
#include "support/expect_error.hpp"
#include "support/temp_folder.hpp"

namespace skyhalo {
namespace {

using ::testing::HasSubstr;
using testing::message_of;
using testing::TempFolder;

constexpr double kPi = 3.14159265358979323846;

Timestamp stamp_at(std::int64_t nanoseconds) {
  return Timestamp{std::chrono::nanoseconds(nanoseconds)};
}

Pose pose_of(const Eigen::Vector3d& axis, double angle_rad, const Eigen::Vector3d& t_m) {
  return make_pose(Eigen::AngleAxisd(angle_rad, axis.normalized()).toRotationMatrix(), t_m);
}

/// The lines that are no comment, word by word.
std::vector<std::vector<std::string>> data_lines(const std::filesystem::path& file) {
  std::vector<std::vector<std::string>> lines;
  for (const std::string& line : read_lines(file)) {
    if (!line.starts_with("#")) {
      const auto words = split_words(line);
      lines.emplace_back(words.begin(), words.end());
    }
  }
  return lines;
}

TEST(TrajectoryFileTest, WritesALineForEachPose) {
  const TempFolder folder;
  const auto file = folder.path() / "trajectory.tum";
  // A quarter turn to the left: yaw 90 deg is the quaternion (0, 0, sin 45, cos 45).
  write_tum(file,
            {{stamp_at(1'317'042'145'964'389'445), Pose::Identity()},
             {stamp_at(1'317'042'146'067'000'001),
              pose_of(Eigen::Vector3d::UnitZ(), kPi / 2.0, {1.5, -2.25, 0.125})}});
  const auto lines = data_lines(file);
  ASSERT_EQ(lines.size(), 2U);
  ASSERT_EQ(lines[0].size(), 8U);
  ASSERT_EQ(lines[1].size(), 8U);
  EXPECT_EQ(lines[0][0], "1317042145.964389445");
  EXPECT_EQ(lines[1][0], "1317042146.067000001");
  const std::vector<double> expected{1.5, -2.25, 0.125, 0.0, 0.0, std::sqrt(0.5), std::sqrt(0.5)};
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_NEAR(parse_number(lines[1][i + 1]).value_or(99.0), expected[i], 1e-6) << i;
  }
}

TEST(TrajectoryFileTest, AFileThatCannotBeWrittenIsAFailure) {
  const TempFolder folder;
  const auto file = folder.path() / "missing" / "trajectory.tum";
  EXPECT_THAT(message_of([&] { write_tum(file, {}); }, ErrorKind::kFailure),
              HasSubstr(file.string()));
}

TEST(TrajectoryFileProperty, APoseCanBeRebuilt) {
  const TempFolder folder;
  const auto file = folder.path() / "trajectory.tum";
  std::mt19937 random(6);
  std::uniform_real_distribution length(-500.0, 500.0);
  std::uniform_real_distribution angle(-kPi, kPi);
  std::vector<StampedPose> trajectory;
  for (int i = 0; i < 40; ++i) {
    const Eigen::Vector3d axis(length(random), length(random), length(random));
    const Eigen::Vector3d t_m(length(random), length(random), length(random));
    trajectory.push_back({stamp_at(100'000'000LL * i), pose_of(axis, angle(random), t_m)});
  }
  write_tum(file, trajectory);
  const auto lines = data_lines(file);
  ASSERT_EQ(lines.size(), trajectory.size());
  for (std::size_t i = 0; i < lines.size(); ++i) {
    std::vector<double> v;
    for (const std::string& word : lines[i]) {
      v.push_back(parse_number(word).value_or(std::nan("")));
    }
    ASSERT_EQ(v.size(), 8U);
    const Eigen::Quaterniond q(v[7], v[4], v[5], v[6]);
    const Pose again = make_pose(q.toRotationMatrix(), {v[1], v[2], v[3]});
    EXPECT_LT((again.matrix() - trajectory[i].T_map_body.matrix()).cwiseAbs().maxCoeff(), 1e-5);
    EXPECT_NEAR(v[0], 0.1 * static_cast<double>(i), 1e-9);
  }
}

}  // namespace
}  // namespace skyhalo

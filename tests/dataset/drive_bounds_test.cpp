#include "skyhalo/dataset/drive_bounds.hpp"

#include <gtest/gtest.h>

#include <random>
#include <utility>
#include <vector>

namespace skyhalo {
namespace {

/// A recording of nothing but a path.
class Path final : public FrameSource {
 public:
  explicit Path(std::vector<Eigen::Vector3d> positions_m) : positions_m_(std::move(positions_m)) {}

  [[nodiscard]] std::string name() const override { return "path"; }

  [[nodiscard]] const StereoRig& rig() const override { return rig_; }

  [[nodiscard]] int frame_count() const override { return static_cast<int>(positions_m_.size()); }

  [[nodiscard]] Timestamp stamp(int) const override { return {}; }

  [[nodiscard]] Pose T_map_body(int frame) const override {
    return make_pose(Eigen::Matrix3d::Identity(), positions_m_.at(static_cast<std::size_t>(frame)));
  }

  [[nodiscard]] FrameSet read(int) const override { return {}; }

 private:
  StereoRig rig_;
  std::vector<Eigen::Vector3d> positions_m_;
};

constexpr BoundsConfig kConfig{
    .ahead_m = 8.0, .behind_m = 0.0, .side_m = 10.0, .bottom_m = -2.0, .top_m = 3.0};

void expect_box(const Eigen::AlignedBox3d& box,
                const Eigen::Vector3d& min_m,
                const Eigen::Vector3d& max_m) {
  EXPECT_LT((box.min() - min_m).norm(), 1e-12) << box.min().transpose();
  EXPECT_LT((box.max() - max_m).norm(), 1e-12) << box.max().transpose();
}

TEST(DriveBoundsTest, FollowTheDrive) {
  const Path path({{0, 0, 0}, {50, 1, 0.5}, {120, -2, -7}});
  expect_box(drive_bounds(path, kConfig), {0, -10, -2}, {128, 10, 3});
}

TEST(DriveBoundsTest, AreThoseOfTheThesisProtocol) {
  // METHOD 7: 0003 ends near x = 173 m; 200 x 100 x 5.5 m at 0.5 m are 880 000 cells.
  const Path path({{0, 0, 0}, {173, 0, 0}});
  const Eigen::AlignedBox3d box = drive_bounds(path, BoundsConfig{});
  expect_box(box, {0, -50, -3}, {200, 50, 2.5});
  EXPECT_NEAR(box.volume() / 0.125, 880000.0, 1e-6);
}

TEST(DriveBoundsTest, ABodyThatStaysHasWhatIsAhead) {
  expect_box(drive_bounds(Path({{0, 0, 0}}), kConfig), {0, -10, -2}, {8, 10, 3});
}

TEST(DriveBoundsTest, StartAtTheRearmostPosition) {
  const Path path({{0, 0, 0}, {-30, 0, 0}, {5, 0, 0}});
  expect_box(drive_bounds(path, kConfig), {-30, -10, -2}, {13, 10, 3});
}

TEST(DriveBoundsTest, ReachBehindWhereAskedTo) {
  BoundsConfig config = kConfig;
  config.behind_m = 4.0;
  expect_box(drive_bounds(Path({{0, 0, 0}, {6, 0, 0}}), config), {-4, -10, -2}, {14, 10, 3});
}

TEST(DriveBoundsTest, GrowSidewaysOnlyWhereThePathLeavesTheStrip) {
  // y = 9 is within the strip of 10 m; y = -15 is not.
  expect_box(
      drive_bounds(Path({{0, 0, 0}, {5, 9, 0}, {5, -9.5, 0}}), kConfig), {0, -10, -2}, {13, 10, 3});
  expect_box(drive_bounds(Path({{0, 0, 0}, {5, -15, 0}}), kConfig), {0, -23, -2}, {13, 10, 3});
  expect_box(drive_bounds(Path({{0, 0, 0}, {5, 40, 0}}), kConfig), {0, -10, -2}, {13, 48, 3});
}

TEST(DriveBoundsProperty, HoldTheWholePathInPlan) {
  std::mt19937 random(9);
  std::uniform_real_distribution length(-200.0, 200.0);
  for (int round = 0; round < 100; ++round) {
    std::vector<Eigen::Vector3d> positions_m{{0, 0, 0}};
    for (int i = 0; i < 10; ++i) {
      positions_m.emplace_back(length(random), length(random), length(random));
    }
    const Eigen::AlignedBox3d box = drive_bounds(Path(positions_m), kConfig);
    for (const Eigen::Vector3d& p_m : positions_m) {
      EXPECT_LE(box.min().x(), p_m.x());
      EXPECT_GE(box.max().x(), p_m.x() + kConfig.ahead_m - 1e-9);
      EXPECT_LT(box.min().y(), p_m.y());
      EXPECT_GT(box.max().y(), p_m.y());
    }
  }
}

}  // namespace
}  // namespace skyhalo

#include "skyhalo/sim/trajectory.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <thread>

#include "sim/motion_checks.hpp"
#include "support/expect_error.hpp"

namespace skyhalo {
namespace {

using ::testing::HasSubstr;
using testing::message_of;
using testing::turn_between;

MotionSample sample_at(double t_s,
                       const Eigen::Vector3d& position_m,
                       const Eigen::Vector3d& velocity_mps,
                       double yaw_rad) {
  const Eigen::AngleAxisd yaw(yaw_rad, Eigen::Vector3d::UnitZ());
  return {.T_map_body = make_pose(yaw.toRotationMatrix(), position_m),
          .velocity_mps = velocity_mps,
          .t_s = t_s};
}

/// x = t^3 - 2 t, y = t^2, z = 1 and a yaw of 0.5 t, from 10 s to 13 s on the samples' clock.
Trajectory cubic_motion() {
  std::vector<MotionSample> samples;
  for (const double t : {0.0, 0.5, 2.0, 3.0}) {
    samples.push_back(sample_at(
        10.0 + t, {t * t * t - 2.0 * t, t * t, 1.0}, {3.0 * t * t - 2.0, 2.0 * t, 0.0}, 0.5 * t));
  }
  return Trajectory(samples);
}

TEST(TrajectoryTest, FollowsACubicExactly) {
  const Trajectory motion = cubic_motion();
  EXPECT_EQ(motion.duration_s(), 3.0);
  for (const double t : {0.0, 0.2, 0.5, 1.1, 2.0, 2.9, 3.0}) {
    const Pose T = motion.T_map_body(t);
    const Eigen::AngleAxisd yaw(0.5 * t, Eigen::Vector3d::UnitZ());
    EXPECT_LE((T.translation() - Eigen::Vector3d(t * t * t - 2.0 * t, t * t, 1.0)).norm(), 1e-12);
    EXPECT_LE((T.linear() - yaw.toRotationMatrix()).norm(), 1e-12);
    EXPECT_LE((motion.velocity_mps(t) - Eigen::Vector3d(3.0 * t * t - 2.0, 2.0 * t, 0.0)).norm(),
              1e-12);
    EXPECT_LE((motion.acceleration_mps2(t) - Eigen::Vector3d(6.0 * t, 2.0, 0.0)).norm(), 1e-11);
  }
}

TEST(TrajectoryTest, MovesTheSamplesToBeginAtZero) {
  const Trajectory motion = cubic_motion();
  ASSERT_EQ(motion.samples().size(), 4U);
  EXPECT_EQ(motion.samples()[0].t_s, 0.0);
  EXPECT_EQ(motion.samples()[2].t_s, 2.0);
}

TEST(TrajectoryTest, StaysAtItsEnds) {
  const Trajectory motion = cubic_motion();
  const double infinity = std::numeric_limits<double>::infinity();
  for (const double t : {-1.0, -infinity, std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_EQ(motion.T_map_body(t).matrix(), motion.T_map_body(0.0).matrix());
    EXPECT_EQ(motion.velocity_mps(t), motion.velocity_mps(0.0));
  }
  for (const double t : {3.1, infinity}) {
    EXPECT_EQ(motion.T_map_body(t).matrix(), motion.T_map_body(3.0).matrix());
    EXPECT_EQ(motion.acceleration_mps2(t), motion.acceleration_mps2(3.0));
  }
  EXPECT_EQ(motion.T_map_body(3.0).translation(), Eigen::Vector3d(21.0, 9.0, 1.0));
}

TEST(TrajectoryTest, TurnsTheShortWay) {
  const Trajectory motion(
      {sample_at(0.0, {0, 0, 0}, {0, 0, 0}, 3.0), sample_at(1.0, {0, 0, 0}, {0, 0, 0}, -3.0)});
  const Eigen::AngleAxisd middle(3.14159265358979323846, Eigen::Vector3d::UnitZ());
  const Eigen::Matrix3d R = motion.T_map_body(0.5).linear();
  EXPECT_LE((R - middle.toRotationMatrix()).norm(), 1e-9);
}

TEST(TrajectoryProperty, IsContinuousAcrossSamples) {
  const Trajectory motion = cubic_motion();
  for (const MotionSample& sample : motion.samples()) {
    const Pose T_map_before = motion.T_map_body(sample.t_s - 1e-7);
    const Pose T_map_after = motion.T_map_body(sample.t_s + 1e-7);
    EXPECT_LE((T_map_after.translation() - T_map_before.translation()).norm(), 2e-7 * 30.0);
    EXPECT_LE(turn_between(T_map_before, T_map_after), 1.1e-7);
    EXPECT_LE(
        (motion.velocity_mps(sample.t_s + 1e-7) - motion.velocity_mps(sample.t_s - 1e-7)).norm(),
        2e-7 * 20.0);
  }
}

TEST(TrajectoryProperty, GivesTheSameBitsFromTwoThreads) {
  const Trajectory motion = cubic_motion();
  std::vector<Pose> first(500);
  std::vector<Pose> second(500);
  const auto evaluate = [&](std::vector<Pose>& poses) {
    for (std::size_t i = 0; i < poses.size(); ++i) {
      poses[i] = motion.T_map_body(0.006 * static_cast<double>(i));
    }
  };
  std::thread other([&] { evaluate(second); });
  evaluate(first);
  other.join();
  for (std::size_t i = 0; i < first.size(); ++i) {
    ASSERT_EQ(first[i].matrix(), second[i].matrix());
    ASSERT_TRUE(is_rotation(first[i].linear(), 1e-12));
  }
}

TEST(TrajectoryTest, RefusesSamplesThatMakeNoMotion) {
  const auto message = [](const std::vector<MotionSample>& samples) {
    return message_of([&] { const Trajectory motion(samples); });
  };
  const MotionSample start = sample_at(1.0, {0, 0, 0}, {0, 0, 0}, 0.0);
  MotionSample end = sample_at(2.0, {1, 0, 0}, {0, 0, 0}, 0.0);
  EXPECT_THAT(message({}), HasSubstr("two samples"));
  EXPECT_THAT(message({start}), HasSubstr("two samples"));
  EXPECT_THAT(message({start, start}), HasSubstr("sample 1 of a trajectory is not after"));
  EXPECT_THAT(message({end, start}), HasSubstr("sample 1 of a trajectory is not after"));
  end.velocity_mps.x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(message({start, end}), HasSubstr("not finite"));
  end.velocity_mps.x() = 0.0;
  end.T_map_body.linear() *= 2.0;
  EXPECT_THAT(message({start, end}), HasSubstr("sample 1"));
}

}  // namespace
}  // namespace skyhalo

#include "skyhalo/sim/moving_object.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

namespace skyhalo {
namespace {

using Eigen::Vector3d;

constexpr double kPi = std::numbers::pi;

MovingObject object_on(std::vector<Vector3d> points_m, bool closed) {
  MovingObject object;
  object.size_m = {4.0, 2.0, 1.5};
  object.route = {
      .points_m = std::move(points_m), .speed_mps = 2.0, .start_m = 0.0, .closed = closed};
  return object;
}

MovingObject on_line() {
  return object_on({Vector3d(0.0, 0.0, 0.5), Vector3d(20.0, 0.0, 0.5)}, false);
}

MovingObject on_square() {
  return object_on({Vector3d(0.0, 0.0, 0.0),
                    Vector3d(20.0, 0.0, 0.0),
                    Vector3d(20.0, 20.0, 0.0),
                    Vector3d(0.0, 20.0, 0.0)},
                   true);
}

double yaw_rad(const Pose& T) {
  return std::atan2(T.linear()(1, 0), T.linear()(0, 0));
}

TEST(MovingObjectTest, ItGoesAlongALineThereAndBack) {
  const MovingObject object = on_line();
  const Pose there = T_scene_object(object, 5.0);  // 10 m on
  EXPECT_LT((there.translation() - Vector3d(10.0, 0.0, 0.5)).norm(), 1e-9);
  EXPECT_NEAR(yaw_rad(there), 0.0, 1e-9);
  const Pose back = T_scene_object(object, 12.5);  // 25 m on, 5 m of them back
  EXPECT_LT((back.translation() - Vector3d(15.0, 0.0, 0.5)).norm(), 1e-9);
  EXPECT_NEAR(std::abs(yaw_rad(back)), kPi, 1e-9);
  const Pose again = T_scene_object(object, 25.0);  // 50 m: 10 m on once more
  EXPECT_LT((again.translation() - there.translation()).norm(), 1e-9);
}

TEST(MovingObjectTest, ItTurnsAboutToItsLeftWhereARouteEnds) {
  // At the turning point it is sideways; the mean of the 2 m before and after is 1 m short.
  const Pose turning = T_scene_object(on_line(), 10.0);
  EXPECT_NEAR(yaw_rad(turning), 0.5 * kPi, 1e-9);
  EXPECT_LT((turning.translation() - Vector3d(19.0, 0.0, 0.5)).norm(), 1e-9);
  EXPECT_NEAR(yaw_rad(T_scene_object(on_line(), 20.0)), -0.5 * kPi, 1e-9);
}

TEST(MovingObjectTest, ItRoundsACorner) {
  // At the corner (20, 0): the mean over 2 m before and 2 m after is 0.5 m inside on both axes.
  const Pose corner = T_scene_object(on_square(), 10.0);
  EXPECT_LT((corner.translation() - Vector3d(19.5, 0.5, 0.0)).norm(), 1e-9);
  EXPECT_NEAR(yaw_rad(corner), 0.25 * kPi, 1e-9);
  const Pose after = T_scene_object(on_square(), 12.0);
  EXPECT_LT((after.translation() - Vector3d(20.0, 4.0, 0.0)).norm(), 1e-9);
  EXPECT_NEAR(yaw_rad(after), 0.5 * kPi, 1e-9);
}

TEST(MovingObjectTest, AClosedRouteBeginsAgain) {
  MovingObject object = on_square();
  object.route.start_m = 7.0;
  const Pose first = T_scene_object(object, 1.5);
  EXPECT_LT((first.translation() - Vector3d(10.0, 0.0, 0.0)).norm(), 1e-9);
  EXPECT_TRUE(T_scene_object(object, 41.5).isApprox(first, 1e-9));
  EXPECT_TRUE(T_scene_object(object, -38.5).isApprox(first, 1e-9));
}

TEST(MovingObjectProperty, ItMovesSmoothly) {
  for (const MovingObject& object : {on_line(), on_square()}) {
    Pose before = T_scene_object(object, 0.0);
    for (int i = 1; i < 9000; ++i) {
      const Pose now = T_scene_object(object, 0.01 * i);
      EXPECT_TRUE(is_rotation(now.linear(), 1e-9));
      EXPECT_NEAR(now.linear()(2, 2), 1.0, 1e-12);
      EXPECT_LE((now.translation() - before.translation()).norm(), 0.02 + 1e-9);
      // A turn of half a circle over 4 m, taken 2 cm at a time.
      EXPECT_GT((before.linear().transpose() * now.linear()).trace(), 1.0 + 2.0 * std::cos(0.05));
      before = now;
    }
  }
}

TEST(MovingObjectTest, ItIsTotal) {
  EXPECT_TRUE(T_scene_object(MovingObject(), 1.0).isApprox(Pose::Identity()));
  const MovingObject standing = object_on({Vector3d(3.0, 4.0, 5.0)}, true);
  EXPECT_EQ(T_scene_object(standing, 1.0).translation(), Vector3d(3.0, 4.0, 5.0));
  const MovingObject stuck = object_on({Vector3d(3.0, 4.0, 5.0), Vector3d(3.0, 4.0, 5.0)}, false);
  EXPECT_EQ(T_scene_object(stuck, 1.0).translation(), Vector3d(3.0, 4.0, 5.0));
  for (const double t_s : {std::numeric_limits<double>::quiet_NaN(),
                           std::numeric_limits<double>::infinity(),
                           1e300,
                           -1e12}) {
    EXPECT_TRUE(T_scene_object(on_square(), t_s).matrix().allFinite()) << t_s;
  }
  MovingObject odd = on_line();
  odd.size_m.setConstant(std::numeric_limits<double>::quiet_NaN());
  EXPECT_TRUE(T_scene_object(odd, 3.0).matrix().allFinite());
}

}  // namespace
}  // namespace skyhalo

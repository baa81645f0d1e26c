#include "skyhalo/dataset/scene_object.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <numbers>

#include "support/expect_error.hpp"

namespace skyhalo {
namespace {

using ::testing::HasSubstr;
using testing::message_of;

SceneObject car() {
  SceneObject object{.track = 4, .type = "Car"};
  object.size_m = {4.0, 2.0, 1.5};
  return object;
}

TEST(SceneObjectTest, TheBoxStandsOnTheOriginAndLooksAlongX) {
  // Turned left by a quarter, its length is along y.
  const Pose T = make_pose(
      Eigen::AngleAxisd(std::numbers::pi / 2, Eigen::Vector3d::UnitZ()).toRotationMatrix(),
      {10.0, 20.0, 1.0});
  const OrientedBox box = box_of(car(), T);
  EXPECT_TRUE(contains(box, {10.9, 21.9, 2.4}));
  EXPECT_TRUE(contains(box, {9.1, 18.1, 1.1}));
  EXPECT_FALSE(contains(box, {11.1, 20.0, 2.0}));
  EXPECT_FALSE(contains(box, {10.0, 22.1, 2.0}));
  EXPECT_FALSE(contains(box, {10.0, 20.0, 0.9}));
  EXPECT_FALSE(contains(box, {10.0, 20.0, 2.6}));
}

TEST(SceneObjectTest, WhatIsWrongIsNamed) {
  EXPECT_NO_THROW(check(car(), 3));
  const auto refused = [](const auto& change) {
    SceneObject object = car();
    change(object);
    return message_of([&] { check(object, 3); });
  };
  EXPECT_THAT(refused([](auto& o) { o.track = -1; }),
              HasSubstr("frame 3: object -1: expected a tr"));
  for (const char* const type : {"", "Big car", "Car,Van", "Car\n", "a\tb"}) {
    EXPECT_THAT(refused([&](auto& o) { o.type = type; }), HasSubstr("object 4: expected a type"));
  }
  EXPECT_THAT(refused([](auto& o) { o.size_m.y() = 0.0; }), HasSubstr("above 0 m"));
  EXPECT_THAT(refused([](auto& o) { o.size_m.x() = std::numeric_limits<double>::quiet_NaN(); }),
              HasSubstr("above 0 m"));
  EXPECT_THAT(refused([](auto& o) { o.occluded = 4; }), HasSubstr("occluded: expected 0, 1, 2"));
  EXPECT_THAT(refused([](auto& o) { o.T_map_object.linear() *= 2.0; }), HasSubstr("rigid"));
}

}  // namespace
}  // namespace skyhalo

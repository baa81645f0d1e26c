#include "skyhalo/sim/scene.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <limits>

#include "skyhalo/sim/shapes.hpp"
#include "support/expect_error.hpp"

namespace skyhalo {
namespace {

using Eigen::Vector3d;
using ::testing::HasSubstr;
using testing::message_of;

/// A box that stands and one that moves.
Scene two_boxes() {
  Scene scene;
  scene.name = "boxes";
  scene.materials.resize(1);
  add_box(scene.fixed, {}, {});
  MovingObject mover;
  mover.type = "Car";
  mover.track = 7;
  add_box(mover.mesh, {}, {});
  mover.route.points_m = {Vector3d::Zero(), Vector3d::UnitX()};
  scene.movers.push_back(mover);
  return scene;
}

std::string complaint(const std::function<void(Scene&)>& spoil) {
  Scene scene = two_boxes();
  spoil(scene);
  return message_of([&] { check(scene); });
}

TEST(SceneTest, AGoodOneIsTaken) {
  EXPECT_NO_THROW(check(two_boxes()));
}

TEST(SceneTest, WhatIsWrongInMaterialsIsNamed) {
  EXPECT_EQ(complaint([](Scene& s) { s.materials[0].texture = 0; }),
            "scene \"boxes\": material 0 \"\": there is no texture 0");
  EXPECT_THAT(complaint([](Scene& s) { s.lighting.cloud_texture = 3; }),
              HasSubstr("clouds: there is no texture 3"));
  EXPECT_THAT(complaint([](Scene& s) { s.materials[0].texture_edge_m = 0.0F; }),
              HasSubstr("texture_edge_m"));
  EXPECT_THAT(complaint([](Scene& s) { s.materials[0].mirror = 1.5F; }), HasSubstr("mirror"));
  EXPECT_THAT(complaint([](Scene& s) {
                s.materials[0].colour_bgr.x() = std::numeric_limits<float>::quiet_NaN();
              }),
              HasSubstr("colour"));
}

TEST(SceneTest, WhatIsWrongInMeshesIsNamed) {
  EXPECT_THAT(complaint([](Scene& s) { s.fixed = {}; }),
              HasSubstr("what stands: holds no triangle"));
  EXPECT_THAT(complaint([](Scene& s) { s.fixed.materials[2] = 1; }),
              HasSubstr("what stands: there is no material 1"));
  EXPECT_THAT(complaint([](Scene& s) { s.movers[0].mesh.materials[0] = 9; }),
              HasSubstr("mover 7 (Car): there is no material 9"));
}

TEST(SceneTest, AMoverWithoutAWayIsNamed) {
  EXPECT_THAT(complaint([](Scene& s) { s.movers[0].route.points_m.pop_back(); }),
              HasSubstr("mover 7 (Car): its route needs two different points"));
  EXPECT_THAT(complaint([](Scene& s) { s.movers[0].route.points_m[1].setZero(); }),
              HasSubstr("two different points"));
  EXPECT_THAT(complaint([](Scene& s) { s.movers[0].route.speed_mps = -1.0; }), HasSubstr("speed"));
  EXPECT_THAT(complaint([](Scene& s) { s.movers[0].size_m.z() = 0.0; }), HasSubstr("size"));
}

}  // namespace
}  // namespace skyhalo

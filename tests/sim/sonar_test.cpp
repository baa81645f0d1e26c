#include "skyhalo/sim/sonar.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "support/triangle_soups.hpp"

namespace skyhalo {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

struct SmallBox {
  Vector3f middle_m;
  Vector3f size_m;
};

Scene boxes(const std::vector<SmallBox>& all) {
  Scene scene;
  scene.name = "boxes";
  scene.materials.resize(1);
  for (const SmallBox& box : all) {
    add_box(scene.fixed, {.middle_m = box.middle_m, .size_m = box.size_m, .yaw_rad = 0.0F}, {});
  }
  return scene;
}

/// A wall whose near side is square to x and this far ahead.
SmallBox wall_at(float x_m) {
  return {{x_m + 0.5F, 0.0F, 0.0F}, {1.0F, 40.0F, 40.0F}};
}

SonarConfig quiet() {
  SonarConfig config;
  config.range_sigma_m = 0.0;
  return config;
}

std::optional<double> heard_m(const Scene& scene,
                              const SonarConfig& config,
                              const Pose& T_scene_sonar = Pose::Identity(),
                              std::uint64_t key = 0) {
  const SceneTracer tracer(scene);
  const SceneMoment moment(tracer, {0.0, 0.0});
  return sonar_range_m(moment, T_scene_sonar, key, config);
}

TEST(SonarTest, AWallAheadIsHeardAtItsRange) {
  const std::optional<double> range_m = heard_m(boxes({wall_at(3.0F)}), quiet());
  ASSERT_TRUE(range_m);
  EXPECT_NEAR(*range_m, 3.0, 0.01);
}

TEST(SonarTest, TheNearestOfTwoIsHeard) {
  // A box 0.4 m wide, 2 m ahead and 0.2 m to the side: 6 degrees, within the 15 of the cone.
  const Scene scene = boxes({wall_at(3.0F), {{2.2F, 0.2F, 0.0F}, Vector3f::Constant(0.4F)}});
  const std::optional<double> range_m = heard_m(scene, quiet());
  ASSERT_TRUE(range_m);
  EXPECT_NEAR(*range_m, 2.0, 0.02);
}

TEST(SonarTest, NothingOutsideTheConeIsHeard) {
  // All of the box is seen at more than atan(1 / 2.4) = 22 degrees.
  const SmallBox aside = {{2.2F, 1.2F, 0.0F}, Vector3f::Constant(0.4F)};
  EXPECT_FALSE(heard_m(boxes({aside}), quiet()));
  const SmallBox behind = {{-2.0F, 0.0F, 0.0F}, Vector3f::Constant(0.4F)};
  EXPECT_FALSE(heard_m(boxes({behind}), quiet()));
  SonarConfig wide = quiet();
  wide.half_angle_rad = 0.6;
  const std::optional<double> range_m = heard_m(boxes({aside}), wide);
  ASSERT_TRUE(range_m);
  EXPECT_NEAR(*range_m, std::hypot(2.0, 1.0), 0.05);
}

TEST(SonarTest, NothingBeyondTheRangeIsHeard) {
  EXPECT_FALSE(heard_m(boxes({wall_at(6.2F)}), quiet()));
  EXPECT_TRUE(heard_m(boxes({wall_at(5.8F)}), quiet()));
}

TEST(SonarTest, ItLooksAlongItsOwnAxisFromItsOwnPlace) {
  // At (0, 0, 5), looking down at a slab whose top is 1 m high.
  Scene scene = boxes({{{0.0F, 0.0F, 0.5F}, {20.0F, 20.0F, 1.0F}}});
  const Eigen::AngleAxisd down(0.5 * std::numbers::pi, Vector3d::UnitY());
  SonarConfig config = quiet();
  config.T_body_sonar = make_pose(Eigen::Matrix3d::Identity(), {1.0, 2.0, 3.0});  // not asked for
  const std::optional<double> range_m =
      heard_m(scene, config, make_pose(down.toRotationMatrix(), {0.0, 0.0, 5.0}));
  ASSERT_TRUE(range_m);
  EXPECT_NEAR(*range_m, 4.0, 0.01);
}

TEST(SonarTest, WaterIsHeard) {
  Scene scene = boxes({wall_at(3.0F)});
  scene.materials[0].laser_reflectivity = 0.0F;
  scene.materials[0].mirror = 1.0F;
  EXPECT_TRUE(heard_m(scene, quiet()));
}

TEST(SonarProperty, RangesSpreadAsTold) {
  const Scene scene = boxes({wall_at(3.0F)});
  const SceneTracer tracer(scene);
  const SceneMoment moment(tracer, {0.0, 0.0});
  const SonarConfig config;
  const double middle_m = sonar_range_m(moment, Pose::Identity(), 0, quiet()).value_or(0.0);
  constexpr int kCount = 2000;
  double squares_m2 = 0.0;
  for (std::uint64_t key = 0; key < kCount; ++key) {
    const std::optional<double> range_m = sonar_range_m(moment, Pose::Identity(), key, config);
    ASSERT_TRUE(range_m);
    EXPECT_EQ(sonar_range_m(moment, Pose::Identity(), key, config), range_m);
    squares_m2 += (*range_m - middle_m) * (*range_m - middle_m);
  }
  EXPECT_NEAR(std::sqrt(squares_m2 / kCount), 0.02, 0.0015);
}

}  // namespace
}  // namespace skyhalo

#include "skyhalo/sim/surface_colour.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "reference/naive_ray_tracer.hpp"
#include "support/triangle_soups.hpp"

namespace skyhalo {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

/// A floor of 40 m by 40 m at z = 0 that throws all light back.
Scene white_floor() {
  Scene scene;
  scene.name = "floor";
  scene.materials.resize(1);
  scene.materials[0].colour_bgr.setOnes();
  add_quad(scene.fixed,
           {Vector3f(-20.0F, -20.0F, 0.0F),
            Vector3f(20.0F, -20.0F, 0.0F),
            Vector3f(20.0F, 20.0F, 0.0F),
            Vector3f(-20.0F, 20.0F, 0.0F)},
           {});
  scene.lighting.sun_bgr.setZero();
  scene.lighting.ambient_bgr.setZero();
  return scene;
}

/// What a ray sees.
Vector3f colour_seen(const Scene& scene, const Vector3f& from_m, const Vector3f& to_m) {
  const SceneTracer tracer(scene);
  const SceneMoment moment(tracer, {0.0, 0.0});
  const SurfaceColour colours(tracer);
  const SceneRay ray{from_m, (to_m - from_m).normalized()};
  return colours.of(ray, moment.trace(ray), 1e-3F);
}

void expect_colour(const Vector3f& found, const Vector3f& expected, float tolerance) {
  EXPECT_LT((found - expected).cwiseAbs().maxCoeff(), tolerance)
      << found.transpose() << " instead of " << expected.transpose();
}

TEST(SurfaceColourTest, SunshineGoesWithTheSineOfItsHeight) {
  for (const float height_rad : {0.5F, 1.0F, 1.5F}) {
    Scene scene = white_floor();
    scene.lighting.sun_direction = Vector3f(std::cos(height_rad), 0.0F, std::sin(height_rad));
    scene.lighting.sun_bgr = Vector3f(0.5F, 0.7F, 0.9F);
    expect_colour(colour_seen(scene, {1.0F, 2.0F, 5.0F}, {0.0F, 1.0F, 0.0F}),
                  std::sin(height_rad) * scene.lighting.sun_bgr,
                  1e-3F);
  }
}

TEST(SurfaceColourTest, TheMaterialTakesItsShareOfEachColour) {
  Scene scene = white_floor();
  scene.materials[0].colour_bgr = Vector3f(0.1F, 0.5F, 0.9F);
  scene.lighting.ambient_bgr = Vector3f(0.8F, 0.6F, 0.4F);
  expect_colour(colour_seen(scene, {1.0F, 2.0F, 5.0F}, {0.0F, 1.0F, 0.0F}),
                Vector3f(0.08F, 0.3F, 0.36F),
                1e-4F);
}

TEST(SurfaceColourTest, FromBelowComesHalfTheAmbientLight) {
  Scene scene = white_floor();
  scene.lighting.ambient_bgr = Vector3f(0.8F, 0.6F, 0.4F);
  expect_colour(colour_seen(scene, {1.0F, 2.0F, -5.0F}, {0.0F, 1.0F, 0.0F}),
                Vector3f(0.4F, 0.3F, 0.2F),
                1e-4F);
}

TEST(SurfaceColourTest, ALampFallsOffWithTheSquareOfTheDistance) {
  Scene scene = white_floor();
  scene.lighting.lamps = {
      {.position_m = {0.0F, 0.0F, 2.0F}, .strength_bgr_m2 = {1.0F, 2.0F, 3.0F}}};
  // Straight below: 2 m away. At (2, 0): sqrt(8) m away, met at 45 degrees.
  expect_colour(colour_seen(scene, {1.0F, 0.0F, 5.0F}, {0.0F, 0.0F, 0.0F}),
                Vector3f(0.25F, 0.5F, 0.75F),
                1e-3F);
  expect_colour(colour_seen(scene, {1.0F, 0.0F, 5.0F}, {2.0F, 0.0F, 0.0F}),
                Vector3f(1.0F, 2.0F, 3.0F) / 8.0F * std::sqrt(0.5F),
                1e-3F);
  // The side away from it stays dark.
  expect_colour(
      colour_seen(scene, {1.0F, 0.0F, -5.0F}, {0.0F, 0.0F, 0.0F}), Vector3f::Zero(), 1e-5F);
}

TEST(SurfaceColourTest, TheSkyGoesFromTheHorizonToTheZenith) {
  Scene scene = white_floor();
  scene.lighting.zenith_bgr = Vector3f(0.9F, 0.5F, 0.1F);
  scene.lighting.horizon_bgr = Vector3f(0.3F, 0.4F, 0.5F);
  const SceneTracer tracer(scene);
  const SurfaceColour colours(tracer);
  expect_colour(colours.of_sky(Vector3f::UnitZ(), 1e-3F), scene.lighting.zenith_bgr, 1e-3F);
  expect_colour(colours.of_sky(Vector3f::UnitX(), 1e-3F), scene.lighting.horizon_bgr, 1e-3F);
  const SceneMoment moment(tracer, {0.0, 0.0});
  const SceneRay up{Vector3f(0.0F, 0.0F, 1.0F), Vector3f::UnitZ()};
  expect_colour(colours.of(up, moment.trace(up), 1e-3F), scene.lighting.zenith_bgr, 1e-3F);
}

/// A roof of 6 m by 6 m, 3 m above the floor, and a sun at 45 degrees along x.
Scene floor_and_roof() {
  Scene scene = white_floor();
  scene.lighting.sun_direction = Vector3f(1.0F, 0.0F, 1.0F).normalized();
  scene.lighting.sun_bgr.setOnes();
  add_quad(scene.fixed,
           {Vector3f(-3.0F, -3.0F, 3.0F),
            Vector3f(3.0F, -3.0F, 3.0F),
            Vector3f(3.0F, 3.0F, 3.0F),
            Vector3f(-3.0F, 3.0F, 3.0F)},
           {});
  return scene;
}

TEST(SunShadowsTest, ARoofThrowsItsShadowAwayFromTheSun) {
  const Scene scene = floor_and_roof();
  const SceneTracer tracer(scene);
  const SunShadows shadows(tracer);
  const auto light = [&](float x_m, float y_m, float z_m) {
    return shadows.light({x_m, y_m, z_m}, Vector3f::UnitZ());
  };
  // On the floor the shadow reaches from x = -6 to 0 and y = -3 to 3.
  EXPECT_EQ(light(-3.0F, 0.0F, 0.0F), 0.0F);
  EXPECT_EQ(light(-5.5F, 2.5F, 0.0F), 0.0F);
  EXPECT_EQ(light(-0.5F, -2.5F, 0.0F), 0.0F);
  EXPECT_EQ(light(0.5F, 0.0F, 0.0F), 1.0F);
  EXPECT_EQ(light(-6.5F, 0.0F, 0.0F), 1.0F);
  EXPECT_EQ(light(-3.0F, 3.5F, 0.0F), 1.0F);
  EXPECT_EQ(light(0.0F, 0.0F, 3.0F), 1.0F);  // on the roof
}

TEST(SunShadowsTest, WithoutASunAllIsInTheLight) {
  Scene scene = floor_and_roof();
  scene.lighting.sun_bgr.setZero();
  const SceneTracer tracer(scene);
  EXPECT_EQ(SunShadows(tracer).light({-3.0F, 0.0F, 0.0F}, Vector3f::UnitZ()), 1.0F);
}

TEST(SurfaceColourTest, AShadowLeavesTheAmbientLight) {
  Scene scene = floor_and_roof();
  scene.lighting.ambient_bgr.setConstant(0.25F);
  expect_colour(colour_seen(scene, {-9.0F, 0.0F, 2.0F}, {-3.0F, 0.0F, 0.0F}),
                Vector3f::Constant(0.25F),
                1e-3F);
  expect_colour(colour_seen(scene, {9.0F, 0.0F, 2.0F}, {3.0F, 0.0F, 0.0F}),
                Vector3f::Constant(0.25F + std::sqrt(0.5F)),
                1e-3F);
}

TEST(SunShadowsReference, RaysTowardsTheSunAgree) {
  // Boxes on a floor: away from shadows' edges the picture must say what a ray to the sun does.
  std::mt19937 rng(97);
  Scene scene = white_floor();
  scene.lighting.sun_bgr.setOnes();
  scene.lighting.sun_direction = Vector3f(0.4F, 0.3F, 0.87F).normalized();
  for (int i = 0; i < 12; ++i) {
    const Vector3f middle_m = testing::random_point_m(rng, 8.0).cast<float>();
    add_box(scene.fixed,
            {.middle_m = {middle_m.x(), middle_m.y(), 1.5F}, .size_m = {2.0F, 1.0F, 3.0F}},
            {});
  }
  const SceneTracer tracer(scene);
  const SunShadows shadows(tracer);
  const auto triangles = reference::naive_triangles(scene, {0.0, 0.0}, 0.0);
  const Vector3d to_sun = scene.lighting.sun_direction.cast<double>();
  int dark = 0;
  int bright = 0;
  for (int i = 0; i < 1500; ++i) {
    Vector3d point_m = testing::random_point_m(rng, 10.0);
    point_m.z() = 0.0;
    int hidden = 0;
    for (int k = 0; k < 9; ++k) {  // the point and a square of 0.3 m about it
      const Vector3d from_m = point_m + Vector3d(0.15 * (k % 3 - 1), 0.15 * (k / 3 - 1), 1e-4);
      hidden += std::isfinite(reference::naive_trace(triangles, from_m, to_sun).range_m) ? 1 : 0;
    }
    const float light = shadows.light(point_m.cast<float>(), Vector3f::UnitZ());
    if (hidden == 9) {
      EXPECT_EQ(light, 0.0F) << point_m.transpose();
      ++dark;
    } else if (hidden == 0) {
      EXPECT_EQ(light, 1.0F) << point_m.transpose();
      ++bright;
    }
  }
  EXPECT_GT(dark, 50);
  EXPECT_GT(bright, 500);
}

}  // namespace
}  // namespace skyhalo

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "reference/naive_ray_tracer.hpp"
#include "reference/naive_surface_distance.hpp"
#include "skyhalo/sim/scene_tracer.hpp"
#include "support/triangle_soups.hpp"

namespace skyhalo {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;
using reference::naive_surface_distance_m;
using reference::naive_trace;
using reference::naive_triangles;
using reference::NaiveHit;
using reference::NaiveTriangle;
using testing::random_direction;
using testing::random_point_m;
using testing::random_scene;
using testing::random_soup;

/// So close (as a weight) to an edge, either answer is right.
constexpr double kEdge = 1e-4;

Eigen::Vector3d corner_sum(const NaiveTriangle& triangle, double b, double c) {
  return (1.0 - b - c) * triangle.corners_m[0] + b * triangle.corners_m[1] +
         c * triangle.corners_m[2];
}

/// Compares one hit in full; returns false for a ray that is too close to an edge to tell.
bool expect_same(const SceneRay& ray, const SceneHit& fast, const NaiveHit& naive) {
  if (naive.edge_distance < kEdge) {
    return false;
  }
  if (std::isinf(naive.range_m)) {
    EXPECT_EQ(fast.object, SceneHit::kNothing);
    EXPECT_TRUE(std::isinf(fast.range_m));
    return true;
  }
  EXPECT_NEAR(fast.range_m, naive.range_m, 1e-4 * naive.range_m + 2e-6 / naive.incidence);
  if (naive.next_range_m - naive.range_m < 1e-3) {
    return true;  // a tie: either triangle
  }
  EXPECT_EQ(fast.object, naive.triangle.object);
  EXPECT_EQ(fast.triangle, naive.triangle.index);
  const Vector3d fast_m = corner_sum(naive.triangle, fast.b, fast.c);
  const Vector3d naive_m = corner_sum(naive.triangle, naive.crossing.b, naive.crossing.c);
  EXPECT_LT((fast_m - naive_m).norm(), 1e-4 + 2e-6 / naive.incidence);
  EXPECT_NEAR(fast.normal.norm(), 1.0, 1e-5);
  EXPECT_LE(fast.normal.dot(ray.direction), 1e-6F);
  EXPECT_LT((fast.normal.cast<double>() - naive.normal).norm(), 1e-3);
  return true;
}

/// A mover with a soup of its own that goes straight along x through the middle of the scene.
MovingObject straight_mover(std::mt19937& rng, double side_m) {
  MovingObject mover;
  mover.type = "Car";
  mover.mesh = random_soup(rng, 12, 1.0, 1.0);
  mover.route.points_m = {Vector3d(-50.0, side_m, 0.3), Vector3d(50.0, side_m, 0.3)};
  mover.route.speed_mps = 10.0;
  mover.route.start_m = 49.0;
  return mover;
}

TEST(SceneTracerReference, RandomRaysMeetTheSameAsTriangleByTriangle) {
  std::mt19937 rng(3);
  int compared = 0;
  int met = 0;
  for (std::uint32_t seed = 0; seed < 4; ++seed) {
    const Scene scene = random_scene(seed, seed < 2 ? 40 : 300, 6.0, seed % 2 == 0 ? 2.0 : 0.7);
    const SceneTracer tracer(scene);
    const SceneMoment moment(tracer, {0.0, 0.0});
    const std::vector<NaiveTriangle> triangles = naive_triangles(scene, moment.span(), 0.0);
    for (int i = 0; i < 500; ++i) {
      const SceneRay ray{.origin_m = random_point_m(rng, 8.0).cast<float>(),
                         .direction = random_direction(rng).cast<float>()};
      const NaiveHit naive =
          naive_trace(triangles, ray.origin_m.cast<double>(), ray.direction.cast<double>());
      compared += expect_same(ray, moment.trace(ray), naive) ? 1 : 0;
      met += std::isfinite(naive.range_m) ? 1 : 0;
    }
  }
  EXPECT_GT(compared, 1900);
  EXPECT_GT(met, 250);
}

TEST(SceneTracerReference, MoversAreWhereTheirRaysTimeHasThem) {
  std::mt19937 rng(5);
  Scene scene = random_scene(11, 30, 6.0, 1.0);
  scene.movers = {straight_mover(rng, -1.0), straight_mover(rng, 1.5)};
  scene.movers[1].route.speed_mps = 4.0;
  const SceneTracer tracer(scene);
  const SceneMoment moment(tracer, {0.0, 0.2});
  int movers_met = 0;
  int compared = 0;
  for (int i = 0; i < 1000; ++i) {
    const float time = static_cast<float>(i % 21) / 20.0F;
    const SceneRay ray{.origin_m = random_point_m(rng, 6.0).cast<float>(),
                       .direction = random_direction(rng).cast<float>(),
                       .time = time};
    const NaiveHit naive = naive_trace(naive_triangles(scene, moment.span(), time),
                                       ray.origin_m.cast<double>(),
                                       ray.direction.cast<double>());
    compared += expect_same(ray, moment.trace(ray), naive) ? 1 : 0;
    movers_met += naive.triangle.object > 0 ? 1 : 0;
  }
  EXPECT_GT(compared, 950);
  EXPECT_GT(movers_met, 20);
}

TEST(SceneTracerReference, ManyRaysAtOnceGiveWhatSingleOnesDo) {
  std::mt19937 rng(7);
  Scene scene = random_scene(12, 60, 6.0, 1.5);
  scene.movers = {straight_mover(rng, 0.0)};
  const SceneTracer tracer(scene);
  const SceneMoment moment(tracer, {0.0, 0.1});
  for (const std::size_t count : {1U, 3U, 4U, 7U, 8U, 16U, 37U, 257U}) {
    std::vector<SceneRay> rays(count);
    for (SceneRay& ray : rays) {
      ray = {.origin_m = random_point_m(rng, 6.0).cast<float>(),
             .direction = random_direction(rng).cast<float>(),
             .time = 0.25F};
    }
    rays[count / 2].direction.setZero();
    std::vector<SceneHit> hits(count);
    moment.trace(rays, hits, 9.0F);
    for (std::size_t i = 0; i < count; ++i) {
      const NaiveHit naive = naive_trace(naive_triangles(scene, moment.span(), 0.25),
                                         rays[i].origin_m.cast<double>(),
                                         rays[i].direction.cast<double>(),
                                         9.0);
      const bool near_end = std::abs(naive.range_m - 9.0) < 1e-3;
      if (!near_end) {
        expect_same(rays[i], hits[i], naive);
      }
    }
  }
}

TEST(SceneTracerReference, RangesEndAtTheirMost) {
  std::mt19937 rng(9);
  const Scene scene = random_scene(13, 80, 6.0, 1.5);
  const SceneTracer tracer(scene);
  const SceneMoment moment(tracer, {0.0, 0.0});
  const std::vector<NaiveTriangle> triangles = naive_triangles(scene, moment.span(), 0.0);
  int cut_off = 0;
  for (int i = 0; i < 500; ++i) {
    const SceneRay ray{.origin_m = random_point_m(rng, 6.0).cast<float>(),
                       .direction = random_direction(rng).cast<float>()};
    const Vector3d origin_m = ray.origin_m.cast<double>();
    const Vector3d direction = ray.direction.cast<double>();
    const NaiveHit whole = naive_trace(triangles, origin_m, direction);
    if (std::abs(whole.range_m - 2.0) > 1e-3) {
      expect_same(ray, moment.trace(ray, 2.0F), naive_trace(triangles, origin_m, direction, 2.0));
      cut_off += whole.range_m > 2.0 && std::isfinite(whole.range_m) ? 1 : 0;
    }
  }
  EXPECT_GT(cut_off, 40);
}

TEST(SceneTracerTest, ARayWithoutDirectionMeetsNothing) {
  const Scene scene = testing::room_scene(Vector3f::Zero(), Vector3f::Constant(2.0F));
  const SceneTracer tracer(scene);
  const SceneMoment moment(tracer, {0.0, 0.0});
  for (const Vector3f& origin_m :
       {Vector3f(0.0F, 0.0F, 0.0F), Vector3f(1.0F, 0.2F, 0.3F), Vector3f(9.0F, 0.0F, 0.0F)}) {
    const SceneHit hit = moment.trace(SceneRay{origin_m, Vector3f::Zero()});
    EXPECT_EQ(hit.object, SceneHit::kNothing);
    EXPECT_TRUE(std::isinf(hit.range_m));
  }
}

TEST(SceneTracerTest, AMoversBoxIsMetWhereItIs) {
  // A cube of 1 m goes along x from -1 to 1 while a ray looks down at x = 0.5: it is below
  // from 0.5 s on, with its top at 1 m; before, the ray meets the fixed box, whose top is at -4.5
  // m.
  Scene scene;
  scene.name = "cube";
  scene.materials.resize(1);
  add_box(scene.fixed, {.middle_m = {0.0F, 0.0F, -5.0F}}, {});
  MovingObject mover;
  add_box(mover.mesh, {.middle_m = {0.0F, 0.0F, 0.5F}}, {});
  mover.size_m.setConstant(1.0);
  mover.route.points_m = {Vector3d(-50.0, 0.0, 0.0), Vector3d(50.0, 0.0, 0.0)};
  mover.route.speed_mps = 2.0;
  mover.route.start_m = 49.0;
  scene.movers = {mover};
  const SceneTracer tracer(scene);
  const SceneMoment moment(tracer, {0.0, 1.0});
  const auto at = [&](float time) {
    return moment.trace(SceneRay{Vector3f(0.5F, 0.1F, 3.0F), -Vector3f::UnitZ(), time});
  };
  EXPECT_EQ(at(0.4F).object, SceneHit::kFixed);
  EXPECT_NEAR(at(0.4F).range_m, 7.5, 1e-5);
  EXPECT_EQ(at(0.6F).object, 1U);
  EXPECT_NEAR(at(0.6F).range_m, 2.0, 1e-5);
  EXPECT_LT((at(0.9F).normal - Vector3f::UnitZ()).norm(), 1e-5F);
}

TEST(SceneTracerReference, ClearanceIsThatToTheNearestTriangle) {
  std::mt19937 rng(15);
  int beyond = 0;
  for (const std::uint32_t seed : {21U, 22U}) {
    Scene scene = random_scene(seed, seed == 21U ? 20 : 400, 6.0, 1.0);
    scene.movers = {straight_mover(rng, 0.0)};  // must not count
    const SceneTracer tracer(scene);
    std::vector<NaiveTriangle> triangles;
    reference::append_naive_triangles(
        triangles, scene.fixed, 0, {Pose::Identity(), Pose::Identity()}, 0.0);
    for (int i = 0; i < 400; ++i) {
      const Vector3d point_m = random_point_m(rng, 10.0);
      const double naive_m = naive_surface_distance_m(point_m, triangles);
      const double fast_m = tracer.clearance_m(point_m, 2.0);
      if (std::abs(naive_m - 2.0) < 1e-4) {
        continue;
      }
      if (naive_m > 2.0) {
        EXPECT_TRUE(std::isinf(fast_m));
        ++beyond;
      } else {
        EXPECT_NEAR(fast_m, naive_m, 1e-5);
      }
      EXPECT_NEAR(tracer.clearance_m(point_m, 100.0), naive_m, 1e-5);
    }
  }
  EXPECT_GT(beyond, 100);
}

}  // namespace
}  // namespace skyhalo

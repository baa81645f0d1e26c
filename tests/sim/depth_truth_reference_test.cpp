#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "reference/naive_ray_tracer.hpp"
#include "skyhalo/sim/depth_truth.hpp"
#include "support/triangle_soups.hpp"

namespace skyhalo {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;
using reference::naive_trace;
using reference::naive_triangles;
using reference::NaiveHit;
using reference::NaiveTriangle;
using testing::random_scene;

constexpr PinholePair kPinhole{40.0, 29.5, 21.0, 0.4, 0.0};
constexpr PinholePair kOffsetPinhole{40.0, 29.5, 21.0, 0.4, 3.25};
constexpr SphericalPair kSpherical{0.045, 0.05, 30.5, 22.0, 0.4};
const cv::Size kSizePx(64, 44);

struct Looked {
  int met = 0;
  int nothing = 0;
  int seen = 0;
  int hidden = 0;
};

/// Whether the left camera sees a point (m, `cam`) that the right one sees; -1 where that hangs by
/// a hair: at its image's edge, at a triangle's edge or where two surfaces nearly touch.
int naive_both(const std::vector<NaiveTriangle>& triangles,
               const Pose& T_scene_camera,
               const PairModel& pair,
               const Vector3d& point_camera_m) {
  const Vector3d pixel = project(pair, point_camera_m);
  const double left_u_px = pixel.x() + pixel.z();
  const double last_u_px = kSizePx.width - 1.0;
  if (left_u_px > last_u_px + 0.6 || left_u_px < -0.6) {
    return 0;
  }
  const bool at_side = left_u_px > last_u_px - 0.1 || left_u_px < 0.1;
  const Vector3d left_m = T_scene_camera * Vector3d(-baseline_m(pair), 0.0, 0.0);
  const Vector3d to_m = T_scene_camera * point_camera_m;
  const double range_m = (to_m - left_m).norm();
  const NaiveHit hit = naive_trace(triangles, left_m, (to_m - left_m) / range_m);
  if (hit.edge_distance < 0.02 || hit.incidence < 0.05 || at_side) {
    return -1;
  }
  if (std::abs(hit.range_m - range_m) < 1e-6) {
    return 1;
  }
  return range_m - hit.range_m < 0.15 ? -1 : 0;
}

void expect_pixel(const DepthTruth& truth,
                  const PairModel& pair,
                  const Pose& T_scene_camera,
                  const std::vector<NaiveTriangle>& triangles,
                  const cv::Point& at,
                  Looked& looked) {
  const Vector3d ray_camera = ray_of(pair, at.x, at.y);
  const NaiveHit hit =
      naive_trace(triangles, T_scene_camera.translation(), T_scene_camera.linear() * ray_camera);
  if (hit.edge_distance < 1e-3 || hit.incidence < 0.02) {
    return;
  }
  const std::string where = "pixel " + std::to_string(at.x) + ", " + std::to_string(at.y);
  if (std::isinf(hit.range_m)) {
    EXPECT_TRUE(std::isinf(truth.range_m(at))) << where;
    EXPECT_TRUE(std::isnan(truth.disparity_px(at))) << where;
    EXPECT_EQ(truth.both(at), 0) << where;
    ++looked.nothing;
    return;
  }
  ++looked.met;
  const Vector3d point_m = hit.range_m * ray_camera;
  const double disparity_px = project(pair, point_m).z();
  const double tolerance = 1e-4 + 1e-5 / hit.incidence;
  EXPECT_NEAR(truth.range_m(at), hit.range_m, tolerance * hit.range_m) << where;
  EXPECT_NEAR(truth.disparity_px(at), disparity_px, tolerance * (disparity_px + 5.0)) << where;
  const int both = naive_both(triangles, T_scene_camera, pair, point_m);
  if (both >= 0) {
    EXPECT_EQ(truth.both(at), both == 1 ? 255 : 0) << where << " at " << hit.range_m << " m";
    ++(both == 1 ? looked.seen : looked.hidden);
  }
}

void expect_truth(const PairModel& pair, int hidden) {
  std::mt19937 rng(41);
  Looked looked;
  for (std::uint32_t seed = 50; seed < 53; ++seed) {
    const Scene scene = random_scene(seed, 60, 5.0, 2.0);
    const SceneTracer tracer(scene);
    const SceneMoment moment(tracer, {0.0, 0.0});
    const Eigen::Matrix3d turn = testing::random_rotation(rng);
    const Pose T_scene_camera = make_pose(turn, testing::random_point_m(rng, 2.0));
    const DepthTruth truth = depth_truth(moment, pair, kSizePx, T_scene_camera);
    ASSERT_EQ(truth.range_m.size(), kSizePx);
    ASSERT_EQ(truth.disparity_px.size(), kSizePx);
    ASSERT_EQ(truth.both.size(), kSizePx);
    const std::vector<NaiveTriangle> triangles = naive_triangles(scene, moment.span(), 0.0);
    for (int v = 0; v < kSizePx.height; ++v) {
      for (int u = 0; u < kSizePx.width; ++u) {
        expect_pixel(truth, pair, T_scene_camera, triangles, {u, v}, looked);
      }
    }
  }
  EXPECT_GT(looked.met, 2000);
  EXPECT_GT(looked.seen, 1000);
  EXPECT_GT(looked.hidden, hidden / 3);
}

TEST(DepthTruthReference, PinholePairLooksAtASoup) {
  expect_truth(kPinhole, 100);
}

TEST(DepthTruthReference, PinholePairWithAnOffsetLooksAtASoup) {
  expect_truth(kOffsetPinhole, 100);
}

TEST(DepthTruthReference, SphericalPairLooksAtASoup) {
  expect_truth(kSpherical, 30);
}

/// A wall of 200 m by 200 m square to x, this far ahead of the origin.
Scene wall_at(float x_m) {
  Scene scene;
  scene.name = "wall";
  scene.materials.resize(1);
  add_quad(scene.fixed,
           {Vector3f(x_m, 100.0F, -100.0F),
            Vector3f(x_m, -100.0F, -100.0F),
            Vector3f(x_m, -100.0F, 100.0F),
            Vector3f(x_m, 100.0F, 100.0F)},
           {});
  return scene;
}

/// A camera at the origin that looks along x.
Pose ahead() {
  Eigen::Matrix3d R;
  R << 0.0, 0.0, 1.0, -1.0, 0.0, 0.0, 0.0, -1.0, 0.0;
  return make_pose(R, Vector3d::Zero());
}

TEST(DepthTruthTest, AWallHasOneDisparity) {
  const Scene scene = wall_at(5.0F);
  const SceneTracer tracer(scene);
  const SceneMoment moment(tracer, {0.0, 0.0});
  const DepthTruth truth = depth_truth(moment, kPinhole, kSizePx, ahead());
  const DepthTruth offset = depth_truth(moment, kOffsetPinhole, kSizePx, ahead());
  for (int v = 0; v < kSizePx.height; ++v) {
    for (int u = 0; u < kSizePx.width; ++u) {
      EXPECT_NEAR(truth.disparity_px(v, u), 40.0 * 0.4 / 5.0, 1e-4);  // f B / z = 3.2
      EXPECT_NEAR(offset.disparity_px(v, u), 3.2 - 3.25, 1e-4);
      const double u_m = (u - 29.5) / 40.0 * 5.0;
      const double v_m = (v - 21.0) / 40.0 * 5.0;
      EXPECT_NEAR(truth.range_m(v, u), std::sqrt(25.0 + u_m * u_m + v_m * v_m), 1e-3);
      if (u <= 59) {
        EXPECT_EQ(truth.both(v, u), 255);
      } else if (u >= 61) {  // 61 + 3.2 is beyond column 63
        EXPECT_EQ(truth.both(v, u), 0);
      }
    }
  }
}

TEST(DepthTruthTest, AWallsSphericalDisparityIsTheAngleBetweenTheRays) {
  const Scene scene = wall_at(5.0F);
  const SceneTracer tracer(scene);
  const SceneMoment moment(tracer, {0.0, 0.0});
  const DepthTruth truth = depth_truth(moment, kSpherical, kSizePx, ahead());
  // Row 22 lies in the plane of z: a right ray at alpha meets (5 tan alpha, 5), which the left
  // camera, 0.4 m to the left, sees at atan((5 tan alpha + 0.4) / 5).
  for (int u = 5; u < 57; ++u) {
    const double alpha = (u - 30.5) * 0.045;
    const double left_alpha = std::atan(std::tan(alpha) + 0.08);
    EXPECT_NEAR(truth.disparity_px(22, u), (left_alpha - alpha) / 0.045, 1e-3);
    EXPECT_NEAR(truth.range_m(22, u), 5.0 / std::cos(alpha), 1e-2);
  }
}

TEST(DepthTruthTest, WhatIsLeftOfTheLeftImageIsSeenByOneCamera) {
  // f B / z - offset = 3.2 - 10 = -6.8: column 6 would be at -0.8 of the left image, 7 is at 0.2.
  const PinholePair pair{40.0, 29.5, 21.0, 0.4, 10.0};
  const Scene scene = wall_at(5.0F);
  const SceneTracer tracer(scene);
  const SceneMoment moment(tracer, {0.0, 0.0});
  const DepthTruth truth = depth_truth(moment, pair, kSizePx, ahead());
  for (int u = 0; u < kSizePx.width; ++u) {
    EXPECT_NEAR(truth.disparity_px(21, u), -6.8, 1e-4);
    EXPECT_EQ(truth.both(21, u), u <= 6 ? 0 : 255) << u;
  }
}

TEST(DepthTruthTest, APixelBeyondAQuarterTurnHasNoRay) {
  // Column 0 looks 1.8 rad to the side, which is no direction of a spherical pair.
  const SphericalPair wide{0.06, 0.05, 30.0, 22.0, 0.4};
  const Scene scene = testing::room_scene(Vector3f::Zero(), Vector3f::Constant(10.0F));
  const SceneTracer tracer(scene);
  const SceneMoment moment(tracer, {0.0, 0.0});
  const DepthTruth truth = depth_truth(moment, wide, {61, 44}, ahead());
  EXPECT_TRUE(std::isnan(truth.disparity_px(22, 0)));
  EXPECT_TRUE(std::isnan(truth.disparity_px(22, 60)));
  EXPECT_TRUE(std::isfinite(truth.disparity_px(22, 30)));
  EXPECT_NEAR(truth.range_m(22, 30), 5.0, 1e-3);
  EXPECT_EQ(truth.both(22, 0), 0);
}

TEST(DepthTruthTest, ANearPostHidesTheWallFromTheLeftCamera) {
  // A board 1 m wide, 2 m ahead in the middle of a wall at 5 m. f = 40: the right camera sees the
  // board from column 29.5 - 10 to 29.5 + 10; the left one sees it 8 px further right, the wall
  // 3.2 px. So of the wall beside the board, the left camera misses 4.8 columns on its right.
  Scene scene = wall_at(5.0F);
  add_quad(scene.fixed,
           {Vector3f(2.0F, 0.5F, -9.0F),
            Vector3f(2.0F, -0.5F, -9.0F),
            Vector3f(2.0F, -0.5F, 9.0F),
            Vector3f(2.0F, 0.5F, 9.0F)},
           {});
  const SceneTracer tracer(scene);
  const SceneMoment moment(tracer, {0.0, 0.0});
  const DepthTruth truth = depth_truth(moment, kPinhole, kSizePx, ahead());
  for (int v = 0; v < kSizePx.height; ++v) {
    EXPECT_EQ(truth.both(v, 19), 255);  // wall left of the board
    EXPECT_EQ(truth.both(v, 20), 255);  // board
    EXPECT_EQ(truth.both(v, 39), 255);
    EXPECT_EQ(truth.both(v, 40), 0);  // wall right of it
    EXPECT_EQ(truth.both(v, 44), 0);  // 44 + 3.2 is still in the board's 27.5...47.5
    EXPECT_EQ(truth.both(v, 45), 255);
    EXPECT_NEAR(truth.disparity_px(v, 30), 8.0, 1e-3);
  }
}

}  // namespace
}  // namespace skyhalo

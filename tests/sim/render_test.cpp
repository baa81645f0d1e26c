#include "skyhalo/sim/render.hpp"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/core.hpp>
#include <optional>
#include <random>

#include "support/triangle_soups.hpp"

namespace skyhalo {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

/// No noise, no blur, no vignetting, and so short an exposure that nothing moves.
CameraLook plain_look() {
  CameraLook look;
  look.exposure_s = 1e-6;
  look.vignetting = 0.0;
  look.blur_px = 0.0;
  look.white_electrons = 0.0;
  look.read_electrons = 0.0;
  return look;
}

/// White light from everywhere and no sun.
Lighting soft_light() {
  Lighting light;
  light.sun_bgr.setZero();
  light.ambient_bgr.setOnes();
  return light;
}

/// The walls of a room of 8 m about the origin: what they throw back is their place, one of six
/// colours made of full and missing channels.
const std::array<Vector3f, 6> kWalls = {Vector3f::UnitX(),
                                        -Vector3f::UnitX(),
                                        Vector3f::UnitY(),
                                        -Vector3f::UnitY(),
                                        Vector3f::UnitZ(),
                                        -Vector3f::UnitZ()};
const std::array<Vector3f, 6> kColours = {Vector3f(1.0F, 0.0F, 0.0F),
                                          Vector3f(0.0F, 1.0F, 0.0F),
                                          Vector3f(0.0F, 0.0F, 1.0F),
                                          Vector3f(1.0F, 1.0F, 0.0F),
                                          Vector3f(1.0F, 0.0F, 1.0F),
                                          Vector3f(0.0F, 1.0F, 1.0F)};

Scene coloured_room() {
  Scene scene;
  scene.name = "room";
  scene.lighting = soft_light();
  for (std::size_t i = 0; i < 6; ++i) {
    scene.materials.emplace_back();
    scene.materials.back().colour_bgr = kColours[i];
    const Vector3f across = kWalls[(i + 2) % 6].cwiseAbs();
    const Vector3f other = kWalls[i].cross(across);
    add_quad(scene.fixed,
             {4.0F * (kWalls[i] - across - other),
              4.0F * (kWalls[i] + across - other),
              4.0F * (kWalls[i] + across + other),
              4.0F * (kWalls[i] - across + other)},
             {.material = static_cast<std::uint16_t>(i)});
  }
  return scene;
}

CameraShot shot_from(const Pose& T_scene_camera) {
  CameraShot shot;
  shot.T_scene_camera = [T_scene_camera](double) { return T_scene_camera; };
  return shot;
}

/// One picture of a scene at the time of the shot.
cv::Mat3b picture_of(const Scene& scene,
                     const RawCamera& camera,
                     const CameraShot& shot,
                     const CameraLook& look) {
  const SceneTracer tracer(scene);
  const SceneMoment moment(tracer, exposed_span(camera.size_px.height, shot, look));
  return render(moment, SurfaceColour(tracer), CameraRays(camera), shot, look);
}

/// Whether a pixel has the wall's full channels and none of its missing ones.
void expect_wall(const cv::Vec3b& pixel, std::size_t wall) {
  for (int channel = 0; channel < 3; ++channel) {
    if (kColours[wall][channel] > 0.5F) {
      EXPECT_GT(pixel[channel], 80) << "wall " << wall << " channel " << channel;
    } else {
      EXPECT_LT(pixel[channel], 3) << "wall " << wall << " channel " << channel;
    }
  }
}

/// Looks for the middle of each wall where the lens has it; the number of walls in the picture.
int walls_seen(const RawCamera& camera, const Pose& T_scene_camera) {
  const cv::Mat3b picture =
      picture_of(coloured_room(), camera, shot_from(T_scene_camera), plain_look());
  EXPECT_EQ(picture.size(), camera.size_px);
  int seen = 0;
  for (std::size_t i = 0; i < 6; ++i) {
    const Vector3d middle_camera = T_scene_camera.inverse() * (4.0 * kWalls[i].cast<double>());
    const double angle_rad = std::acos(middle_camera.normalized().z());
    if (sees(camera, middle_camera) && angle_rad < max_angle_rad(camera.lens) - 0.15) {
      const Eigen::Vector2d pixel = project(camera.lens, middle_camera).value();
      expect_wall(picture(static_cast<int>(std::lround(pixel.y())),
                          static_cast<int>(std::lround(pixel.x()))),
                  i);
      ++seen;
    }
  }
  return seen;
}

/// A camera at a place that looks along x, with z up.
Pose looking_ahead(const Vector3d& place_m) {
  Eigen::Matrix3d R;
  R << 0.0, 0.0, 1.0, -1.0, 0.0, 0.0, 0.0, -1.0, 0.0;
  return make_pose(R, place_m);
}

RawCamera pinhole(const cv::Size& size_px, double focal_px) {
  return {size_px,
          RadialTangentialLens(
              {focal_px, focal_px, 0.5 * (size_px.width - 1), 0.5 * (size_px.height - 1)}, {})};
}

TEST(RenderTest, APinholeShowsEachWallInItsPlace) {
  std::mt19937 rng(71);
  const RawCamera camera = pinhole({96, 72}, 50.0);
  EXPECT_EQ(walls_seen(camera, looking_ahead(Vector3d::Zero())), 1);
  int seen = 0;
  for (int i = 0; i < 20; ++i) {
    seen += walls_seen(camera,
                       make_pose(testing::random_rotation(rng), testing::random_point_m(rng, 1.0)));
  }
  EXPECT_GT(seen, 10);
}

/// A fisheye whose image circle, of 179 degrees to each side, ends 42.8 px from the middle: inside
/// the picture.
RawCamera fisheye() {
  return {{96, 96}, KannalaBrandtLens({17.0, 17.0, 47.5, 47.5}, {-0.02, 0.0, 0.0, 0.0})};
}

TEST(RenderTest, AFisheyeShowsEachWallInItsPlace) {
  EXPECT_EQ(walls_seen(fisheye(), looking_ahead(Vector3d::Zero())), 5);
  std::mt19937 rng(73);
  for (int i = 0; i < 10; ++i) {
    EXPECT_GE(
        walls_seen(fisheye(),
                   make_pose(testing::random_rotation(rng), testing::random_point_m(rng, 1.0))),
        4);
  }
}

TEST(RenderTest, OutsideTheLensItIsBlack) {
  CameraLook look = plain_look();
  look.white_electrons = 6000.0;
  look.read_electrons = 0.0;
  const RawCamera camera = fisheye();
  const cv::Mat3b picture =
      picture_of(coloured_room(), camera, shot_from(looking_ahead(Vector3d::Zero())), look);
  int black = 0;
  for (int v = 0; v < 96; ++v) {
    for (int u = 0; u < 96; ++u) {
      const double radius_px = std::hypot(u - 47.5, v - 47.5);
      const cv::Vec3b& pixel = picture(v, u);
      if (radius_px > 44.5) {
        EXPECT_EQ(pixel, cv::Vec3b(0, 0, 0)) << u << ", " << v;
        ++black;
      } else if (radius_px < 40.5) {
        EXPECT_GT(pixel[0] + pixel[1] + pixel[2], 50) << u << ", " << v;
      }
    }
  }
  EXPECT_GT(black, 1000);
}

TEST(RenderProperty, TheNumberOfThreadsChangesNothing) {
  const RawCamera camera = fisheye();
  CameraShot shot;
  shot.line_time_s = 1e-4;
  shot.T_scene_camera = [](double t_s) { return looking_ahead({5.0 * t_s, 0.1, 0.2}); };
  const auto with_threads = [&](std::size_t count) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, count);
    return picture_of(coloured_room(), camera, shot, CameraLook());
  };
  EXPECT_EQ(cv::norm(with_threads(1), with_threads(2), cv::NORM_INF), 0.0);
}

TEST(RenderTest, ExposureGoesFromTheFirstLightToTheLast) {
  CameraShot shot;
  shot.stamp_s = 3.0;
  shot.line_time_s = 1e-3;
  CameraLook look;
  look.exposure_s = 0.01;
  const TimeSpan span = exposed_span(101, shot, look);
  EXPECT_NEAR(span.begin_s, 3.0 - 0.05 - 0.005, 1e-9);
  EXPECT_NEAR(span.end_s, 3.0 + 0.05 + 0.005, 1e-9);
}

/// Under nothing but a sky of one brightness; its one quad is far behind the camera.
Scene even_sky(float brightness) {
  Scene scene;
  scene.name = "sky";
  scene.materials.resize(1);
  add_quad(scene.fixed,
           {Vector3f(-50.0F, 0.0F, 0.0F),
            Vector3f(-50.0F, 1.0F, 0.0F),
            Vector3f(-50.0F, 1.0F, 1.0F),
            Vector3f(-50.0F, 0.0F, 1.0F)},
           {});
  scene.lighting = soft_light();
  scene.lighting.zenith_bgr.setConstant(brightness);
  scene.lighting.horizon_bgr.setConstant(brightness);
  return scene;
}

cv::Mat3b sky_picture(const CameraLook& look, std::uint64_t key = 0) {
  CameraShot shot = shot_from(looking_ahead(Vector3d::Zero()));
  shot.noise_key = key;
  return picture_of(even_sky(0.5F), pinhole({96, 72}, 80.0), shot, look);
}

TEST(RenderTest, GainIsBrightnessToWhite) {
  for (const double gain : {0.2, 1.0, 1.6, 3.0}) {
    CameraLook look = plain_look();
    look.gain = gain;
    const cv::Vec3b pixel = sky_picture(look)(36, 48);
    EXPECT_NEAR(pixel[0], std::min(255.0, 127.5 * gain), 1.0) << gain;
    EXPECT_NEAR(pixel[2], std::min(255.0, 127.5 * gain), 1.0) << gain;
  }
}

TEST(RenderTest, VignettingTakesItsShareFromTheCorners) {
  CameraLook look = plain_look();
  look.vignetting = 0.4;
  const cv::Mat3b picture = sky_picture(look);
  EXPECT_NEAR(picture(36, 48)[1], 127.5, 1.5);
  for (const cv::Point& corner : {cv::Point(0, 0), cv::Point(95, 0), cv::Point(95, 71)}) {
    EXPECT_NEAR(picture(corner)[1], 0.6 * 127.5, 4.0);
  }
  EXPECT_GT(picture(0, 48)[1], picture(0, 0)[1]);
  EXPECT_LT(picture(0, 48)[1], picture(36, 48)[1]);
}

TEST(RenderProperty, NoiseIsThatOfThePhotonsAndTheReading) {
  for (const double read : {0.0, 60.0}) {
    CameraLook look = plain_look();
    look.white_electrons = 2000.0;
    look.read_electrons = read;
    const cv::Mat3b picture = sky_picture(look);
    cv::Scalar mean;
    cv::Scalar deviation;
    cv::meanStdDev(picture, mean, deviation);
    // Half of white gives 1000 electrons; rounding to whole numbers adds a twelfth.
    const double electrons = std::sqrt(1000.0 + read * read);
    const double expected = std::hypot(electrons / 2000.0 * 255.0, std::sqrt(1.0 / 12.0));
    for (int channel = 0; channel < 3; ++channel) {
      EXPECT_NEAR(mean[channel], 127.5, 0.7);
      EXPECT_NEAR(deviation[channel], expected, 0.05 * expected);
    }
  }
}

TEST(RenderProperty, NeighboursHaveNoiseOfTheirOwn) {
  CameraLook look = plain_look();
  look.white_electrons = 2000.0;
  const cv::Mat3b picture = sky_picture(look);
  double squares = 0.0;
  double products = 0.0;
  for (int v = 1; v < picture.rows; ++v) {
    for (int u = 1; u < picture.cols; ++u) {
      const double here = picture(v, u)[0] - 127.5;
      squares += here * here;
      products += here * (picture(v, u - 1)[0] - 127.5);
      products += here * (picture(v - 1, u)[0] - 127.5);
      products += here * (picture(v, u)[1] - 127.5);
    }
  }
  EXPECT_LT(std::abs(products), 0.1 * squares);
}

TEST(RenderProperty, TheNoiseKeyMakesTheNoise) {
  CameraLook look = plain_look();
  look.white_electrons = 2000.0;
  EXPECT_EQ(cv::norm(sky_picture(look, 1), sky_picture(look, 1), cv::NORM_INF), 0.0);
  const cv::Mat differs = sky_picture(look, 1) != sky_picture(look, 2);
  EXPECT_GT(cv::countNonZero(differs.reshape(1)), 10000);
}

/// A black board 4 m ahead, to the right of the middle, before a white sky.
Scene black_board() {
  Scene scene = even_sky(1.0F);
  scene.materials[0].colour_bgr.setZero();
  add_quad(scene.fixed,
           {Vector3f(4.0F, 0.0F, -20.0F),
            Vector3f(4.0F, -20.0F, -20.0F),
            Vector3f(4.0F, -20.0F, 20.0F),
            Vector3f(4.0F, 0.0F, 20.0F)},
           {});
  return scene;
}

/// A camera of 50 px focal length that goes to its right at this speed before the black board, so
/// that the board's edge goes to the left by 12.5 px per metre.
cv::Mat3b board_picture(double speed_mps, double line_time_s, double exposure_s) {
  CameraLook look = plain_look();
  look.samples = 16;
  look.exposure_s = exposure_s;
  CameraShot shot;
  shot.stamp_s = 1.0;
  shot.line_time_s = line_time_s;
  shot.T_scene_camera = [=](double t_s) {
    return looking_ahead({0.0, -speed_mps * (t_s - 1.0), 0.0});
  };
  return picture_of(black_board(), pinhole({96, 73}, 50.0), shot, look);
}

/// Where the white left of the edge ends in a row, counted from the picture's left side (px).
double edge_px(const cv::Mat3b& picture, int row) {
  double sum = 0.0;
  for (int u = 0; u < picture.cols; ++u) {
    sum += picture(row, u)[1] / 255.0;
  }
  return sum;
}

TEST(RenderTest, ARollingShutterSlantsAnEdge) {
  // 8 m/s and 2.5 ms a row: 0.25 px a row. The middle of the picture is 48 px from its side.
  const cv::Mat3b picture = board_picture(8.0, 2.5e-3, 1e-6);
  for (int row = 0; row < 73; ++row) {
    EXPECT_NEAR(edge_px(picture, row), 48.0 - 0.25 * (row - 36), 0.3) << row;
  }
  EXPECT_NEAR(edge_px(picture, 72) - edge_px(picture, 0), -18.0, 0.4);
}

TEST(RenderTest, AGlobalShutterKeepsAnEdgeUpright) {
  const cv::Mat3b picture = board_picture(8.0, 0.0, 1e-6);
  for (int row = 0; row < 73; ++row) {
    EXPECT_NEAR(edge_px(picture, row), 48.0, 0.3) << row;
  }
}

TEST(RenderTest, ExposureBlursWhatMoves) {
  // 8 m/s for 80 ms: 8 px, half of them on each side of the middle.
  const cv::Mat3b still = board_picture(0.0, 0.0, 0.08);
  const cv::Mat3b moving = board_picture(8.0, 0.0, 0.08);
  for (int row = 0; row < 73; ++row) {
    int still_grey = 0;
    int moving_grey = 0;
    for (int u = 0; u < 96; ++u) {
      still_grey += still(row, u)[1] > 5 && still(row, u)[1] < 250 ? 1 : 0;
      moving_grey += moving(row, u)[1] > 5 && moving(row, u)[1] < 250 ? 1 : 0;
    }
    EXPECT_LE(still_grey, 1);
    EXPECT_GE(moving_grey, 6);
    EXPECT_LE(moving_grey, 10);
    EXPECT_NEAR(edge_px(moving, row), 48.0, 0.7) << row;
    EXPECT_GT(moving(row, 42)[1], 250);
    EXPECT_LT(moving(row, 53)[1], 5);
  }
}

TEST(RenderTest, TheLenssBlurSoftensAnEdge) {
  CameraLook look = plain_look();
  look.samples = 16;
  look.blur_px = 1.5;
  const cv::Mat3b picture = picture_of(
      black_board(), pinhole({96, 73}, 50.0), shot_from(looking_ahead(Vector3d::Zero())), look);
  // An edge at 47.5 under a Gaussian of 1.5 px: at column c, the share of white is that of the
  // normal distribution beyond (c - 47.5) / 1.5.
  for (int u = 43; u <= 52; ++u) {
    const double white = 0.5 * std::erfc((u - 47.5) / 1.5 / std::sqrt(2.0));
    EXPECT_NEAR(picture(36, u)[1] / 255.0, white, 0.04) << u;
  }
}

}  // namespace
}  // namespace skyhalo

// Both sides of raw pairs: what is one place in the scene lies on one row, at the disparity that
// the pair's model says.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "rectify/compared_images.hpp"
#include "rectify/raw_scene.hpp"
#include "skyhalo/rectify/rectifier.hpp"
#include "support/sanitised.hpp"

namespace skyhalo {
namespace {

using testing::centroid;
using testing::RandomRays;
using testing::window_round;

constexpr double kDegree = std::numbers::pi / 180.0;

struct Rig {
  std::string name;
  RawPair raw;
  StereoPair pair;
};

VirtualPairWish wish_of(PairModelKind kind) {
  VirtualPairWish wish{.model = kind, .hfov_rad = 70.0 * kDegree, .size_px = cv::Size(600, 368)};
  if (kind == PairModelKind::kSpherical) {
    wish.vfov_rad = 45.0 * kDegree;
  }
  return wish;
}

/// Pairs of one lens each, and one of two lenses, for both models.
std::vector<Rig> rigs() {
  RandomRays random(11);
  std::vector<testing::ExampleLens> lenses = testing::four_lenses();
  lenses.push_back(lenses.front());
  std::vector<Rig> all;
  for (std::size_t i = 0; i < lenses.size(); ++i) {
    // The last one: EuRoC's lens to the left of a fisheye.
    const testing::ExampleLens& right = i + 1 < lenses.size() ? lenses[i] : lenses[1];
    const RawPair raw = testing::turned_pair(lenses[i], right, random);
    for (const PairModelKind kind : {PairModelKind::kPinhole, PairModelKind::kSpherical}) {
      if (testing::kSanitised && (kind == PairModelKind::kPinhole) != (i % 2 == 0)) {
        continue;  // each lens once and each kind, not all of both
      }
      all.push_back({lenses[i].name + " and " + right.name +
                         (kind == PairModelKind::kPinhole ? " to pinhole" : " to spherical"),
                     raw,
                     testing::stereo_pair(raw, wish_of(kind))});
    }
  }
  return all;
}

/// Pixel of a direction (`cam`) in the rectified image before shrinking.
Eigen::Vector2d pixel_of(const Rig& rig, const Eigen::Vector3d& direction_cam) {
  return project(rig.pair.model, direction_cam).head<2>();
}

/// Points of light (m, `cam`), spread over the field so that no two come close in an image.
std::vector<Eigen::Vector3d> lights_of(const Rig& rig, RandomRays& random) {
  std::vector<Eigen::Vector3d> lights;
  const cv::Size size = rig.pair.image_size_px;
  const double slot_px = 100.0;
  for (double v = 60.0; v < size.height - 50.0; v += slot_px) {
    for (double u = 60.0; u < size.width - 150.0; u += slot_px) {
      const Eigen::Vector3d ray =
          ray_of(rig.pair.model, u + random.in(-10.0, 10.0), v + random.in(-10.0, 10.0));
      lights.push_back(random.in(4.0, 20.0) * ray);
    }
  }
  return lights;
}

/// The lights as spots that are round in the rectified image before shrinking: their centre of
/// light is their place.
StereoImages pictures_of(const Rig& rig, const std::vector<Eigen::Vector3d>& lights) {
  // The frame `cam` is given by the right camera's turn alone, and the left one's place by the
  // calibration: what the left camera is turned by is put to the test.
  const Eigen::Matrix3d R_cam_right = rig.pair.raw->R_right_cam.transpose();
  constexpr double kSigmaPx = 5.0;
  return testing::render_pair(
      rig.raw, [&](const Eigen::Vector3d& from_m, const Eigen::Vector3d& ray) {
        const Eigen::Vector2d pixel = pixel_of(rig, R_cam_right * ray);
        double nearest2 = 1e9;
        for (const Eigen::Vector3d& light : lights) {
          const Eigen::Vector2d spot = pixel_of(rig, light - R_cam_right * from_m);
          nearest2 = std::min(nearest2, (pixel - spot).squaredNorm());
        }
        return 240.0 * std::exp(-0.5 * nearest2 / (kSigmaPx * kSigmaPx));
      });
}

/// The worst errors (px) of the lights seen: of the right place, of the disparity, and of the row
/// in the left image against that in the right one.
struct Worst {
  int lights = 0;
  double place_px = 0.0;
  double disparity_px = 0.0;
  double row_px = 0.0;
};

bool is_seen(const cv::Mat1b& valid, const cv::Rect& window) {
  return (window & cv::Rect(cv::Point(), valid.size())) == window &&
         cv::countNonZero(valid(window)) == window.area();
}

Worst measure(const RectifiedPair& images,
              const PairModel& model,
              const std::vector<Eigen::Vector3d>& lights,
              int factor) {
  Worst worst;
  for (const Eigen::Vector3d& light : lights) {
    const Eigen::Vector3d uvd = project(model, light);
    const int reach_px = 20 / factor;
    const cv::Rect right_window = window_round(uvd.head<2>(), reach_px);
    const cv::Rect left_window = window_round({uvd.x() + uvd.z(), uvd.y()}, reach_px);
    if (!is_seen(images.right_valid, right_window) || !is_seen(images.left_valid, left_window)) {
      continue;
    }
    const Eigen::Vector2d right = centroid(images.right, right_window);
    const Eigen::Vector2d left = centroid(images.left, left_window);
    ++worst.lights;
    worst.place_px = std::max(worst.place_px, (right - uvd.head<2>()).norm());
    worst.disparity_px = std::max(worst.disparity_px, std::abs(left.x() - right.x() - uvd.z()));
    worst.row_px = std::max(worst.row_px, std::abs(left.y() - right.y()));
  }
  return worst;
}

TEST(RawRectifierProperty, PlacesLieOnOneRowAtTheirDisparity) {
  RandomRays random(12);
  for (const Rig& rig : rigs()) {
    const std::vector<Eigen::Vector3d> lights = lights_of(rig, random);
    const StereoImages pictures = pictures_of(rig, lights);
    for (const int factor : {1, 2}) {
      Rectifier rectifier(rig.pair, factor);
      const Worst worst =
          measure(rectifier.rectify(pictures), downscaled(rig.pair.model, factor), lights, factor);
      SCOPED_TRACE(::testing::Message() << rig.name << ", factor " << factor << ": " << worst.lights
                                        << " lights, place " << worst.place_px << ", disparity "
                                        << worst.disparity_px << ", row " << worst.row_px << " px");
      EXPECT_GE(worst.lights, 8);
      EXPECT_LT(worst.place_px, 0.05);
      EXPECT_LT(worst.disparity_px, 0.05);
      EXPECT_LT(worst.row_px, 0.05);
    }
  }
}

TEST(RawRectifierProperty, TheModelsBaselineIsTheCalibrations) {
  for (const Rig& rig : rigs()) {
    // The left camera sits at (-B, 0, 0) in `cam`.
    const Eigen::Vector3d left_m =
        rig.pair.raw->R_right_cam.transpose() * rig.raw.T_right_left.translation();
    EXPECT_LT((left_m + baseline_m(rig.pair.model) * Eigen::Vector3d::UnitX()).norm(), 1e-9);
  }
}

/// A slanted wall with waves of 0.9 m and more, 3 m ahead.
struct Wall {
  testing::Plane plane{Eigen::Vector3d(0.35, -0.2, -1.0).normalized(), -3.0};

  [[nodiscard]] static double grey(const Eigen::Vector3d& point_m) {
    return 128.0 + 50.0 * std::sin(6.5 * point_m.x() + 1.0 * point_m.z()) +
           50.0 * std::cos(6.0 * point_m.y() - 2.0 * point_m.x());
  }
};

/// What the right matched image must show of the wall.
cv::Mat1d wall_seen(const PairModel& model, const cv::Size& size_px) {
  const Wall wall;
  cv::Mat1d seen(size_px);
  for (int v = 0; v < seen.rows; ++v) {
    for (int u = 0; u < seen.cols; ++u) {
      const Eigen::Vector3d ray = ray_of(model, u, v);
      seen(v, u) = Wall::grey(wall.plane.range_m(Eigen::Vector3d::Zero(), ray) * ray);
    }
  }
  return seen;
}

/// The left image read (linearly) where the model says that each pixel of the right one has its
/// match, and where all four pixels there are valid.
struct Matched {
  cv::Mat1b image;
  cv::Mat1b valid;
};

Matched left_at_the_matches(const RectifiedPair& images, const PairModel& model) {
  const Wall wall;
  Matched matched{cv::Mat1b(images.right.size(), uchar{0}),
                  cv::Mat1b(images.right.size(), uchar{0})};
  for (int v = 0; v < images.right.rows; ++v) {
    for (int u = 0; u < images.right.cols; ++u) {
      const Eigen::Vector3d ray = ray_of(model, u, v);
      const double match_u =
          u + project(model, wall.plane.range_m(Eigen::Vector3d::Zero(), ray) * ray).z();
      const int first = static_cast<int>(std::floor(match_u));
      if (first < 0 || first + 1 >= images.left.cols || images.left_valid(v, first) == 0 ||
          images.left_valid(v, first + 1) == 0) {
        continue;
      }
      const double part = match_u - first;
      const double value = (1.0 - part) * images.left(v, first) + part * images.left(v, first + 1);
      matched.image(v, u) = cv::saturate_cast<uchar>(value);
      matched.valid(v, u) = 255;
    }
  }
  return matched;
}

TEST(RawRectifierProperty, ASlantedWallIsSeenAtItsDisparities) {
  for (const Rig& rig : rigs()) {
    const Eigen::Matrix3d R_cam_right = rig.pair.raw->R_right_cam.transpose();
    const Wall wall;
    const StereoImages pictures = testing::render_pair(
        rig.raw, [&](const Eigen::Vector3d& from_right_m, const Eigen::Vector3d& ray_right) {
          const Eigen::Vector3d from_m = R_cam_right * from_right_m;
          const Eigen::Vector3d ray = R_cam_right * ray_right;
          return Wall::grey(from_m + wall.plane.range_m(from_m, ray) * ray);
        });
    for (const int factor : {1, 2}) {
      const PairModel model = downscaled(rig.pair.model, factor);
      Rectifier rectifier(rig.pair, factor);
      const RectifiedPair& images = rectifier.rectify(pictures);
      const cv::Mat1d expected = wall_seen(model, images.right.size());
      const testing::Difference right =
          testing::compare(images.right, expected, images.right_valid);
      const Matched matched = left_at_the_matches(images, model);
      const testing::Difference left = testing::compare(matched.image, expected, matched.valid);
      SCOPED_TRACE(::testing::Message() << rig.name << ", factor " << factor << "\nright " << right
                                        << "\nleft  " << left);
      EXPECT_LT(right.rms, 0.8);
      EXPECT_LT(left.rms, 1.0);
      EXPECT_LT(right.shift_px.norm(), 0.01);
      EXPECT_LT(left.shift_px.norm(), 0.01);
      EXPECT_GT(std::min(left.pixels, right.pixels), expected.size().area() / 2);
    }
  }
}

}  // namespace
}  // namespace skyhalo

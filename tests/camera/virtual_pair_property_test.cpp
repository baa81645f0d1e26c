#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/core.hpp>

#include "camera/virtual_pair_cases.hpp"
#include "skyhalo/base/error.hpp"
#include "skyhalo/camera/virtual_pair.hpp"

namespace skyhalo {
namespace {

using testing::both_see;
using testing::disparity_offset_px;
using ::testing::HasSubstr;
using testing::kDegree;
using testing::kNone;
using testing::kPinhole;
using testing::kSpherical;
using testing::make_wish;
using testing::pinhole;
using testing::pinhole_wish;
using testing::pixel_of;
using testing::principal_point;
using testing::random_pair;
using testing::ray_through;
using testing::spherical_wish;
using testing::wide_lenses;

TEST(VirtualPairProperty, APointIsOnTheSameRowOfBothImages) {
  testing::RandomRays random(72);
  const auto lenses = wide_lenses();
  int seen = 0;
  for (int round = 0; round < 300; ++round) {
    const RawPair raw = random_pair(random, lenses, 20.0 * kDegree);
    const VirtualPairWish wish = round % 2 == 0 ? pinhole_wish() : spherical_wish();
    const VirtualPair pair = make_virtual_pair(raw, wish);
    for (int i = 0; i < 50; ++i) {
      const double u_px = random.in(-0.5, wish.size_px->width - 0.5);
      const double v_px = random.in(-0.5, wish.size_px->height - 0.5);
      const Eigen::Vector3d point_m = random.in(0.5, 50.0) * ray_through(pair.model, u_px, v_px);
      const Eigen::Vector3d right_m = pair.R_right_cam * point_m;
      const auto right = project(raw.right.lens, right_m);
      const auto left = project(raw.left.lens, raw.T_right_left.inverse() * right_m);
      if (!right || !left) {
        continue;
      }
      ++seen;
      const auto right_ray = unproject(raw.right.lens, *right);
      const auto left_ray = unproject(raw.left.lens, *left);
      ASSERT_TRUE(right_ray && left_ray);
      const Eigen::Vector2d on_right =
          pixel_of(pair.model, pair.R_right_cam.transpose() * *right_ray);
      const Eigen::Vector2d on_left = pixel_of(pair.model, pair.R_left_cam.transpose() * *left_ray);
      ASSERT_NEAR(on_right.y(), on_left.y(), 1e-9);
      const Eigen::Vector3d pixel = project(pair.model, point_m);
      ASSERT_NEAR(on_right.x(), pixel.x(), 1e-9);
      ASSERT_NEAR(on_right.y(), pixel.y(), 1e-9);
      ASSERT_NEAR(on_left.x() - on_right.x(), pixel.z() + disparity_offset_px(pair.model), 1e-9);
      ASSERT_LT((reproject(pair.model, pixel.x(), pixel.y(), pixel.z()) - point_m).norm(),
                1e-9 * point_m.norm());
      ASSERT_LT(testing::angle_between_rad(ray_of(pair.model, u_px, v_px), point_m), 1e-12);
    }
  }
  EXPECT_GT(seen, 13000);
}

TEST(VirtualPairProperty, TheOrientationIsSharedAndAlongTheBaseline) {
  testing::RandomRays random(73);
  const auto lenses = wide_lenses();
  for (int round = 0; round < 300; ++round) {
    const RawPair raw = random_pair(random, lenses, 20.0 * kDegree);
    const VirtualPair pair =
        make_virtual_pair(raw, round % 2 == 0 ? pinhole_wish() : spherical_wish());
    EXPECT_TRUE(is_rotation(pair.R_left_cam, 1e-12));
    EXPECT_TRUE(is_rotation(pair.R_right_cam, 1e-12));
    EXPECT_LT((raw.T_right_left.linear() * pair.R_left_cam - pair.R_right_cam).norm(), 1e-12);
    const Eigen::Vector3d left_m = raw.T_right_left.translation();
    EXPECT_NEAR(baseline_m(pair.model), left_m.norm(), 1e-14);
    // The left camera sits at (-B, 0, 0).
    EXPECT_LT(
        (pair.R_right_cam.transpose() * left_m + baseline_m(pair.model) * Eigen::Vector3d::UnitX())
            .norm(),
        1e-12);
    // Both optical axes are as far from the plane y = 0, on either side, and in front.
    const Eigen::Vector3d right_axis = pair.R_right_cam.transpose().col(2);
    const Eigen::Vector3d left_axis = pair.R_left_cam.transpose().col(2);
    EXPECT_NEAR(right_axis.y() + left_axis.y(), 0.0, 1e-12);
    EXPECT_GT(right_axis.z(), 0.0);
    EXPECT_GT(left_axis.z(), 0.0);
  }
}

TEST(VirtualPairProperty, SizeAndFieldAreAsWished) {
  testing::RandomRays random(74);
  const auto lenses = wide_lenses();
  for (int round = 0; round < 300; ++round) {
    const RawPair raw = random_pair(random, lenses, 5.0 * kDegree);
    VirtualPairWish wish;
    wish.model = round % 2 == 0 ? kPinhole : kSpherical;
    const bool flat = wish.model == kPinhole;
    if (round % 3 != 0) {
      wish.hfov_rad = random.in(30.0, 90.0) * kDegree;
    }
    if (round % 3 != 1) {
      wish.vfov_rad = random.in(30.0, 70.0) * kDegree;
    }
    if (round % 5 < 2 && !(flat && round % 3 == 2)) {
      wish.size_px = cv::Size(static_cast<int>(random.in(300.0, 900.0)),
                              static_cast<int>(random.in(200.0, 300.0)));
    }
    const VirtualPair pair = make_virtual_pair(raw, wish);
    const FieldOfView field = field_of_view(pair.model, pair.size_px);
    if (wish.size_px) {
      EXPECT_EQ(pair.size_px, *wish.size_px);
    }
    // A pinhole has one focal length; where both fields are wished, one is met to a row.
    const double row_rad = flat && wish.hfov_rad && wish.vfov_rad ? 0.005 : 1e-9;
    const Eigen::Vector2d centre = principal_point(pair.model);
    if (wish.hfov_rad) {
      EXPECT_NEAR(field.horizontal_rad, *wish.hfov_rad, row_rad) << round;
      EXPECT_NEAR(centre.x(), 0.5 * (pair.size_px.width - 1), 1e-9) << round;
    }
    if (wish.vfov_rad) {
      EXPECT_NEAR(field.vertical_rad, *wish.vfov_rad, row_rad) << round;
      EXPECT_NEAR(centre.y(), 0.5 * (pair.size_px.height - 1), 1e-9) << round;
    }
  }
}

TEST(VirtualPairProperty, AWishIsRefusedWhereALensEnds) {
  testing::RandomRays random(76);
  const auto lenses = testing::example_lenses();
  int refused = 0;
  for (int round = 0; round < 500; ++round) {
    const RawPair raw = random_pair(random, lenses, 1.0 * kDegree);
    const bool flat = round % 2 == 0;
    const double hfov_rad = random.in(40.0, flat ? 149.0 : 176.0) * kDegree;
    // So low an image that the wish is about the width alone.
    const VirtualPairWish wish =
        make_wish(flat ? kPinhole : kSpherical, hfov_rad, kNone, cv::Size(640, 16));
    const auto shown = [&](const VirtualPair& pair, double part) {
      bool both = true;
      for (const double angle : {-0.5 * part * hfov_rad, 0.5 * part * hfov_rad}) {
        const Eigen::Vector3d ray = testing::ray_at(angle, 0.0);
        both = both && project(raw.left.lens, pair.R_left_cam * ray).has_value() &&
               project(raw.right.lens, pair.R_right_cam * ray).has_value();
      }
      return both;
    };
    try {
      EXPECT_TRUE(shown(make_virtual_pair(raw, wish), 0.98)) << hfov_rad / kDegree;
    } catch (const Error& error) {
      ++refused;
      EXPECT_THAT(error.what(), HasSubstr("hfov_deg"));
      // The orientation does not depend on the wish.
      const VirtualPair narrow =
          make_virtual_pair(raw, make_wish(kPinhole, 20.0 * kDegree, kNone, cv::Size(640, 16)));
      EXPECT_FALSE(shown(narrow, 1.0)) << hfov_rad / kDegree;
    }
  }
  EXPECT_GT(refused, 50);
  EXPECT_LT(refused, 450);
}

TEST(VirtualPairProperty, BothCamerasSeeTheAutomaticField) {
  testing::RandomRays random(75);
  const auto lenses = wide_lenses();
  for (int round = 0; round < 100; ++round) {
    SCOPED_TRACE(round);
    const RawPair raw = random_pair(random, lenses, 10.0 * kDegree);
    const bool flat = round % 2 == 0;
    const VirtualPair pair = make_virtual_pair(raw, make_wish(flat ? kPinhole : kSpherical));
    const Eigen::Vector2d centre = principal_point(pair.model);
    for (int u = 0; u < pair.size_px.width; ++u) {
      ASSERT_TRUE(both_see(raw, pair, u, centre.y(), 0.5))
          << "column " << u << " of " << pair.size_px;
    }
    for (int v = 0; v < pair.size_px.height; ++v) {
      ASSERT_TRUE(both_see(raw, pair, centre.x(), v, 0.5)) << "row " << v << " of " << pair.size_px;
    }
    // Sizes may be cut to whole blocks of 16 pixels; beyond that a camera sees no further, or the
    // bound is reached.
    const double across = (flat ? 60.0 : 87.0) * kDegree;
    const double upright = (flat ? 60.0 : 80.0) * kDegree;
    const auto angle = [&](double u_px, double v_px) {
      return testing::angle_between_rad(ray_through(pair.model, u_px, v_px),
                                        Eigen::Vector3d::UnitZ());
    };
    constexpr double kFurther = 17.0;
    for (const double u : {-kFurther, pair.size_px.width - 1 + kFurther}) {
      EXPECT_TRUE(!both_see(raw, pair, u, centre.y(), -0.5) || angle(u, centre.y()) > across)
          << "column " << u << " of " << pair.size_px;
    }
    for (const double v : {-kFurther, pair.size_px.height - 1 + kFurther}) {
      EXPECT_TRUE(!both_see(raw, pair, centre.x(), v, -0.5) || angle(centre.x(), v) > upright)
          << "row " << v << " of " << pair.size_px;
    }
  }
}

}  // namespace
}  // namespace skyhalo

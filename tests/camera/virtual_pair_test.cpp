#include "skyhalo/camera/virtual_pair.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <opencv2/core.hpp>
#include <string>

#include "camera/virtual_pair_cases.hpp"
#include "support/expect_error.hpp"

namespace skyhalo {
namespace {

using ::testing::AnyOf;
using testing::disparity_offset_px;
using testing::euroc;
using ::testing::HasSubstr;
using testing::kDegree;
using testing::kNone;
using testing::kPinhole;
using testing::kSpherical;
using testing::make_wish;
using testing::message_of;
using testing::parallel_pair;
using testing::pinhole;
using testing::pinhole_wish;
using testing::random_pair;
using testing::spherical_wish;
using testing::wide_lenses;

constexpr double kPi = std::numbers::pi;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

TEST(VirtualPairTest, ParallelCamerasStayAsTheyAre) {
  const RawPair raw = parallel_pair(pinhole(), 0.25);
  const VirtualPair pair = make_virtual_pair(raw, pinhole_wish());
  EXPECT_LT((pair.R_left_cam - Eigen::Matrix3d::Identity()).norm(), 1e-14);
  EXPECT_LT((pair.R_right_cam - Eigen::Matrix3d::Identity()).norm(), 1e-14);
  ASSERT_TRUE(std::holds_alternative<PinholePair>(pair.model));
  const auto& model = std::get<PinholePair>(pair.model);
  EXPECT_NEAR(model.baseline_m, 0.25, 1e-15);
  EXPECT_NEAR(model.focal_px, 320.0 / std::tan(40.0 * kDegree), 1e-9);
  EXPECT_NEAR(model.principal_u_px, 319.5, 1e-9);
  EXPECT_NEAR(model.principal_v_px, 199.5, 1e-9);
  EXPECT_EQ(model.disparity_offset_px, 0.0);
  EXPECT_EQ(pair.size_px, cv::Size(640, 400));
}

TEST(VirtualPairTest, ASphericalPairAsWished) {
  const VirtualPair pair =
      make_virtual_pair(parallel_pair(testing::ideal_fisheye(200.0), 0.25), spherical_wish());
  ASSERT_TRUE(std::holds_alternative<SphericalPair>(pair.model));
  const auto& model = std::get<SphericalPair>(pair.model);
  EXPECT_NEAR(model.baseline_m, 0.25, 1e-15);
  EXPECT_NEAR(model.delta_theta_u_rad, 100.0 * kDegree / 800.0, 1e-12);
  EXPECT_NEAR(model.delta_theta_v_rad, 80.0 * kDegree / 600.0, 1e-12);
  EXPECT_NEAR(model.principal_u_px, 399.5, 1e-9);
  EXPECT_NEAR(model.principal_v_px, 299.5, 1e-9);
  EXPECT_EQ(pair.size_px, cv::Size(800, 600));
}

TEST(VirtualPairTest, TurnsBothCamerasHalfWay) {
  // The left camera looks 4 degrees inwards (to the right), the right one straight ahead: the
  // middle lies across the baseline, straight ahead.
  RawPair raw = parallel_pair(pinhole(), 0.25);
  raw.T_right_left.linear() =
      Eigen::AngleAxisd(4.0 * kDegree, Eigen::Vector3d::UnitY()).toRotationMatrix();
  VirtualPair pair = make_virtual_pair(raw, pinhole_wish());
  EXPECT_LT((pair.R_right_cam - Eigen::Matrix3d::Identity()).norm(), 1e-14);
  EXPECT_LT((pair.R_left_cam - raw.T_right_left.linear().transpose()).norm(), 1e-14);
  // The left camera looks 4 degrees down: both meet at 2 degrees.
  raw.T_right_left.linear() =
      Eigen::AngleAxisd(-4.0 * kDegree, Eigen::Vector3d::UnitX()).toRotationMatrix();
  pair = make_virtual_pair(raw, pinhole_wish());
  const Eigen::Matrix3d down =
      Eigen::AngleAxisd(-2.0 * kDegree, Eigen::Vector3d::UnitX()).toRotationMatrix();
  EXPECT_LT((pair.R_right_cam - down).norm(), 1e-14);
  EXPECT_LT((pair.R_left_cam - down.transpose()).norm(), 1e-14);
}

TEST(VirtualPairTest, FieldOfViewFromEdgeToEdge) {
  const PinholePair centred{.focal_px = 320.0,
                            .principal_u_px = 319.5,
                            .principal_v_px = 239.5,
                            .baseline_m = 0.1,
                            .disparity_offset_px = 0.0};
  EXPECT_NEAR(field_of_view(centred, {640, 480}).horizontal_rad, 90.0 * kDegree, 1e-12);
  EXPECT_NEAR(field_of_view(centred, {640, 480}).vertical_rad, 2.0 * std::atan(0.75), 1e-12);
  PinholePair aside = centred;
  aside.principal_u_px = -0.5;   // the left edge
  aside.principal_v_px = 799.5;  // 320 below the last row
  EXPECT_NEAR(field_of_view(aside, {320, 480}).horizontal_rad, 45.0 * kDegree, 1e-12);
  EXPECT_NEAR(field_of_view(aside, {320, 480}).vertical_rad, std::atan(2.5) - kPi / 4.0, 1e-12);
  const SphericalPair spherical{.delta_theta_u_rad = 0.002,
                                .delta_theta_v_rad = 0.001,
                                .principal_u_px = 17.0,
                                .principal_v_px = 41.0,
                                .baseline_m = 0.1};
  EXPECT_NEAR(field_of_view(spherical, {640, 480}).horizontal_rad, 1.28, 1e-12);
  EXPECT_NEAR(field_of_view(spherical, {640, 480}).vertical_rad, 0.48, 1e-12);
}

TEST(VirtualPairTest, APixelInTheMiddleIsAsLargeAsARawOne) {
  for (const auto& example : wide_lenses()) {
    SCOPED_TRACE(example.name);
    const RawPair raw = parallel_pair(example, 0.2);
    // Pixels per radian around the axis.
    const double raw_px =
        0.5 * (*jacobian(example.lens, Eigen::Vector3d::UnitZ())).leftCols<2>().diagonal().sum();
    const VirtualPair flat = make_virtual_pair(raw, make_wish(kPinhole));
    EXPECT_NEAR(std::get<PinholePair>(flat.model).focal_px, raw_px, 0.02 * raw_px);
    const VirtualPair round = make_virtual_pair(raw, make_wish(kSpherical));
    EXPECT_NEAR(
        1.0 / std::get<SphericalPair>(round.model).delta_theta_u_rad, raw_px, 0.02 * raw_px);
    EXPECT_NEAR(
        1.0 / std::get<SphericalPair>(round.model).delta_theta_v_rad, raw_px, 0.02 * raw_px);
  }
}

TEST(VirtualPairTest, TheAutomaticFieldIsBounded) {
  // The lens sees 100 degrees to each side, and 80 up and down (512 of 640 px to 100 degrees); what
  // is given away is at most the last 16 columns or rows.
  const RawPair raw = parallel_pair(testing::ideal_fisheye(200.0), 0.2);
  const VirtualPair flat = make_virtual_pair(raw, make_wish(kPinhole));
  const double focal_px = std::get<PinholePair>(flat.model).focal_px;
  const FieldOfView flat_field = field_of_view(flat.model, flat.size_px);
  const double least_rad = 2.0 * std::atan(std::tan(60.0 * kDegree) - 8.0 / focal_px);
  EXPECT_LE(flat_field.horizontal_rad, 120.0 * kDegree + 1e-9);
  EXPECT_GE(flat_field.horizontal_rad, least_rad);
  EXPECT_LE(flat_field.vertical_rad, 120.0 * kDegree + 1e-9);
  EXPECT_GE(flat_field.vertical_rad, least_rad);
  const VirtualPair round = make_virtual_pair(raw, make_wish(kSpherical));
  const auto& model = std::get<SphericalPair>(round.model);
  const FieldOfView round_field = field_of_view(round.model, round.size_px);
  EXPECT_LE(round_field.horizontal_rad, 174.0 * kDegree + 1e-9);
  EXPECT_GE(round_field.horizontal_rad, 174.0 * kDegree - 16.0 * model.delta_theta_u_rad);
  EXPECT_LE(round_field.vertical_rad, 160.0 * kDegree + 1e-9);
  EXPECT_GE(round_field.vertical_rad, 160.0 * kDegree - 16.0 * model.delta_theta_v_rad);
}

TEST(VirtualPairTest, AnImpossibleBaselineIsNamed) {
  const auto message = [](const Eigen::Vector3d& left_m) {
    RawPair raw = parallel_pair(euroc(), 0.2);
    raw.T_right_left.translation() = left_m;
    return message_of([&] { static_cast<void>(make_virtual_pair(raw, {})); });
  };
  EXPECT_THAT(message({0.0, 0.0, 0.0}), HasSubstr("T_right_left"));
  EXPECT_THAT(message({0.2, 0.0, 0.0}), HasSubstr("T_right_left"));  // swapped or inverted
  EXPECT_THAT(message({0.2, 0.03, -0.02}), HasSubstr("T_right_left"));
  EXPECT_THAT(message({0.0, 0.0, 0.2}), HasSubstr("T_right_left"));  // one before the other
  EXPECT_THAT(message({kNan, 0.0, 0.0}), HasSubstr("T_right_left"));
}

TEST(VirtualPairTest, InvertedExtrinsicsAreNamed) {
  testing::RandomRays random(71);
  for (int i = 0; i < 100; ++i) {
    RawPair raw = random_pair(random, wide_lenses(), 20.0 * kDegree);
    raw.T_right_left = raw.T_right_left.inverse();
    EXPECT_THAT(message_of([&] { static_cast<void>(make_virtual_pair(raw, {})); }),
                HasSubstr("T_right_left"));
  }
}

std::string wish_message(const testing::ExampleLens& example, const VirtualPairWish& wish) {
  return message_of(
      [&] { static_cast<void>(make_virtual_pair(parallel_pair(example, 0.2), wish)); });
}

TEST(VirtualPairTest, AFieldBeyondTheModelIsNamed) {
  const auto fisheye = testing::ideal_fisheye(200.0);
  for (const double wrong : {185.0 * kDegree, 180.0 * kDegree, 0.0, -1.0, kNan, 1e300}) {
    SCOPED_TRACE(wrong);
    EXPECT_THAT(wish_message(fisheye, make_wish(kPinhole, wrong)), HasSubstr("hfov_deg"));
    EXPECT_THAT(wish_message(fisheye, make_wish(kPinhole, kNone, wrong)), HasSubstr("vfov_deg"));
    EXPECT_THAT(wish_message(fisheye, make_wish(kSpherical, wrong)), HasSubstr("hfov_deg"));
  }
  EXPECT_THAT(wish_message(fisheye, make_wish(kSpherical, kNone, -0.1)), HasSubstr("vfov_deg"));
}

TEST(VirtualPairTest, AFieldBeyondTheLensIsNamed) {
  const auto folding = testing::radial_tangential_examples()[4];  // sees 42 degrees to each side
  for (const auto kind : {kPinhole, kSpherical}) {
    EXPECT_THAT(wish_message(folding, make_wish(kind, 100.0 * kDegree)), HasSubstr("hfov_deg"));
    EXPECT_THAT(wish_message(folding, make_wish(kind, kNone, 100.0 * kDegree)),
                HasSubstr("vfov_deg"));
    const VirtualPairWish within = make_wish(kind, 70.0 * kDegree, kNone, cv::Size(640, 300));
    EXPECT_NO_THROW(static_cast<void>(make_virtual_pair(parallel_pair(folding, 0.2), within)));
  }
}

TEST(VirtualPairTest, AnImpossibleSizeIsNamed) {
  for (const auto kind : {kPinhole, kSpherical}) {
    for (const cv::Size size : {cv::Size(0, 480),
                                cv::Size(640, 0),
                                cv::Size(-640, 480),
                                cv::Size(640, -480),
                                cv::Size(0, 0)}) {
      EXPECT_THAT(wish_message(euroc(), make_wish(kind, kNone, kNone, size)), HasSubstr("size_px"))
          << size;
    }
  }
}

TEST(VirtualPairTest, APinholeCannotStretch) {
  // 90 degrees in 640 columns make f = 320 and 480 rows 73.7 degrees: 60 is not to be had.
  const VirtualPairWish wish =
      make_wish(kPinhole, 90.0 * kDegree, 60.0 * kDegree, cv::Size(640, 480));
  EXPECT_THAT(wish_message(euroc(), wish),
              AnyOf(HasSubstr("hfov_deg"), HasSubstr("vfov_deg"), HasSubstr("size_px")));
  VirtualPairWish possible = wish;
  possible.vfov_rad = 2.0 * std::atan(0.75);
  EXPECT_NO_THROW(static_cast<void>(make_virtual_pair(parallel_pair(euroc(), 0.2), possible)));
}

}  // namespace
}  // namespace skyhalo

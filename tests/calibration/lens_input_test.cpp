#include "skyhalo/calibration/lens_input.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <variant>

#include "support/expect_error.hpp"

namespace skyhalo {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::message_of;

LensInput input_of(LensKind kind, std::vector<double> distortion) {
  return {.kind = kind,
          .intrinsics = {400.0, 401.0, 320.0, 240.0},
          .distortion = std::move(distortion),
          .intrinsics_at = [](std::string_view text) { return input_error("f", 1, text); },
          .distortion_at = [](std::string_view text) { return input_error("f", 2, text); }};
}

TEST(LensInputTest, TheIntrinsicsArePassedOn) {
  const Lens lens = lens_from(input_of(LensKind::kRadialTangential, no_distortion()));
  EXPECT_EQ(intrinsics(lens).fx_px, 400.0);
  EXPECT_EQ(intrinsics(lens).fy_px, 401.0);
  EXPECT_EQ(intrinsics(lens).cx_px, 320.0);
  EXPECT_EQ(intrinsics(lens).cy_px, 240.0);
}

TEST(LensInputTest, RadialTangentialCoefficientsThatAreLeftOutAreZero) {
  const auto coefficients = [](std::vector<double> given) {
    return std::get<RadialTangentialLens>(
               lens_from(input_of(LensKind::kRadialTangential, std::move(given))))
        .distortion();
  };
  EXPECT_THAT(coefficients({0.1, 0.2, 0.3e-2, 0.4e-2}),
              ElementsAre(0.1, 0.2, 0.3e-2, 0.4e-2, 0.0, 0.0, 0.0, 0.0));
  EXPECT_THAT(coefficients({0.1, 0.2, 0.3e-2, 0.4e-2, 0.5}),
              ElementsAre(0.1, 0.2, 0.3e-2, 0.4e-2, 0.5, 0.0, 0.0, 0.0));
  const std::vector<double> eight = {0.1, 0.2, 0.3e-2, 0.4e-2, 0.5, 0.06, 0.07, 0.08};
  EXPECT_THAT(coefficients(eight), ElementsAre(0.1, 0.2, 0.3e-2, 0.4e-2, 0.5, 0.06, 0.07, 0.08));
  for (const std::size_t count : {12U, 14U}) {
    std::vector<double> more = eight;
    more.resize(count, 0.0);
    EXPECT_THAT(coefficients(more), ElementsAre(0.1, 0.2, 0.3e-2, 0.4e-2, 0.5, 0.06, 0.07, 0.08));
  }
}

TEST(LensInputTest, ThinPrismAndTiltAreRefused) {
  for (const std::size_t count : {12U, 14U}) {
    std::vector<double> given(count, 0.0);
    given.back() = 1e-4;
    EXPECT_THAT(message_of([&] { (void)lens_from(input_of(LensKind::kRadialTangential, given)); }),
                HasSubstr("f:2: the coefficients after the eighth"));
  }
}

TEST(LensInputTest, TheOtherModelsTakeTheirNumbersInOrder) {
  const Lens fisheye = lens_from(input_of(LensKind::kKannalaBrandt, {0.01, 0.02, 0.03, 0.04}));
  EXPECT_THAT(std::get<KannalaBrandtLens>(fisheye).distortion(),
              ElementsAre(0.01, 0.02, 0.03, 0.04));
  const Lens sphere = lens_from(input_of(LensKind::kDoubleSphere, {-0.25, 0.6}));
  EXPECT_EQ(std::get<DoubleSphereLens>(sphere).shape().xi, -0.25);
  EXPECT_EQ(std::get<DoubleSphereLens>(sphere).shape().alpha, 0.6);
  const Lens unified = lens_from(input_of(LensKind::kExtendedUnified, {0.6, 1.1}));
  EXPECT_EQ(std::get<ExtendedUnifiedLens>(unified).shape().alpha, 0.6);
  EXPECT_EQ(std::get<ExtendedUnifiedLens>(unified).shape().beta, 1.1);
}

TEST(LensInputTest, AWrongCountIsRefused) {
  const auto refusal = [](LensKind kind, std::size_t count) {
    return message_of([&] { (void)lens_from(input_of(kind, std::vector<double>(count, 0.1))); });
  };
  EXPECT_EQ(refusal(LensKind::kRadialTangential, 0), "f:2: expected 4, 5 or 8 numbers, found 0");
  EXPECT_EQ(refusal(LensKind::kRadialTangential, 6), "f:2: expected 4, 5 or 8 numbers, found 6");
  EXPECT_EQ(refusal(LensKind::kKannalaBrandt, 5), "f:2: expected 4 numbers, found 5");
  EXPECT_EQ(refusal(LensKind::kDoubleSphere, 1), "f:2: expected 2 numbers, found 1");
  EXPECT_EQ(refusal(LensKind::kExtendedUnified, 3), "f:2: expected 2 numbers, found 3");
}

TEST(LensInputTest, WhatTheLensRefusesIsSaidInTheFilesWords) {
  LensInput no_focal = input_of(LensKind::kKannalaBrandt, {0, 0, 0, 0});
  no_focal.intrinsics.fx_px = 0.0;
  const std::string about_intrinsics = message_of([&] { (void)lens_from(no_focal); });
  EXPECT_THAT(about_intrinsics, HasSubstr("f:1: "));
  EXPECT_THAT(about_intrinsics, ::testing::Not(HasSubstr("intrinsics_px")));
  const std::string about_shape = message_of([&] {
    (void)lens_from(input_of(LensKind::kDoubleSphere, {0.5, 1.5}));
  });
  EXPECT_THAT(about_shape, HasSubstr("f:2: "));
  EXPECT_THAT(about_shape, ::testing::Not(HasSubstr("distortion")));
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(message_of([&] {
                (void)lens_from(input_of(LensKind::kKannalaBrandt, {kNaN, 0, 0, 0}));
              }),
              HasSubstr("f:2: "));
}

TEST(LensInputTest, ACameraMatrixHasOnlyItsFourNumbers) {
  const ErrorAt error_at = [](std::string_view message) {
    return input_error("a.yaml", "K: " + std::string(message));
  };
  const std::vector<double> good = {400, 0, 320, 0, 401, 240, 0, 0, 1};
  const Intrinsics k = intrinsics_from(good, error_at);
  EXPECT_EQ(k.fx_px, 400.0);
  EXPECT_EQ(k.fy_px, 401.0);
  EXPECT_EQ(k.cx_px, 320.0);
  EXPECT_EQ(k.cy_px, 240.0);
  for (const std::size_t i : {1U, 3U, 6U, 7U, 8U}) {
    SCOPED_TRACE(i);
    std::vector<double> bad = good;
    bad[i] = 0.5;
    EXPECT_THAT(message_of([&] { (void)intrinsics_from(bad, error_at); }),
                HasSubstr("a.yaml: K: expected fx 0 cx"));
  }
  EXPECT_THAT(message_of([&] { (void)intrinsics_from(std::vector<double>(8), error_at); }),
              HasSubstr("a.yaml: K: expected 9 numbers, found 8"));
}

}  // namespace
}  // namespace skyhalo

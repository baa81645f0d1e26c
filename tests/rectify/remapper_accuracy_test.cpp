// How exactly remapping keeps what is seen, through every lens and to both rectified models.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "rectify/compared_images.hpp"
#include "rectify/remap_cases.hpp"
#include "reference/naive_rectification.hpp"
#include "skyhalo/rectify/remapper.hpp"
#include "support/textured_pair.hpp"

namespace skyhalo {
namespace {

using testing::compare;
using testing::Difference;
using testing::goal_of;
using testing::RemapCase;
using testing::remapped;

/// The pattern at the ray of each matched pixel.
cv::Mat1d pattern_of(const RemapCase& one, int factor) {
  cv::Mat1d expected(one.size_px / factor);
  for (int v = 0; v < expected.rows; ++v) {
    for (int u = 0; u < expected.cols; ++u) {
      const double u_px = (u + 0.5) * factor - 0.5;
      const double v_px = (v + 0.5) * factor - 0.5;
      expected(v, u) = testing::wavy_sky(one.R_raw_cam * ray_of(one.model, u_px, v_px));
    }
  }
  return expected;
}

TEST(RemapperProperty, APatternOfTheSkyIsSeenWhereItIs) {
  for (const RemapCase& one : testing::remap_cases({720, 480}, 5)) {
    const cv::Mat1b raw = testing::render(one.camera, testing::wavy_sky);
    for (const int factor : {1, 2, 4}) {
      Remapper remapper(goal_of(one, factor));
      const cv::Mat1b out = remapped(remapper, raw);
      const Difference found = compare(out, pattern_of(one, factor), remapper.valid());
      SCOPED_TRACE(::testing::Message() << one.name << ", factor " << factor << ": " << found);
      // Three roundings to whole grey levels, of 0.29 each, are 0.5 together. The means and the
      // interpolation flatten the waves by a few tenths, which at the edges of the image looks like
      // a shift of some thousandths of a pixel.
      EXPECT_LT(found.rms, 0.7);
      EXPECT_LT(found.shift_px.norm(), 0.01);
      EXPECT_GT(found.pixels, one.size_px.area() / (factor * factor) / 2);
    }
  }
}

/// Standard deviation of the grey levels.
double contrast(const cv::Mat1b& image) {
  cv::Scalar mean;
  cv::Scalar deviation;
  cv::meanStdDev(image, mean, deviation);
  return deviation[0];
}

TEST(RemapperProperty, WhatIsFinerThanAPixelIsAveragedAway) {
  const cv::Size size(480, 320);
  for (const int direction : {0, 1}) {
    cv::Mat1b stripes(size);
    for (int i = 0; i < size.area(); ++i) {
      const int at = direction == 0 ? i % size.width : i / size.width;
      stripes(i / size.width, i % size.width) = at % 3 == 0 ? 255 : 0;
    }
    // Neither shift lets the stripes fall on the pixels in step.
    Remapper remapper(goal_of(testing::ideal_pinhole(size, {0.3, 0.3}), 4));
    const cv::Mat1b out = remapped(remapper, stripes);
    const cv::Rect inside(2, 2, out.cols - 4, out.rows - 4);
    cv::Mat1b points;
    cv::resize(stripes, points, {}, 0.25, 0.25, cv::INTER_NEAREST);
    EXPECT_GT(contrast(points(inside)), 0.5 * contrast(stripes));
    // The mean over 4 px leaves |sin(4 pi / 3) / (4 sin(pi / 3))| = 1/4 of waves of 3 px.
    EXPECT_LT(contrast(out(inside)), 0.26 * contrast(stripes));
  }
}

TEST(RemapperProperty, NoiseShrinksAsMeansDo) {
  // The mean of 16 independent values has a quarter of their deviation, one of four points half.
  cv::Mat1b noise(480, 752);
  cv::RNG random(9);
  random.fill(noise, cv::RNG::UNIFORM, 0, 256);
  for (const RemapCase& one : testing::remap_cases({480, 320}, 6)) {
    Remapper remapper(goal_of(one, 4));
    const cv::Mat1b out = remapped(remapper, noise);
    EXPECT_LT(contrast(out(cv::Rect(40, 30, 40, 20))), 0.3 * contrast(noise)) << one.name;
  }
}

reference::NaiveVector naive_view(const PairModel& model, const reference::NaiveImagePoint& at) {
  if (const auto* pair = std::get_if<PinholePair>(&model)) {
    return reference::naive_pinhole_view(
        pair->focal_px, {pair->principal_u_px, pair->principal_v_px}, at);
  }
  const auto& pair = std::get<SphericalPair>(model);
  return reference::naive_spherical_view({pair.delta_theta_u_rad, pair.delta_theta_v_rad},
                                         {pair.principal_u_px, pair.principal_v_px},
                                         at);
}

cv::Mat1d naively_rectified(const RemapCase& one,
                            int factor,
                            const cv::Mat1b& raw,
                            int rays_per_side = 8) {
  reference::NaiveRectification goal{.matched_size_px = one.size_px / factor,
                                     .factor = factor,
                                     .rays_per_side = rays_per_side,
                                     .max_angle_rad = max_angle_rad(one.camera.lens)};
  for (int i = 0; i < 9; ++i) {
    goal.R_raw_cam[static_cast<std::size_t>(i / 3)][static_cast<std::size_t>(i % 3)] =
        one.R_raw_cam(i / 3, i % 3);
  }
  return reference::naive_rectify(
      raw,
      goal,
      [&](const reference::NaiveImagePoint& at) { return naive_view(one.model, at); },
      [&](const reference::NaiveVector& ray) {
        return testing::naive_project(one.camera.lens, ray);
      });
}

TEST(RemapperReference, AgreesWithTheMeanOfManyRays) {
  for (const int factor : {1, 2, 4}) {
    // Details of a few matched pixels.
    cv::Mat1b raw = testing::texture({752, 480}, 7);
    cv::GaussianBlur(raw, raw, {0, 0}, 1.5 * factor);
    cv::normalize(raw, raw, 0, 255, cv::NORM_MINMAX);
    for (const RemapCase& one : testing::remap_cases({320, 240}, 8)) {
      Remapper remapper(goal_of(one, factor));
      const cv::Mat1b out = remapped(remapper, raw);
      const Difference found = compare(out, naively_rectified(one, factor, raw), remapper.valid());
      SCOPED_TRACE(::testing::Message() << one.name << ", factor " << factor << ": " << found);
      EXPECT_LT(found.mean_abs, 3.0);
      EXPECT_LT(found.shift_px.norm(), 0.02);
      EXPECT_GT(found.pixels, one.size_px.area() / (factor * factor) / 2);
    }
  }
}

TEST(RemapperReference, ShowsWhatTheNaiveOneShows) {
  const cv::Mat1b plain(480, 752, uchar{200});
  for (const RemapCase& one : testing::remap_cases({1000, 600}, 10)) {
    for (const int factor : {2, 4}) {
      const Remapper remapper(goal_of(one, factor));
      cv::Mat1b seen;
      cv::compare(naively_rectified(one, factor, plain, 3), 199.5, seen, cv::CMP_GT);
      // They may differ in the width of the edge: two pixels here and there.
      cv::Mat1b less;
      cv::Mat1b more;
      cv::erode(seen, less, cv::Mat1b::ones(5, 5));
      cv::dilate(seen, more, cv::Mat1b::ones(5, 5));
      cv::Mat1b missing;
      cv::Mat1b surplus;
      cv::subtract(less, remapper.valid(), missing);
      cv::subtract(remapper.valid(), more, surplus);
      EXPECT_EQ(cv::countNonZero(missing), 0) << one.name;
      EXPECT_EQ(cv::countNonZero(surplus), 0) << one.name;
      EXPECT_LT(cv::countNonZero(remapper.valid()), remapper.valid().size().area()) << one.name;
    }
  }
}

}  // namespace
}  // namespace skyhalo

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>

#include "skyhalo/calibration/lens_words.hpp"
#include "skyhalo/calibration/rig_file.hpp"
#include "skyhalo/geometry/angle.hpp"
#include "support/example_lenses.hpp"
#include "support/temp_folder.hpp"

namespace skyhalo {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::StartsWith;
using testing::TempFolder;

RigFile read_back(const RigDescription& rig) {
  const TempFolder folder;
  return read_rig_file(folder.write("rig.yaml", to_yaml(rig, "Made up.")));
}

void expect_same(const Pose& actual, const Pose& expected) {
  EXPECT_EQ(actual.matrix(), expected.matrix());
}

void expect_same(const RawCamera& actual, const RawCamera& expected) {
  EXPECT_EQ(actual.size_px, expected.size_px);
  EXPECT_EQ(actual.lens.index(), expected.lens.index());
  const Intrinsics& a = intrinsics(actual.lens);
  const Intrinsics& e = intrinsics(expected.lens);
  EXPECT_EQ(a.fx_px, e.fx_px);
  EXPECT_EQ(a.fy_px, e.fy_px);
  EXPECT_EQ(a.cx_px, e.cx_px);
  EXPECT_EQ(a.cy_px, e.cy_px);
  EXPECT_EQ(distortion_numbers(actual.lens), distortion_numbers(expected.lens));
}

void expect_same(const RawPairDescription& actual, const RawPairDescription& expected) {
  expect_same(actual.cameras.left, expected.cameras.left);
  expect_same(actual.cameras.right, expected.cameras.right);
  expect_same(actual.cameras.T_right_left, expected.cameras.T_right_left);
  EXPECT_EQ(actual.rectify_to.model, expected.rectify_to.model);
  EXPECT_EQ(actual.rectify_to.hfov_rad, expected.rectify_to.hfov_rad);
  EXPECT_EQ(actual.rectify_to.vfov_rad, expected.rectify_to.vfov_rad);
  EXPECT_EQ(actual.rectify_to.size_px, expected.rectify_to.size_px);
}

void expect_same(const PinholePair& actual, const PinholePair& expected) {
  EXPECT_EQ(actual.focal_px, expected.focal_px);
  EXPECT_EQ(actual.principal_u_px, expected.principal_u_px);
  EXPECT_EQ(actual.principal_v_px, expected.principal_v_px);
  EXPECT_EQ(actual.baseline_m, expected.baseline_m);
  EXPECT_EQ(actual.disparity_offset_px, expected.disparity_offset_px);
}

void expect_same(const SphericalPair& actual, const SphericalPair& expected) {
  EXPECT_EQ(actual.delta_theta_u_rad, expected.delta_theta_u_rad);
  EXPECT_EQ(actual.delta_theta_v_rad, expected.delta_theta_v_rad);
  EXPECT_EQ(actual.principal_u_px, expected.principal_u_px);
  EXPECT_EQ(actual.principal_v_px, expected.principal_v_px);
  EXPECT_EQ(actual.baseline_m, expected.baseline_m);
}

void expect_same(const RectifiedPairDescription& actual, const RectifiedPairDescription& expected) {
  EXPECT_EQ(actual.size_px, expected.size_px);
  ASSERT_EQ(actual.model.index(), expected.model.index());
  if (const auto* pinhole = std::get_if<PinholePair>(&expected.model)) {
    expect_same(std::get<PinholePair>(actual.model), *pinhole);
  } else {
    expect_same(std::get<SphericalPair>(actual.model), std::get<SphericalPair>(expected.model));
  }
}

void expect_same(const PairDescription& actual, const PairDescription& expected) {
  EXPECT_EQ(actual.name, expected.name);
  ASSERT_EQ(actual.images.index(), expected.images.index());
  if (const auto* raw = std::get_if<RawPairDescription>(&expected.images)) {
    expect_same(std::get<RawPairDescription>(actual.images), *raw);
  } else {
    expect_same(std::get<RectifiedPairDescription>(actual.images),
                std::get<RectifiedPairDescription>(expected.images));
  }
  expect_same(actual.T_body_camera, expected.T_body_camera);
  EXPECT_EQ(actual.downscale, expected.downscale);
  EXPECT_EQ(actual.rcrop_px, expected.rcrop_px);
  EXPECT_EQ(actual.masks_px, expected.masks_px);
  EXPECT_EQ(actual.min_range_m, expected.min_range_m);
  EXPECT_EQ(actual.max_range_m, expected.max_range_m);
  EXPECT_EQ(actual.line_time_s, expected.line_time_s);
}

void expect_same(const RigDescription& actual, const RigDescription& expected) {
  EXPECT_EQ(actual.name, expected.name);
  ASSERT_EQ(actual.T_body_imu.has_value(), expected.T_body_imu.has_value());
  if (expected.T_body_imu) {
    expect_same(*actual.T_body_imu, *expected.T_body_imu);
  }
  ASSERT_EQ(actual.pairs.size(), expected.pairs.size());
  for (std::size_t i = 0; i < expected.pairs.size(); ++i) {
    expect_same(actual.pairs[i], expected.pairs[i]);
  }
}

/// Rigs with any of what a rig can have.
class RandomRigs {
 public:
  explicit RandomRigs(unsigned seed) : random_(seed), rays_(seed) {}

  RigDescription next() {
    RigDescription rig{.name = text(), .T_body_imu = maybe([&] { return pose(); }), .pairs = {}};
    const int pairs = whole(1, 4);
    for (int i = 0; i < pairs; ++i) {
      rig.pairs.push_back(pair(std::to_string(i)));
    }
    return rig;
  }

 private:
  int whole(int from, int to) { return std::uniform_int_distribution<int>(from, to)(random_); }

  template <class Make>
  auto maybe(Make make) -> std::optional<decltype(make())> {
    return whole(0, 1) == 1 ? std::optional(make()) : std::nullopt;
  }

  /// Letters that mean something in YAML, among others.
  std::string text() {
    const std::vector<std::string> parts = {"a",
                                            " ",
                                            "\"",
                                            "'",
                                            ":",
                                            "#",
                                            "- ",
                                            "{",
                                            "]",
                                            "%",
                                            "&",
                                            "*",
                                            "\u00e9",
                                            "~",
                                            "!",
                                            "1",
                                            "null"};
    std::string text;
    for (int i = whole(0, 6); i > 0; --i) {
      text += parts[static_cast<std::size_t>(whole(0, static_cast<int>(parts.size()) - 1))];
    }
    return text;
  }

  Pose pose() {
    return make_pose(rays_.rotation(3.0), {rays_.wild(-3, 1), rays_.wild(-3, 1), rays_.in(-1, 1)});
  }

  cv::Size size() { return {whole(1, 16384), whole(1, 16384)}; }

  RawCamera camera() {
    const auto index = static_cast<std::size_t>(whole(0, static_cast<int>(lenses_.size()) - 1));
    return {size(), lenses_[index].lens};
  }

  /// An angle that some number of degrees stands for, as in every file.
  double angle_rad() {
    const double rounded = std::round(rays_.in(0.1, 340.0) * 100.0) / 100.0;
    return rad_from_deg(whole(0, 1) == 1 ? rounded : rays_.in(0.1, 340.0));
  }

  RawPairDescription raw() {
    return {{camera(), camera(), pose()},
            {.model = whole(0, 1) == 1 ? PairModelKind::kPinhole : PairModelKind::kSpherical,
             .hfov_rad = maybe([&] { return angle_rad(); }),
             .vfov_rad = maybe([&] { return angle_rad(); }),
             .size_px = maybe([&] { return size(); })}};
  }

  RectifiedPairDescription rectified() {
    const double positive = std::abs(rays_.wild(-300, 300));
    if (whole(0, 1) == 1) {
      return {size(),
              PinholePair{.focal_px = positive,
                          .principal_u_px = rays_.wild(-3, 4),
                          .principal_v_px = rays_.wild(-3, 4),
                          .baseline_m = rays_.in(0.01, 1.0),
                          .disparity_offset_px = whole(0, 1) * rays_.wild(-3, 2)}};
    }
    return {size(),
            SphericalPair{.delta_theta_u_rad = positive,
                          .delta_theta_v_rad = rays_.in(1e-4, 1e-2),
                          .principal_u_px = rays_.wild(-3, 4),
                          .principal_v_px = rays_.wild(-3, 4),
                          .baseline_m = rays_.in(0.01, 1.0)}};
  }

  PairDescription pair(const std::string& number) {
    PairDescription pair{.name = "p" + text() + number, .images = rectified()};
    if (whole(0, 1) == 1) {
      pair.images = raw();
    }
    pair.T_body_camera = pose();
    pair.downscale = maybe([&] { return whole(1, 16); });
    pair.rcrop_px = maybe([&] { return whole(0, 200); });
    for (int i = whole(0, 2); i > 0; --i) {
      pair.masks_px.emplace_back(whole(-9, 999), whole(-9, 999), whole(1, 99), whole(1, 99));
    }
    pair.min_range_m = maybe([&] { return rays_.in(0.1, 1.0); });
    pair.max_range_m = maybe([&] { return rays_.in(2.0, 50.0); });
    pair.line_time_s = whole(0, 1) * rays_.in(1e-6, 1e-3);
    return pair;
  }

  std::mt19937 random_;
  testing::RandomRays rays_;
  std::vector<testing::ExampleLens> lenses_ = testing::example_lenses();
};

TEST(RigYamlProperty, WhatIsWrittenIsReadBackToTheLastBit) {
  RandomRigs rigs(20);
  for (int i = 0; i < 200; ++i) {
    SCOPED_TRACE(i);
    const RigDescription rig = rigs.next();
    const RigFile file = read_back(rig);
    EXPECT_THAT(file.warnings, IsEmpty());
    expect_same(file.description, rig);
    if (::testing::Test::HasFailure()) {
      FAIL() << to_yaml(rig, "");
    }
  }
}

RigDescription one_raw_pair() {
  const testing::ExampleLens lens = testing::example_lenses().front();
  const RawCamera camera{lens.size_px, lens.lens};
  return {
      .name = "rig",
      .T_body_imu = {},
      .pairs = {{.name = "front",
                 .images = RawPairDescription{
                     {camera, camera, make_pose(Eigen::Matrix3d::Identity(), {-0.1, 0, 0})}, {}}}}};
}

TEST(RigYamlProperty, EveryNumberOfDegreesIsReadBack) {
  testing::RandomRays random(22);
  RigDescription rig = one_raw_pair();
  VirtualPairWish& wish = std::get<RawPairDescription>(rig.pairs[0].images).rectify_to;
  for (int i = 0; i < 500; ++i) {
    wish.hfov_rad = rad_from_deg(random.in(0.1, 179.0));
    const RigDescription again = read_back(rig).description;
    EXPECT_EQ(std::get<RawPairDescription>(again.pairs[0].images).rectify_to.hfov_rad,
              wish.hfov_rad);
  }
}

TEST(RigYamlTest, DegreesAreWrittenAsTheyWereGiven) {
  RigDescription rig = one_raw_pair();
  VirtualPairWish& wish = std::get<RawPairDescription>(rig.pairs[0].images).rectify_to;
  for (const auto& [angle_deg, text] : {std::pair(91.0, "hfov_deg: 91\n"),
                                        std::pair(100.1, "hfov_deg: 100.1\n"),
                                        std::pair(33.333, "hfov_deg: 33.333\n")}) {
    wish.hfov_rad = rad_from_deg(angle_deg);
    EXPECT_THAT(to_yaml(rig, ""), HasSubstr(text));
  }
}

TEST(RigYamlTest, TheHeadIsAComment) {
  EXPECT_THAT(to_yaml(one_raw_pair(), "First line.\n\nrig: not this"),
              StartsWith("# First line.\n#\n# rig: not this\nrig: \"rig\"\n"));
  EXPECT_THAT(to_yaml(one_raw_pair(), ""), StartsWith("rig: \"rig\"\n"));
}

TEST(RigYamlTest, WhatIsLeftOutIsNotWritten) {
  const std::string text = to_yaml(one_raw_pair(), "");
  for (const std::string key : {"T_body_imu",
                                "downscale",
                                "rcrop_px",
                                "masks_px",
                                "range_m",
                                "line_time_s",
                                "hfov_deg",
                                "vfov_deg"}) {
    EXPECT_THAT(text, ::testing::Not(HasSubstr(key)));
  }
}

}  // namespace
}  // namespace skyhalo

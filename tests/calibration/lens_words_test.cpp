#include "skyhalo/calibration/lens_words.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "support/example_lenses.hpp"
#include "support/expect_error.hpp"

namespace skyhalo {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::message_of;

const Intrinsics kIntrinsics{400.0, 404.0, 319.5, 241.0};

Lens make(const std::string& word, const std::vector<double>& numbers) {
  return make_lens(word, kIntrinsics, numbers);
}

TEST(LensWordsTest, EachWordMakesItsLens) {
  EXPECT_THAT(std::get<RadialTangentialLens>(make("pinhole", {})).distortion(),
              ::testing::Each(0.0));
  EXPECT_THAT(std::get<RadialTangentialLens>(make("radial-tangential", {-0.1, 0.02, 3e-3, 4e-3}))
                  .distortion(),
              ElementsAre(-0.1, 0.02, 3e-3, 4e-3, 0, 0, 0, 0));
  EXPECT_THAT(
      std::get<KannalaBrandtLens>(make("kannala-brandt", {0.1, 0.2, 0.3, 0.4})).distortion(),
      ElementsAre(0.1, 0.2, 0.3, 0.4));
  const auto sphere = std::get<DoubleSphereLens>(make("double-sphere", {-0.25, 0.6}));
  EXPECT_EQ(sphere.shape().xi, -0.25);
  EXPECT_EQ(sphere.shape().alpha, 0.6);
  const auto unified = std::get<ExtendedUnifiedLens>(make("extended-unified", {0.6, 1.1}));
  EXPECT_EQ(unified.shape().alpha, 0.6);
  EXPECT_EQ(unified.shape().beta, 1.1);
  EXPECT_EQ(unified.intrinsics().fy_px, 404.0);
}

TEST(LensWordsTest, RadialTangentialTakesFourFiveOrEightNumbers) {
  EXPECT_THAT(
      std::get<RadialTangentialLens>(make("radial-tangential", {0.1, 0.02, 0.003, 0.004, 0.05}))
          .distortion(),
      ElementsAre(0.1, 0.02, 0.003, 0.004, 0.05, 0, 0, 0));
  EXPECT_THAT(std::get<RadialTangentialLens>(
                  make("radial-tangential", {0.1, 0.02, 0.003, 0.004, 0.05, 0.06, 0.07, 0.08}))
                  .distortion(),
              ElementsAre(0.1, 0.02, 0.003, 0.004, 0.05, 0.06, 0.07, 0.08));
  for (const std::size_t count : {0U, 1U, 2U, 3U, 6U, 7U, 9U, 12U}) {
    EXPECT_THAT(
        message_of([&] { (void)make("radial-tangential", std::vector<double>(count, 0.001)); }),
        AllOf(::testing::StartsWith("distortion: "),
              HasSubstr("4, 5 or 8"),
              HasSubstr("found " + std::to_string(count))));
  }
}

TEST(LensWordsTest, OtherCountsAreRefused) {
  const std::vector<std::pair<std::string, std::vector<std::size_t>>> wrong = {
      {"pinhole", {1, 4}},
      {"kannala-brandt", {0, 3, 5}},
      {"double-sphere", {0, 1, 3, 4}},
      {"extended-unified", {0, 1, 3, 4}}};
  for (const auto& [word, counts] : wrong) {
    for (const std::size_t count : counts) {
      EXPECT_THAT(
          message_of([&, word = word] { (void)make(word, std::vector<double>(count, 0.1)); }),
          AllOf(::testing::StartsWith("distortion: "), HasSubstr("found " + std::to_string(count))))
          << word;
    }
  }
}

TEST(LensWordsTest, AnUnknownWordIsAnsweredWithTheKnownOnes) {
  for (const std::string word : {"radtan", "fisheye", "Pinhole", ""}) {
    EXPECT_THAT(message_of([&] { (void)make(word, {}); }),
                AllOf(::testing::StartsWith("lens: "),
                      HasSubstr("pinhole"),
                      HasSubstr("radial-tangential"),
                      HasSubstr("kannala-brandt"),
                      HasSubstr("double-sphere"),
                      HasSubstr("extended-unified"),
                      HasSubstr("'" + word + "'")));
  }
}

TEST(LensWordsTest, NumbersOutsideTheDomainNameTheirKey) {
  EXPECT_THAT(message_of([] {
                (void)make_lens("pinhole", {-1.0, 1.0, 0.0, 0.0}, {});
              }),
              ::testing::StartsWith("intrinsics_px: "));
  EXPECT_THAT(message_of([] {
                (void)make("double-sphere", {-0.25, 1.5});
              }),
              ::testing::StartsWith("distortion: "));
  EXPECT_THAT(message_of([] {
                (void)make("extended-unified", {0.5, 0.0});
              }),
              ::testing::StartsWith("distortion: "));
  EXPECT_THAT(message_of([] {
                (void)make("radial-tangential", {-1e9, 0.0, 0.0, 0.0});
              }),
              ::testing::StartsWith("distortion: "));
}

TEST(LensWordsTest, ZerosThatMeanNothingAreLeftOut) {
  const auto numbers = [](const RadialTangentialLens::Distortion& k) {
    return distortion_numbers(RadialTangentialLens(kIntrinsics, k));
  };
  EXPECT_THAT(numbers({}), IsEmpty());
  EXPECT_THAT(numbers({0.1}), ElementsAre(0.1, 0, 0, 0));
  EXPECT_THAT(numbers({0, 0, 0, 0, 0.1}), ElementsAre(0, 0, 0, 0, 0.1));
  EXPECT_THAT(numbers({0.1, 0, 0, 0, 0, 0, 0, 0.2}), ElementsAre(0.1, 0, 0, 0, 0, 0, 0, 0.2));
  EXPECT_THAT(distortion_numbers(KannalaBrandtLens(kIntrinsics, {})), ElementsAre(0, 0, 0, 0));
}

TEST(LensWordsProperty, WordAndNumbersMakeTheSameLens) {
  for (const testing::ExampleLens& example : testing::example_lenses()) {
    const std::vector<double> numbers = distortion_numbers(example.lens);
    const Lens again = make_lens(lens_word(example.lens), intrinsics(example.lens), numbers);
    EXPECT_EQ(again.index(), example.lens.index()) << example.name;
    EXPECT_EQ(distortion_numbers(again), numbers) << example.name;
    EXPECT_EQ(max_angle_rad(again), max_angle_rad(example.lens)) << example.name;
    EXPECT_EQ(intrinsics(again).cx_px, intrinsics(example.lens).cx_px) << example.name;
  }
}

}  // namespace
}  // namespace skyhalo

#include "skyhalo/sim/texture.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "support/expect_error.hpp"

namespace skyhalo {
namespace {

using testing::message_of;

/// Two by two pixels: black, blue over green, red.
Texture four_colours() {
  cv::Mat3b picture(2, 2);
  picture(0, 0) = {0, 0, 0};
  picture(0, 1) = {255, 0, 0};
  picture(1, 0) = {0, 255, 0};
  picture(1, 1) = {0, 0, 255};
  return Texture(picture);
}

void expect_colour(const Eigen::Vector3f& got, const Eigen::Vector3f& expected) {
  EXPECT_LT((got - expected).cwiseAbs().maxCoeff(), 1e-3F) << got.transpose();
}

TEST(TextureTest, PixelsAreAtTheirMiddles) {
  const Texture texture = four_colours();
  EXPECT_EQ(texture.side_px(), 2);
  expect_colour(texture.at(0.25F, 0.25F, 0.0F), {0.0F, 0.0F, 0.0F});
  expect_colour(texture.at(0.75F, 0.25F, 0.0F), {1.0F, 0.0F, 0.0F});
  expect_colour(texture.at(0.25F, 0.75F, 0.0F), {0.0F, 1.0F, 0.0F});
  expect_colour(texture.at(0.75F, 0.75F, 0.0F), {0.0F, 0.0F, 1.0F});
  expect_colour(texture.at(0.5F, 0.25F, 0.0F), {0.5F, 0.0F, 0.0F});
}

TEST(TextureTest, ItRepeatsAndBlendsAcrossItsEdges) {
  const Texture texture = four_colours();
  expect_colour(texture.at(1.75F, 0.25F, 0.0F), {1.0F, 0.0F, 0.0F});
  expect_colour(texture.at(-0.25F, -0.75F, 0.0F), {1.0F, 0.0F, 0.0F});
  expect_colour(texture.at(0.0F, 0.25F, 0.0F), {0.5F, 0.0F, 0.0F});
  expect_colour(texture.at(0.25F, 1.0F, 0.0F), {0.0F, 0.5F, 0.0F});
}

TEST(TextureTest, AWideFootprintSeesTheMean) {
  const Eigen::Vector3f quarter = Eigen::Vector3f::Constant(0.25F);
  for (const float footprint : {1.0F, 5.0F, 1e9F}) {
    EXPECT_LT((four_colours().at(0.3F, 0.9F, footprint) - quarter).norm(), 0.01F) << footprint;
  }
}

TEST(TextureTest, APictureOfAnySizeBecomesASquare) {
  EXPECT_EQ(Texture(cv::Mat3b(3, 100, cv::Vec3b(1, 2, 3))).side_px(), 128);
  EXPECT_EQ(Texture(cv::Mat3b(1, 1, cv::Vec3b(1, 2, 3))).side_px(), 1);
  EXPECT_EQ(Texture(cv::Mat3b(5000, 10, cv::Vec3b(1, 2, 3))).side_px(), 2048);
  expect_colour(Texture(cv::Mat3b(3, 7, cv::Vec3b(51, 102, 204))).at(0.4F, 0.1F, 0.0F),
                {0.2F, 0.4F, 0.8F});
}

TEST(TextureTest, WhatIsNotFiniteIsTakenAsZero) {
  const Texture texture = four_colours();
  const Eigen::Vector3f origin = texture.at(0.0F, 0.0F, 0.0F);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  expect_colour(texture.at(nan, std::numeric_limits<float>::infinity(), 0.0F), origin);
  expect_colour(texture.at(0.1F, 0.2F, nan), texture.at(0.1F, 0.2F, 0.0F));
  expect_colour(texture.at(0.1F, 0.2F, -1.0F), texture.at(0.1F, 0.2F, 0.0F));
}

TEST(TextureTest, AnEmptyPictureIsRefused) {
  EXPECT_EQ(message_of([] { (void)Texture(cv::Mat3b()); }), "texture: the picture is empty");
}

}  // namespace
}  // namespace skyhalo

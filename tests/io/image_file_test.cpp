#include "skyhalo/io/image_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <string>
#include <vector>

#include "skyhalo/io/text_file.hpp"
#include "support/expect_error.hpp"
#include "support/temp_folder.hpp"
#include "support/textured_pair.hpp"

namespace skyhalo {
namespace {

using ::testing::HasSubstr;
using testing::message_of;
using testing::TempFolder;
using testing::texture;

cv::Mat random_image(int type, unsigned seed) {
  cv::Mat image(13, 17, type);
  cv::RNG random(seed);
  const double end = image.depth() == CV_16U ? 65536.0 : 256.0;
  random.fill(image, cv::RNG::UNIFORM, 0.0, end);
  return image;
}

std::string encoded(const std::string& ending, const cv::Mat& image) {
  std::vector<unsigned char> bytes;
  cv::imencode(ending, image, bytes);
  return {bytes.begin(), bytes.end()};
}

void expect_named(const TempFolder& folder, const std::string& bytes) {
  const auto file = folder.write("0000000007.png", bytes);
  EXPECT_THAT(message_of([&] { (void)read_image(file); }), HasSubstr(file.string()));
}

TEST(ImageFileTest, APngIsReadBackAsItWas) {
  const TempFolder folder;
  for (const int type : {CV_8UC1, CV_8UC3, CV_16UC1, CV_16UC3}) {
    SCOPED_TRACE(type);
    const cv::Mat image = random_image(type, 3);
    const auto file = folder.path() / "image.png";
    write_png(file, image);
    const cv::Mat again = read_image(file);
    ASSERT_EQ(again.type(), type);
    ASSERT_EQ(again.size(), image.size());
    EXPECT_EQ(cv::norm(again, image, cv::NORM_INF), 0.0);
  }
}

TEST(ImageFileTest, ColoursAreBlueGreenRed) {
  const TempFolder folder;
  const auto file = folder.path() / "image.png";
  write_png(file, cv::Mat(2, 2, CV_8UC3, cv::Scalar(10, 20, 30)));
  // A PNG holds red, green, blue; another reader that keeps this order must see 30, 20, 10.
  cv::Mat rgb = cv::imread(file.string(), cv::IMREAD_COLOR);
  EXPECT_EQ(rgb.at<cv::Vec3b>(0, 0), cv::Vec3b(10, 20, 30));
  EXPECT_EQ(read_image(file).at<cv::Vec3b>(1, 1), cv::Vec3b(10, 20, 30));
}

TEST(ImageFileTest, AFileCutOffAtAnyLengthIsRefused) {
  const TempFolder folder;
  const std::string bytes = encoded(".png", texture({40, 30}, 5));
  for (std::size_t length = 1; length < bytes.size(); length += 1 + bytes.size() / 60) {
    SCOPED_TRACE(length);
    expect_named(folder, bytes.substr(0, length));
  }
  for (const std::size_t missing : {1U, 4U, 11U, 12U, 13U, 20U}) {
    SCOPED_TRACE(missing);
    expect_named(folder, bytes.substr(0, bytes.size() - missing));
  }
}

TEST(ImageFileTest, AJpegThatIsCutOffIsRefused) {
  const TempFolder folder;
  const std::string bytes = encoded(".jpg", texture({40, 30}, 5));
  for (const std::size_t length : {bytes.size() / 4, bytes.size() / 2, bytes.size() - 2}) {
    SCOPED_TRACE(length);
    expect_named(folder, bytes.substr(0, length));
  }
}

TEST(ImageFileTest, ADamagedPngIsRefused) {
  const TempFolder folder;
  const std::string bytes = encoded(".png", texture({40, 30}, 5));
  const std::size_t data = bytes.find("IDAT") + 4;
  for (std::size_t at = data; at + 20 < bytes.size(); at += bytes.size() / 12) {
    SCOPED_TRACE(at);
    std::string damaged = bytes;
    damaged[at] = static_cast<char>(damaged[at] ^ 0x55);
    expect_named(folder, damaged);
  }
}

TEST(ImageFileTest, APngWithAHoleInItIsRefused) {
  const TempFolder folder;
  const std::string bytes = encoded(".png", texture({40, 30}, 5));
  expect_named(folder, bytes.substr(0, bytes.size() / 2) + bytes.substr(bytes.size() - 12));
}

TEST(ImageFileTest, WhatIsNoImageIsRefused) {
  const TempFolder folder;
  expect_named(folder, "");
  expect_named(folder, "these are words, not pixels\n");
  expect_named(folder, std::string(5000, '\0'));
  expect_named(folder, "\x89PNG\r\n\x1a\n");
}

TEST(ImageFileTest, AMissingFileOrAFolderIsRefused) {
  const TempFolder folder;
  const auto missing = folder.path() / "missing.png";
  EXPECT_THAT(message_of([&] { (void)read_image(missing); }), HasSubstr(missing.string()));
  EXPECT_THAT(message_of([&] { (void)read_image(folder.path()); }),
              HasSubstr(folder.path().string()));
}

TEST(ImageFileTest, AnImageThatCannotBeWrittenIsAFailure) {
  const TempFolder folder;
  const auto file = folder.path() / "no such folder" / "image.png";
  EXPECT_THAT(message_of(
                  [&] {
                    write_png(file, texture({4, 4}, 1));
                  },
                  ErrorKind::kFailure),
              HasSubstr(file.string()));
}

}  // namespace
}  // namespace skyhalo

#include "skyhalo/io/pfm_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <opencv2/core.hpp>
#include <string>

#include "skyhalo/io/text_file.hpp"
#include "support/expect_error.hpp"
#include "support/temp_folder.hpp"

namespace skyhalo {
namespace {

using ::testing::HasSubstr;
using testing::message_of;
using testing::TempFolder;

TEST(PfmFileTest, TheLastRowComesFirstLowByteFirst) {
  const TempFolder folder;
  cv::Mat1f image(2, 1);
  image << 1.0F, -2.0F;
  write_pfm(folder.path() / "a.pfm", image);
  // 1 = 3f800000, -2 = c0000000.
  EXPECT_EQ(read_bytes(folder.path() / "a.pfm"),
            std::string("Pf\n1 2\n-1.0\n\x00\x00\x00\xc0\x00\x00\x80\x3f", 20));
}

TEST(PfmFileTest, ValuesComeBackToTheLastBit) {
  const TempFolder folder;
  cv::Mat1f image(3, 5);
  cv::randu(image, -100.0F, 100.0F);
  image(1, 2) = std::numeric_limits<float>::quiet_NaN();
  image(2, 4) = std::numeric_limits<float>::infinity();
  write_pfm(folder.path() / "a.pfm", image);
  const cv::Mat1f back = read_pfm(folder.path() / "a.pfm");
  ASSERT_EQ(back.size(), image.size());
  for (int v = 0; v < image.rows; ++v) {
    for (int u = 0; u < image.cols; ++u) {
      EXPECT_TRUE(back(v, u) == image(v, u) || (v == 1 && u == 2 && std::isnan(back(v, u))));
    }
  }
}

TEST(PfmFileTest, TheOtherByteOrderIsRead) {
  const TempFolder folder;
  const auto file =
      folder.write("a.pfm", std::string("Pf\n2 1\n1.0\n\x3f\x80\x00\x00\xc0\x00\x00\x00", 19));
  const cv::Mat1f image = read_pfm(file);
  EXPECT_EQ(image(0, 0), 1.0F);
  EXPECT_EQ(image(0, 1), -2.0F);
}

TEST(PfmFileTest, WhatIsNoPfmIsRefused) {
  const TempFolder folder;
  const auto refused = [&](const std::string& bytes) {
    const auto file = folder.write("a.pfm", bytes);
    return message_of([&] { (void)read_pfm(file); });
  };
  for (const char* const bytes : {"", "PF\n1 1\n-1.0\n", "P5\n1 1\n255\n", "Pfx"}) {
    EXPECT_THAT(refused(bytes), HasSubstr("a.pfm: is no grey PFM image"));
  }
  for (const char* const bytes : {"Pf",
                                  "Pf\n",
                                  "Pf\n0 1\n-1.0\n",
                                  "Pf\n1 -1\n-1.0\n",
                                  "Pf\n1 99999999\n-1.0\n",
                                  "Pf\n1 1\n0\n",
                                  "Pf\n1 1\nnan\n",
                                  "Pf\n1 1"}) {
    EXPECT_THAT(refused(bytes), HasSubstr("expected a width and a height in 1...16384"));
  }
  EXPECT_THAT(refused("Pf\n1 1\n-1.0\n123"), HasSubstr("has 15 bytes, expected 16 for 1x1"));
  EXPECT_THAT(refused("Pf\n1 1\n-1.0\n12345"), HasSubstr("has 17 bytes"));
  EXPECT_THAT(message_of([&] { write_pfm(folder.path() / "b.pfm", {}); }, ErrorKind::kFailure),
              HasSubstr("b.pfm"));
}

}  // namespace
}  // namespace skyhalo

#include "skyhalo/dataset/image_pair.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <opencv2/core.hpp>

#include "skyhalo/io/image_file.hpp"
#include "support/expect_error.hpp"
#include "support/temp_folder.hpp"
#include "support/textured_pair.hpp"

namespace skyhalo {
namespace {

using ::testing::HasSubstr;
using testing::message_of;
using testing::TempFolder;
using testing::texture;

StereoPair some_pair() {
  StereoPair pair;
  pair.name = "wing";
  pair.model = PinholePair{
      .focal_px = 100.0, .principal_u_px = 16.0, .principal_v_px = 12.0, .baseline_m = 0.5};
  return pair;
}

TEST(ImagePairTest, IsARecordingOfOneFrameAtRest) {
  const TempFolder folder;
  const cv::Mat1b left = texture({32, 24}, 1);
  const cv::Mat1b right = texture({32, 24}, 2);
  write_png(folder.path() / "left.png", left);
  write_png(folder.path() / "right.png", right);
  const ImagePairSource source(
      folder.path() / "left.png", folder.path() / "right.png", some_pair());
  EXPECT_EQ(source.name(), "wing");
  EXPECT_EQ(source.frame_count(), 1);
  EXPECT_EQ(source.stamp(0), Timestamp{});
  EXPECT_TRUE(source.T_map_body(0).isApprox(Pose::Identity()));
  ASSERT_EQ(source.rig().pairs.size(), 1U);
  EXPECT_EQ(source.rig().pairs[0].image_size_px, cv::Size(32, 24));
  EXPECT_EQ(std::get<PinholePair>(source.rig().pairs[0].model).focal_px, 100.0);
  const FrameSet frames = source.read(0);
  ASSERT_EQ(frames.pairs.size(), 1U);
  EXPECT_EQ(cv::norm(frames.pairs[0].left, left, cv::NORM_INF), 0.0);
  EXPECT_EQ(cv::norm(frames.pairs[0].right, right, cv::NORM_INF), 0.0);
}

TEST(ImagePairTest, ReadingGivesImagesOfTheirOwn) {
  const TempFolder folder;
  write_png(folder.path() / "a.png", texture({8, 8}, 1));
  const ImagePairSource source(folder.path() / "a.png", folder.path() / "a.png", some_pair());
  const FrameSet first = source.read(0);
  cv::Mat changed = first.pairs[0].left;
  const unsigned char before = changed.at<unsigned char>(0, 0);
  changed.at<unsigned char>(0, 0) = static_cast<unsigned char>(before ^ 0xFF);
  EXPECT_EQ(source.read(0).pairs[0].left.at<unsigned char>(0, 0), before);
}

TEST(ImagePairTest, AnImageThatCannotBeUsedIsNamed) {
  const TempFolder folder;
  const auto good = folder.path() / "good.png";
  const auto small = folder.path() / "small.png";
  const auto missing = folder.path() / "missing.png";
  const auto damaged = folder.write("damaged.png", "no image");
  write_png(good, texture({32, 24}, 1));
  write_png(small, texture({31, 24}, 1));
  const auto open = [](const auto& left, const auto& right) {
    return message_of([&] { const ImagePairSource source(left, right, some_pair()); });
  };
  EXPECT_THAT(open(missing, good), HasSubstr(missing.string()));
  EXPECT_THAT(open(good, missing), HasSubstr(missing.string()));
  EXPECT_THAT(open(damaged, good), HasSubstr(damaged.string()));
  EXPECT_THAT(open(good, small), HasSubstr(small.string()));
}

}  // namespace
}  // namespace skyhalo

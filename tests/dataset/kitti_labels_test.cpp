#include "skyhalo/dataset/kitti_labels.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "reference/naive_oriented_box.hpp"
#include "support/expect_error.hpp"
#include "support/temp_folder.hpp"

namespace skyhalo {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using testing::message_of;
using testing::TempFolder;

constexpr double kPi = 3.14159265358979323846;

/// The words of a good line; a test may spoil one.
std::vector<std::string> good_words() {
  return {"2",
          "7",
          "Car",
          "0",
          "1",
          "-1.57",
          "100.5",
          "50",
          "200",
          "80",
          "1.5",
          "2",
          "4",
          "10",
          "1.75",
          "20",
          "0.25"};
}

std::string line_of(const std::vector<std::string>& words) {
  std::string line;
  for (const std::string& word : words) {
    line += (line.empty() ? "" : " ") + word;
  }
  return line + "\n";
}

std::string dont_care(int frame) {
  return std::to_string(frame) + " -1 DontCare -1 -1 -10 1 2 3 4 -1000 -1000 -1000 -10 -1 -1 -1\n";
}

/// All eight corners of a box.
std::vector<Eigen::Vector3d> corners_of(const OrientedBox& box) {
  std::vector<Eigen::Vector3d> corners;
  corners.reserve(8);
  for (int i = 0; i < 8; ++i) {
    corners.emplace_back(box.corner_m + box.edges_m * Eigen::Vector3d(i & 1, i >> 1 & 1, i >> 2));
  }
  return corners;
}

bool holds_corner(const std::vector<Eigen::Vector3d>& corners, const Eigen::Vector3d& corner) {
  return std::any_of(corners.begin(), corners.end(), [&](const Eigen::Vector3d& other) {
    return (other - corner).norm() < 1e-9;
  });
}

TEST(KittiLabelsTest, ReadsObjectsFrameByFrame) {
  const TempFolder folder;
  const TrackLabels labels(
      folder.write("0003.txt",
                   "0 1 Van 0 0 0 0 0 1 1 2 2 5 0 2 9 0\n" + dont_care(0) + line_of(good_words()) +
                       "2 8 Pedestrian 0 0 0 0 0 1 1 1.8 0.5 0.5 -3 1.7 8 0\n"));
  ASSERT_EQ(labels.objects(0).size(), 1U);
  EXPECT_EQ(labels.objects(0)[0].type, "Van");
  EXPECT_TRUE(labels.objects(1).empty());
  ASSERT_EQ(labels.objects(2).size(), 2U);
  EXPECT_EQ(labels.objects(2)[0].frame, 2);
  EXPECT_EQ(labels.objects(2)[0].track, 7);
  EXPECT_EQ(labels.objects(2)[0].type, "Car");
  EXPECT_EQ(labels.objects(2)[1].track, 8);
  EXPECT_EQ(labels.last_frame(), 2);
  EXPECT_EQ(labels.last_frame_line(), 3);
}

TEST(KittiLabelsTest, OutsideTheLabelledFramesThereIsNothing) {
  const TempFolder folder;
  const TrackLabels labels(folder.write("0003.txt", line_of(good_words())));
  EXPECT_TRUE(labels.objects(-1).empty());
  EXPECT_TRUE(labels.objects(3).empty());
  EXPECT_TRUE(labels.objects(1000000000).empty());
  EXPECT_TRUE(TrackLabels().objects(0).empty());
}

TEST(KittiLabelsTest, AnEmptyFileHasNoFrames) {
  const TempFolder folder;
  for (const std::string text : {"", "\n", " \r\n\n"}) {
    const TrackLabels labels(folder.write("0003.txt", text));
    EXPECT_EQ(labels.last_frame(), -1);
    EXPECT_EQ(labels.last_frame_line(), 0);
    EXPECT_TRUE(labels.objects(0).empty());
  }
}

TEST(KittiLabelsTest, RegionsThatDoNotCountAreLeftOut) {
  const TempFolder folder;
  const TrackLabels labels(
      folder.write("0003.txt", dont_care(0) + "\n" + dont_care(5) + dont_care(5)));
  EXPECT_TRUE(labels.objects(0).empty());
  EXPECT_TRUE(labels.objects(5).empty());
  EXPECT_EQ(labels.last_frame(), 5);
  EXPECT_EQ(labels.last_frame_line(), 3);
}

TEST(KittiLabelsTest, AScoreIsAllowed) {
  const TempFolder folder;
  std::vector<std::string> words = good_words();
  words.emplace_back("0.875");
  const TrackLabels labels(folder.write("0003.txt", line_of(words)));
  EXPECT_EQ(labels.objects(2).size(), 1U);
}

TEST(KittiLabelsTest, TheOrderOfFramesDoesNotMatter) {
  const TempFolder folder;
  const TrackLabels labels(folder.write("0003.txt", dont_care(4) + line_of(good_words())));
  EXPECT_EQ(labels.objects(2).size(), 1U);
  EXPECT_EQ(labels.last_frame(), 4);
  EXPECT_EQ(labels.last_frame_line(), 1);
}

TEST(KittiLabelsTest, ReadsWindowsLines) {
  const TempFolder folder;
  std::string line = line_of(good_words());
  line.insert(line.size() - 1, "\r");
  const TrackLabels labels(folder.write("0003.txt", line));
  EXPECT_EQ(labels.objects(2).size(), 1U);
}

TEST(KittiLabelsTest, AWrongNumberOfColumnsIsRefused) {
  const TempFolder folder;
  const std::string words = "2 7 Car 0 1 0 1 2 3 4 1.5 2 4 10 1.75 20";
  for (const std::string& bad :
       {words, words + " 0 0.5 7", std::string("2"), std::string("word")}) {
    SCOPED_TRACE(bad);
    const auto file = folder.write("0003.txt", dont_care(0) + bad + "\n");
    EXPECT_THAT(message_of([&] { const TrackLabels labels(file); }),
                HasSubstr(file.string() + ":2:"));
  }
}

TEST(KittiLabelsTest, AWordThatIsNoNumberIsRefused) {
  const TempFolder folder;
  for (std::size_t column = 0; column < 18; ++column) {
    if (column == 2) {
      continue;  // the type
    }
    for (const std::string bad : {"x", "nan", "1e999", "1.5m"}) {
      SCOPED_TRACE("column " + std::to_string(column + 1) + ": " + bad);
      std::vector<std::string> words = good_words();
      words.emplace_back("0.5");
      words[column] = bad;
      const auto file = folder.write("0003.txt", "\n" + line_of(words));
      EXPECT_THAT(message_of([&] { const TrackLabels labels(file); }),
                  AllOf(HasSubstr(file.string() + ":2:"), HasSubstr(bad)));
    }
  }
}

TEST(KittiLabelsTest, AFrameThatIsNoFrameIsRefused) {
  const TempFolder folder;
  for (const std::string bad : {"-1", "1.5", "99999999999", "2000000000"}) {
    SCOPED_TRACE(bad);
    std::vector<std::string> words = good_words();
    words[0] = bad;
    const auto file = folder.write("0003.txt", line_of(words));
    EXPECT_THAT(message_of([&] { const TrackLabels labels(file); }),
                HasSubstr(file.string() + ":1:"));
  }
}

TEST(KittiLabelsTest, ABoxWithoutExtentIsRefused) {
  const TempFolder folder;
  for (std::size_t column = 10; column < 13; ++column) {
    for (const std::string bad : {"0", "-1", "-0.0"}) {
      SCOPED_TRACE("column " + std::to_string(column + 1) + ": " + bad);
      std::vector<std::string> words = good_words();
      words[column] = bad;
      const auto file = folder.write("0003.txt", dont_care(1) + dont_care(1) + line_of(words));
      EXPECT_THAT(message_of([&] { const TrackLabels labels(file); }),
                  HasSubstr(file.string() + ":3:"));
    }
  }
}

TEST(KittiLabelsTest, AMissingFileIsNamed) {
  const TempFolder folder;
  const auto file = folder.path() / "0003.txt";
  EXPECT_THAT(message_of([&] { const TrackLabels labels(file); }), HasSubstr(file.string()));
}

TEST(KittiLabelsTest, ABoxStandsOnItsBottomCentre) {
  // 1.5 high, 2 wide, 4 long at (10, 1.75, 20): x 8...12, y (down) 0.25...1.75, z 19...21.
  const OrientedBox box = to_oriented_box({1.5, 2.0, 4.0, {10.0, 1.75, 20.0}, 0.0});
  EXPECT_TRUE(contains(box, {8.01, 0.26, 19.01}));
  EXPECT_TRUE(contains(box, {11.99, 1.74, 20.99}));
  EXPECT_FALSE(contains(box, {7.99, 1.0, 20.0}));
  EXPECT_FALSE(contains(box, {10.0, 1.76, 20.0}));
  EXPECT_FALSE(contains(box, {10.0, 0.24, 20.0}));
  EXPECT_FALSE(contains(box, {10.0, 1.0, 21.01}));
}

TEST(KittiLabelsTest, ABoxTurnsAboutTheCamerasYAxis) {
  // rotation_y = 30 deg takes the length axis (1, 0, 0) to (cos 30, 0, -sin 30): its front is at
  // the right and nearer.
  const OrientedBox box = to_oriented_box({1.0, 0.2, 4.0, {0.0, 0.0, 10.0}, kPi / 6.0});
  EXPECT_TRUE(contains(box, {1.9 * std::cos(kPi / 6.0), -0.5, 10.0 - 1.9 * 0.5}));
  EXPECT_FALSE(contains(box, {1.9 * std::cos(kPi / 6.0), -0.5, 10.0 + 1.9 * 0.5}));
}

class RandomBoxes {
 public:
  reference::NaiveBox next() {
    return {size_(random_),
            size_(random_),
            size_(random_),
            place_(random_),
            place_(random_),
            place_(random_),
            angle_(random_)};
  }

  Eigen::Vector3d near(const reference::NaiveBox& box) {
    return Eigen::Vector3d(box.x_m, box.y_m - 0.5 * box.h_m, box.z_m) +
           0.7 * Eigen::Vector3d(offset_(random_), offset_(random_), offset_(random_));
  }

 private:
  std::mt19937 random_{12};
  std::uniform_real_distribution<double> size_{0.3, 6.0};
  std::uniform_real_distribution<double> place_{-30.0, 30.0};
  std::uniform_real_distribution<double> angle_{-kPi, kPi};
  std::uniform_real_distribution<double> offset_{-6.0, 6.0};
};

OrientedBox box_of(const reference::NaiveBox& box) {
  return to_oriented_box(
      {box.h_m, box.w_m, box.l_m, {box.x_m, box.y_m, box.z_m}, box.rotation_y_rad});
}

TEST(KittiLabelsReference, CornersAreThoseOfTheDevelopmentKit) {
  RandomBoxes boxes;
  for (int round = 0; round < 200; ++round) {
    const reference::NaiveBox box = boxes.next();
    const std::vector<Eigen::Vector3d> corners = corners_of(box_of(box));
    for (const auto& corner : reference::naive_box_corners(box)) {
      EXPECT_TRUE(holds_corner(corners, {corner[0], corner[1], corner[2]}));
    }
  }
}

TEST(KittiLabelsReference, ABoxHoldsTheSamePoints) {
  RandomBoxes boxes;
  int inside = 0;
  for (int round = 0; round < 5000; ++round) {
    const reference::NaiveBox box = boxes.next();
    const Eigen::Vector3d p_m = boxes.near(box);
    const bool expected = reference::naive_inside_box(box, {p_m.x(), p_m.y(), p_m.z()});
    EXPECT_EQ(contains(box_of(box), p_m), expected);
    inside += expected ? 1 : 0;
  }
  EXPECT_GT(inside, 100);
  EXPECT_LT(inside, 4900);
}

}  // namespace
}  // namespace skyhalo

// `skyhalo disparity` as its users see it: the two files, the summary, and how it ends.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <opencv2/core.hpp>
#include <string>
#include <utility>
#include <vector>

#include "skyhalo/io/image_file.hpp"
#include "skyhalo/io/text_file.hpp"
#include "support/program.hpp"
#include "support/recorded_data.hpp"
#include "support/temp_folder.hpp"
#include "support/textured_pair.hpp"

namespace skyhalo {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using ::testing::AllOf;
using testing::Arguments;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using testing::operator+;
using testing::ProgramResult;
using testing::TempFolder;
using testing::texture;
using testing::textured_pair;
using testing::TexturedPair;

constexpr int kFarPx = 8;
constexpr int kNearPx = 24;
const cv::Rect kNearInRight(80, 40, 70, 60);
const cv::Rect kNearInLeft(80 + kNearPx, 40, 70, 60);

/// A plane at `kFarPx` with a rectangle at `kNearPx` before it.
TexturedPair two_planes() {
  TexturedPair pair = textured_pair({240, 140}, kFarPx, 3);
  const cv::Mat1b near_texture = texture(kNearInRight.size(), 4);
  near_texture.copyTo(pair.left(kNearInLeft));
  near_texture.copyTo(pair.right(kNearInRight));
  return pair;
}

/// The rectangle without its outermost pixels, which the matcher may give to either side.
cv::Rect inside(const cv::Rect& all, int margin_px) {
  return {
      all.x + margin_px, all.y + margin_px, all.width - 2 * margin_px, all.height - 2 * margin_px};
}

/// The share of a disparity image's pixels that are within a quarter of a pixel of `disparity_px`.
double share_at(const cv::Mat& image, double disparity_px) {
  const cv::Mat1w units = image;
  const auto found = std::count_if(units.begin(), units.end(), [&](std::uint16_t unit) {
    return unit > 0 && std::abs(unit / 256.0 - disparity_px) <= 0.25;
  });
  return static_cast<double>(found) / static_cast<double>(units.total());
}

cv::Mat colour_of(const cv::Mat& grey) {
  const std::vector<cv::Mat> channels(3, grey);
  cv::Mat colour;
  cv::merge(channels, colour);
  return colour;
}

cv::Mat wide_of(const cv::Mat& grey) {
  cv::Mat wide;
  grey.convertTo(wide, CV_16U, 200.0, 700.0);
  return wide;
}

class DisparityCommandSystem : public ::testing::Test {
 protected:
  void SetUp() override { store(two_planes().left, two_planes().right); }

  void store(const cv::Mat& left_image, const cv::Mat& right_image) const {
    write_png(left, left_image);
    write_png(right, right_image);
  }

  [[nodiscard]] ProgramResult run(const Arguments& arguments) const {
    return testing::run_program(SKYHALO_PROGRAM, Arguments{"disparity"} + arguments, logs.path());
  }

  /// The pair as stored, with more options.
  [[nodiscard]] ProgramResult match(const Arguments& more = {}) const {
    return run(Arguments{left, right, "-o", out} + more);
  }

  /// The summary of a run that ends well; the image is at `out`.
  [[nodiscard]] json summary(const Arguments& more = {}) const {
    const ProgramResult result = match(more + Arguments{"--json", "--quiet"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return json::parse(result.out, nullptr, false);
  }

  /// The disparities of a run that ends well.
  [[nodiscard]] cv::Mat disparities(const Arguments& more = {}) const {
    const ProgramResult result = match(more);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    cv::Mat image = read_image(out);
    EXPECT_EQ(image.type(), CV_16UC1);
    return image;
  }

  void expect_refused(const ProgramResult& result,
                      int exit_code,
                      const std::vector<std::string>& words) const {
    EXPECT_EQ(result.exit_code, exit_code);
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
    EXPECT_THAT(result.out, IsEmpty());
    for (const std::string& word : words) {
      EXPECT_THAT(result.err, HasSubstr(word));
    }
    EXPECT_FALSE(fs::exists(out));
  }

  [[nodiscard]] std::string place(const std::string& name) const {
    return (folder.path() / name).string();
  }

  TempFolder folder;
  TempFolder logs;
  std::string left = place("left.png");
  std::string right = place("right.png");
  std::string out = place("out.png");
};

// --- what is written ---

TEST_F(DisparityCommandSystem, DisparitiesBelongToTheRightImage) {
  const cv::Mat image = disparities();
  ASSERT_EQ(image.size(), cv::Size(240, 140));
  EXPECT_GT(share_at(image(inside(kNearInRight, 5)), kNearPx), 0.98);
  EXPECT_GT(share_at(image(cv::Rect(5, 5, 60, 130)), kFarPx), 0.98);
  EXPECT_GT(share_at(image(cv::Rect(172, 5, 55, 130)), kFarPx), 0.98);
}

TEST_F(DisparityCommandSystem, DisparitiesBelongToTheLeftImageIfAskedFor) {
  const cv::Mat image = disparities({"--align", "left"});
  EXPECT_GT(share_at(image(inside(kNearInLeft, 5)), kNearPx), 0.98);
  EXPECT_GT(share_at(image(cv::Rect(15, 5, 60, 130)), kFarPx), 0.98);
  EXPECT_GT(share_at(image(cv::Rect(184, 5, 50, 130)), kFarPx), 0.98);
}

TEST_F(DisparityCommandSystem, BothEnginesMatch) {
  EXPECT_EQ(summary({"--matcher", "opencv"})["matcher"], "opencv");
  const cv::Mat opencv = disparities({"--matcher", "opencv"});
  EXPECT_GT(share_at(opencv(inside(kNearInRight, 8)), kNearPx), 0.9);
  EXPECT_GT(cv::norm(opencv, disparities(), cv::NORM_L1), 0.0);
}

TEST_F(DisparityCommandSystem, TheDepthAndTheColoursDoNotMatter) {
  const TexturedPair pair = two_planes();
  const cv::Mat grey = disparities();
  store(colour_of(pair.left), colour_of(pair.right));
  EXPECT_EQ(cv::norm(disparities(), grey, cv::NORM_INF), 0.0);
  store(wide_of(pair.left), wide_of(pair.right));
  const cv::Mat wide = disparities();
  EXPECT_GT(share_at(wide(inside(kNearInRight, 5)), kNearPx), 0.98);
  store(colour_of(wide_of(pair.left)), colour_of(wide_of(pair.right)));
  EXPECT_EQ(cv::norm(disparities(), wide, cv::NORM_INF), 0.0);
}

TEST_F(DisparityCommandSystem, ShrunkImagesGiveDisparitiesOfTheInput) {
  const cv::Mat image = disparities({"--downscale", "2"});
  ASSERT_EQ(image.size(), cv::Size(240, 140));
  EXPECT_GT(share_at(image(inside(kNearInRight, 10)), kNearPx), 0.95);
  EXPECT_GT(share_at(image(cv::Rect(10, 10, 50, 120)), kFarPx), 0.95);
  for (int v = 0; v < image.rows; v += 2) {
    for (int u = 0; u < image.cols; u += 2) {
      const cv::Mat1w block = image(cv::Rect(u, v, 2, 2));
      EXPECT_EQ(cv::countNonZero(block != block(0, 0)), 0) << u << " " << v;
    }
  }
}

TEST_F(DisparityCommandSystem, WhatIsBeyondTheLastWholeBlockHasNone) {
  const TexturedPair pair = textured_pair({203, 77}, 12, 9);
  store(pair.left, pair.right);
  const cv::Mat odd = disparities();
  ASSERT_EQ(odd.size(), cv::Size(203, 77));
  EXPECT_GT(share_at(odd(cv::Rect(0, 0, 180, 77)), 12.0), 0.9);
  const cv::Mat image = disparities({"--downscale", "3"});
  ASSERT_EQ(image.size(), cv::Size(203, 77));
  EXPECT_EQ(cv::countNonZero(image.colRange(201, 203)), 0);
  EXPECT_EQ(cv::countNonZero(image.rowRange(75, 77)), 0);
  EXPECT_GT(share_at(image(cv::Rect(6, 6, 150, 69)), 12.0), 0.9);
}

TEST_F(DisparityCommandSystem, ADisparityOfZeroIsNotNone) {
  const cv::Mat1b image = texture({120, 60}, 5);
  store(image, image);
  const cv::Mat found = disparities();
  EXPECT_GT(cv::countNonZero(found), 0.9 * 120 * 60);
  EXPECT_GT(cv::countNonZero(found == 1), 0.5 * 120 * 60);
}

TEST_F(DisparityCommandSystem, DisparitiesThatAreTooLargeAreClippedAloud) {
  const TexturedPair pair = textured_pair({1000, 120}, 280, 6);
  store(pair.left, pair.right);
  const ProgramResult result = match({"--downscale", "4", "--max-disparity", "320"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_THAT(result.err, HasSubstr("warning"));
  const cv::Mat1w image = read_image(out);
  EXPECT_GT(cv::countNonZero(image == 65535), 0.9 * 680 * 120);
}

TEST_F(DisparityCommandSystem, ThePictureIsBlackWhereThereIsNone) {
  const std::string picture_file = place("picture.png");
  // A search that leaves out the near rectangle, so that it has none.
  const json result = summary({"--picture", picture_file, "--max-disparity", "16"});
  EXPECT_EQ(result["picture"], picture_file);
  const cv::Mat3b picture = read_image(picture_file);
  const cv::Mat1w image = read_image(out);
  ASSERT_EQ(picture.size(), image.size());
  int none = 0;
  for (int v = 0; v < image.rows; ++v) {
    for (int u = 0; u < image.cols; ++u) {
      const bool black = picture(v, u) == cv::Vec3b(0, 0, 0);
      ASSERT_EQ(black, image(v, u) == 0) << u << " " << v;
      none += black ? 1 : 0;
    }
  }
  EXPECT_GT(none, 0);
}

TEST_F(DisparityCommandSystem, ThePictureIsWarmWhereItIsNear) {
  ASSERT_EQ(match({"--picture", place("picture.png")}).exit_code, 0);
  const cv::Mat3b picture = read_image(place("picture.png"));
  const cv::Vec3b& near_colour = picture(70, 115);
  const cv::Vec3b& far_colour = picture(70, 30);
  EXPECT_GT(near_colour[2], near_colour[0]) << "more red than blue";
  EXPECT_LT(far_colour[2], far_colour[0]);
}

TEST_F(DisparityCommandSystem, EarlierResultsAreReplaced) {
  (void)folder.write("out.png", "old");
  EXPECT_EQ(disparities().size(), cv::Size(240, 140));
}

TEST_F(DisparityCommandSystem, TheNumberOfThreadsDoesNotChangeTheResult) {
  for (const std::string engine : {"sgm", "opencv"}) {
    const cv::Mat one = disparities({"--matcher", engine, "--threads", "1"});
    const cv::Mat two = disparities({"--matcher", engine, "--threads", "2"});
    EXPECT_EQ(cv::norm(one, two, cv::NORM_INF), 0.0) << engine;
  }
}

// --- what is printed ---

TEST_F(DisparityCommandSystem, TheSummarySaysHowItWasDone) {
  const json result = summary({"--repeat", "3", "--align", "left", "--threads", "1"});
  EXPECT_EQ(result["matcher"], "sgm");
  EXPECT_EQ(result["size_px"], json({240, 140}));
  EXPECT_EQ(result["max_disparity_px"], 64);
  EXPECT_EQ(result["downscale"], 1);
  EXPECT_EQ(result["align"], "left");
  EXPECT_EQ(result["threads"], 1);
  EXPECT_EQ(result["repeat"], 3);
  EXPECT_GT(result["match_ms"].get<double>(), 0.0);
  EXPECT_EQ(result["out"], out);
  EXPECT_FALSE(result.contains("picture"));
  const double density = cv::countNonZero(read_image(out)) / (240.0 * 140.0);
  EXPECT_NEAR(result["density"].get<double>(), density, 1e-9);
  EXPECT_GT(density, 0.5);
}

TEST_F(DisparityCommandSystem, ThereIsATextForPeople) {
  const ProgramResult result = match({"--repeat", "2", "--json"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_THAT(result.out,
              AllOf(HasSubstr("240 x 140"),
                    HasSubstr("right image"),
                    HasSubstr("ms a match (median of 2)"),
                    HasSubstr("% of the pixels"),
                    HasSubstr(out)));
  EXPECT_THAT(result.err, IsEmpty());
  const std::size_t last = result.out.find_last_of('\n', result.out.size() - 2);
  EXPECT_TRUE(json::parse(result.out.substr(last + 1), nullptr, false).is_object());
}

TEST_F(DisparityCommandSystem, QuietPrintsNothing) {
  const ProgramResult result = match({"--quiet"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_THAT(result.out + result.err, IsEmpty());
  EXPECT_TRUE(fs::exists(out));
}

TEST_F(DisparityCommandSystem, HelpExplainsTheOptionsAndTheFile) {
  const ProgramResult result = run({"--help"});
  EXPECT_EQ(result.exit_code, 0);
  for (const std::string word : {"LEFT",
                                 "RIGHT",
                                 "--out",
                                 "--max-disparity",
                                 "--downscale",
                                 "--align",
                                 "--matcher",
                                 "--repeat",
                                 "--picture",
                                 "--config",
                                 "--set",
                                 "--threads",
                                 "--json",
                                 "--quiet",
                                 "256 times",
                                 "multiple of 16"}) {
    EXPECT_THAT(result.out, HasSubstr(word));
  }
}

// --- the search range ---

TEST_F(DisparityCommandSystem, TheRangeIsInPixelsOfTheInputAndRoundedUp) {
  const auto range = [&](const std::string& range_px, const std::string& factor) {
    return summary({"--max-disparity", range_px, "--downscale", factor})["max_disparity_px"];
  };
  EXPECT_EQ(range("1", "1"), 16);
  EXPECT_EQ(range("16", "1"), 16);
  EXPECT_EQ(range("17", "1"), 32);
  EXPECT_EQ(range("64", "2"), 64);
  EXPECT_EQ(range("65", "2"), 96);  // 32.5 of the matched image: 48
  EXPECT_EQ(range("64", "3"), 96);  // 21.3: 32
  EXPECT_EQ(range("192", "4"), 192);
}

TEST_F(DisparityCommandSystem, WhatIsBeyondTheRangeIsNotFound) {
  const cv::Mat image = disparities({"--max-disparity", "16"});
  EXPECT_EQ(share_at(image, kNearPx), 0.0);
  EXPECT_EQ(cv::countNonZero(image >= 16 * 256), 0);
  EXPECT_GT(share_at(image(cv::Rect(5, 5, 60, 130)), kFarPx), 0.98);
}

TEST_F(DisparityCommandSystem, SettingsAreTheDefaults) {
  const Arguments set{"--set", "matching.max_disparity_px=32", "--set", "matching.matcher=opencv"};
  json result = summary(set);
  EXPECT_EQ(result["max_disparity_px"], 32);
  EXPECT_EQ(result["matcher"], "opencv");
  result = summary(set + Arguments{"--matcher", "sgm", "--max-disparity", "48"});
  EXPECT_EQ(result["max_disparity_px"], 48);
  EXPECT_EQ(result["matcher"], "sgm");
  const auto file = folder.write("c.yaml", "matching:\n  max_disparity_px: 80\n  downscale: 4\n");
  result = summary({"--config", file.string(), "--downscale", "2"});
  EXPECT_EQ(result["max_disparity_px"], 96);  // 80 of the input are 40 when matched: 48
  EXPECT_EQ(summary({"--config", file.string()})["downscale"], 1);
}

TEST_F(DisparityCommandSystem, SettingsOfTheEngineAreUsed) {
  // Without fill and median, and every doubt thrown out, fewer pixels are left.
  const double usual = summary()["density"];
  const double strict =
      summary({"--set", "sgm.fill_min_px=26", "--set", "sgm.left_right_px=0"})["density"];
  EXPECT_LT(strict, usual);
}

// --- how it ends when something is wrong ---

TEST_F(DisparityCommandSystem, WrongUsageEndsWithTwo) {
  for (const Arguments& wrong : std::vector<Arguments>{{},
                                                       {left},
                                                       {left, right},
                                                       {left, right, left, "-o", out},
                                                       {left, right, "-o", out, "--paint"}}) {
    EXPECT_EQ(run(wrong).exit_code, 2) << ::testing::PrintToString(wrong);
  }
  for (const Arguments& wrong : std::vector<Arguments>{{"--max-disparity", "0"},
                                                       {"--max-disparity", "-16"},
                                                       {"--max-disparity", "4097"},
                                                       {"--max-disparity", "many"},
                                                       {"--max-disparity", "16.5"},
                                                       {"--downscale", "0"},
                                                       {"--downscale", "17"},
                                                       {"--downscale", "1.5"},
                                                       {"--align", "middle"},
                                                       {"--matcher", "bm"},
                                                       {"--repeat", "0"},
                                                       {"--repeat", "-1"},
                                                       {"--threads", "0"}}) {
    const ProgramResult result = match(wrong);
    EXPECT_EQ(result.exit_code, 2) << ::testing::PrintToString(wrong);
    EXPECT_THAT(result.err, HasSubstr(wrong[0]));
    EXPECT_FALSE(fs::exists(out));
  }
  expect_refused(match({"--max-disparity", "257"}), 2, {"--max-disparity 257", "256"});
  expect_refused(match({"--max-disparity", "600", "--downscale", "2"}), 2, {"512"});
}

TEST_F(DisparityCommandSystem, OnlyPngFilesAreWritten) {
  for (const std::string name : {"out.tif", "out", "out.png.txt", ".png", "png"}) {
    expect_refused(run({left, right, "-o", place(name)}), 2, {place(name), ".png"});
    EXPECT_FALSE(fs::exists(place(name)));
  }
  expect_refused(match({"--picture", place("p.jpg")}), 2, {"--picture", "p.jpg", ".png"});
  EXPECT_EQ(run({left, right, "-o", place("OUT.PNG")}).exit_code, 0);
}

TEST_F(DisparityCommandSystem, NothingIsWrittenOverAnother) {
  const std::string before = read_bytes(right);
  expect_refused(run({left, right, "-o", right}), 2, {right});
  expect_refused(match({"--picture", left}), 2, {left});
  const std::string roundabout = place("") + "./right.png";
  expect_refused(run({left, right, "-o", roundabout}), 2, {right});
  EXPECT_EQ(read_bytes(right), before);
  expect_refused(match({"--picture", out}), 2, {"--out", "--picture", out});
}

TEST_F(DisparityCommandSystem, WrongImagesAreNamed) {
  const auto refuse = [&](const std::string& file, const std::string& word) {
    expect_refused(run({file, right, "-o", out}), 3, {"skyhalo: " + file + ": ", word});
    expect_refused(run({left, file, "-o", out}), 3, {"skyhalo: " + file + ": ", word});
  };
  const std::string good = read_bytes(left);
  refuse(place("missing.png"), "no such file");
  refuse(folder.path().string(), "folder");
  refuse(folder.write("empty.png", "").string(), "empty");
  refuse(folder.write("text.png", "no image").string(), "no image");
  refuse(folder.write("half.png", good.substr(0, good.size() / 2)).string(), "cut off");
}

TEST_F(DisparityCommandSystem, ImagesThatAreNotAlikeAreNamed) {
  const TexturedPair pair = two_planes();
  store(pair.left, pair.right.colRange(0, 239));
  expect_refused(match(), 3, {"skyhalo: " + right + ": has 239x140", "240x140", left});
  store(pair.left, pair.right.rowRange(0, 100));
  expect_refused(match(), 3, {"skyhalo: " + right + ": has 240x100"});
  store(pair.left, colour_of(pair.right));
  expect_refused(match(), 3, {"skyhalo: " + right + ": is 8-bit colour", "8-bit grey", left});
  store(wide_of(pair.left), pair.right);
  expect_refused(match(), 3, {"skyhalo: " + right + ": is 8-bit grey", "16-bit grey"});
}

TEST_F(DisparityCommandSystem, ImagesTooSmallForTheSearchAreNamed) {
  const TexturedPair pair = textured_pair({64, 30}, 4, 8);
  store(pair.left, pair.right);
  const std::string named = "skyhalo: " + left + ": ";
  expect_refused(match(), 3, {named, "64 disparities", "--max-disparity can be 48"});
  expect_refused(match({"--downscale", "2"}), 3, {named, "32x15", "--max-disparity can be 32"});
  expect_refused(match({"--downscale", "4", "--max-disparity", "1"}), 3, {named, "16x7"});
  EXPECT_EQ(match({"--max-disparity", "48"}).exit_code, 0);
  EXPECT_EQ(match({"--downscale", "2", "--max-disparity", "32"}).exit_code, 0);
  fs::remove(out);
  const TexturedPair low = textured_pair({200, 3}, 4, 8);
  store(low.left, low.right);
  const ProgramResult refused = match({"--downscale", "4", "--max-disparity", "64"});
  expect_refused(refused, 3, {named, "50x0"});
  EXPECT_THAT(refused.err, Not(HasSubstr("can be")));
  EXPECT_EQ(match().exit_code, 0) << "three rows are a picture";
}

TEST_F(DisparityCommandSystem, WrongSettingsAreNamed) {
  expect_refused(match({"--set", "matching.max_disparity_px=20"}), 3, {"max_disparity_px"});
  expect_refused(match({"--set", "sgm.p3=1"}), 3, {"sgm.p3"});
  expect_refused(match({"--config", place("none.yaml")}), 3, {place("none.yaml")});
}

TEST_F(DisparityCommandSystem, AnOutputThatCannotBeWrittenIsAFailure) {
  const std::string missing = place("none/out.png");
  expect_refused(run({left, right, "-o", missing}), 1, {missing, "folder"});
  const std::string picture = place("none/picture.png");
  expect_refused(match({"--picture", picture}), 1, {picture, "folder"});
  expect_refused(run({left, right, "-o", left + "/out.png"}), 1, {left + "/out.png"});
  fs::create_directory(place("taken.png"));
  expect_refused(match({"--picture", place("taken.png")}), 1, {place("taken.png")});
}

TEST_F(DisparityCommandSystem, AFailureLeavesEarlierResultsAlone) {
  (void)folder.write("out.png", "old");
  store(two_planes().left, texture({100, 100}, 1));
  EXPECT_EQ(match().exit_code, 3);
  EXPECT_EQ(read_bytes(out), "old");
}

// --- a real pair ---

/// The share of the pixels with a disparity that are off by more than 1 px; the truth is a grey
/// picture stored in colour, in quarters of a pixel, 0 where it is not known.
double bad_share(const cv::Mat1w& found, const cv::Mat& truth) {
  cv::Mat1b truth_quarters;
  cv::extractChannel(truth, truth_quarters, 0);
  int compared = 0;
  int bad = 0;
  for (int v = 0; v < found.rows; ++v) {
    for (int u = 0; u < found.cols; ++u) {
      if (found(v, u) > 0 && truth_quarters(v, u) > 0) {
        ++compared;
        bad += std::abs(found(v, u) / 256.0 - truth_quarters(v, u) / 4.0) > 1.0 ? 1 : 0;
      }
    }
  }
  return static_cast<double>(bad) / compared;
}

TEST_F(DisparityCommandSystem, ConesComeOutRight) {
  const fs::path cones = testing::recorded_data() / "middlebury/cones";
  SKYHALO_SKIP_WITHOUT(cones);
  const std::string left_file = (cones / "im2.png").string();
  const std::string right_file = (cones / "im6.png").string();
  for (const auto& [align, truth] : {std::pair{"right", "disp6.png"}, {"left", "disp2.png"}}) {
    SCOPED_TRACE(align);
    const ProgramResult result =
        run({left_file, right_file, "-o", out, "--align", align, "--json", "--quiet"});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_GT(json::parse(result.out)["density"].get<double>(), 0.7);
    EXPECT_LT(bad_share(read_image(out), read_image(cones / truth)), 0.1);
  }
}

}  // namespace
}  // namespace skyhalo

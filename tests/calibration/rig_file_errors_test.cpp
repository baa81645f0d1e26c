// Wrong rig files: each is refused with file, line and key.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "skyhalo/calibration/rig_file.hpp"
#include "support/expect_error.hpp"
#include "support/rig_texts.hpp"
#include "support/temp_folder.hpp"

namespace skyhalo {
namespace {

using ::testing::AllOf;
using testing::changed;
using ::testing::HasSubstr;
using testing::kRawRig;
using testing::kRectifiedRig;
using testing::message_of;
using testing::TempFolder;
using testing::WrongRig;

/// Expects each change to the good text to be refused by both readers with its words.
void expect_refused(const std::string& good,
                    const std::vector<WrongRig>& changes,
                    bool read_refuses = true) {
  for (const WrongRig& change : changes) {
    SCOPED_TRACE(change.from + " -> " + change.to);
    const TempFolder folder;
    const auto file = folder.write("rig.yaml", changed(good, change.from, change.to));
    const std::string message = message_of([&] { (void)load_rig(file); });
    EXPECT_THAT(message, ::testing::StartsWith(file.string() + ":"));
    for (const std::string& word : change.words) {
      EXPECT_THAT(message, HasSubstr(word));
    }
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    if (read_refuses) {
      EXPECT_EQ(message_of([&] { (void)read_rig_file(file); }), message);
    } else {
      EXPECT_NO_THROW((void)read_rig_file(file));  // for a check that says more
    }
  }
}

TEST(RigFileErrorsTest, GoodTextsAreGood) {
  const TempFolder folder;
  for (const std::string& text : {kRawRig, kRectifiedRig}) {
    EXPECT_NO_THROW((void)load_rig(folder.write("rig.yaml", text)));
  }
}

TEST(RigFileErrorsTest, WrongRawRigs) {
  expect_refused(kRawRig, testing::wrong_raw_rigs());
}

TEST(RigFileErrorsTest, RawPairsThatCannotBeRectified) {
  expect_refused(kRawRig, testing::wrong_raw_pairs(), false);
}

TEST(RigFileErrorsTest, WrongRectifiedRigs) {
  expect_refused(kRectifiedRig, testing::wrong_rectified_rigs());
}

TEST(RigFileErrorsTest, APairNeedsCamerasOrRectifiedImages) {
  expect_refused("rig: a\npairs:\n  - name: b\n    T_body_camera: {position_m: [0, 0, 0]}\n",
                 {{"", "", {":3: pairs[0].left: ", "left and right, or rectified"}}});
}

TEST(RigFileErrorsTest, ARigNeedsPairs) {
  expect_refused("rig: a\npairs: []\n", {{"", "", {":2: pairs: ", "at least one"}}});
  expect_refused("rig: a\npairs: 3\n", {{"", "", {":2: pairs: ", "a list"}}});
  expect_refused("rig: a\npairs:\n", {{"", "", {":2: pairs: ", "a list"}}});
  expect_refused("rig: a\n", {{"", "", {"pairs: ", "missing"}}});
  expect_refused("rig: a\npairs: [3]\n", {{"", "", {":2: pairs[0]: ", "keys with values"}}});
  expect_refused("just words\n", {{"", "", {"keys with values"}}});
  expect_refused("- a list\n", {{"", "", {"keys with values"}}});
}

TEST(RigFileErrorsTest, PairsHaveDifferentNames) {
  const std::string pair = kRectifiedRig.substr(kRectifiedRig.find("  - name"));
  const std::string two = kRectifiedRig + pair;
  expect_refused(two, {{"", "", {":12: pairs[1].name: ", "'front'"}}});
  const TempFolder folder;
  const std::string named = kRectifiedRig + changed(pair, "name: front", "name: Front");
  EXPECT_EQ(load_rig(folder.write("rig.yaml", named)).pairs.size(), 2U);
}

TEST(RigFileErrorsTest, TheLineIsThatOfTheWrongPair) {
  const std::string pair = kRawRig.substr(kRawRig.find("  - name"));
  expect_refused(
      kRectifiedRig + changed(changed(pair, "front", "side"), "hfov_deg: 60", "hfov_deg: 160"),
      {{"", "", {":29: pairs[1].rectify_to.hfov_deg: "}}},
      false);
}

TEST(RigFileErrorsTest, FilesThatAreNoRigs) {
  const TempFolder folder;
  const auto refuse = [](const std::filesystem::path& file, const std::string& word) {
    EXPECT_THAT(message_of([&] { (void)load_rig(file); }),
                AllOf(::testing::StartsWith(file.string()), HasSubstr(word)));
  };
  refuse(folder.write("empty.yaml", ""), "empty");
  refuse(folder.write("blank.yaml", " \n\n"), "empty");
  refuse(folder.write("comment.yaml", "# nothing\n"), "expected keys");
  refuse(folder.path() / "missing.yaml", "no such file");
  refuse(folder.path(), "");
  refuse(folder.write("image.png", std::string("\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\xff", 18)), "");
  std::string bytes;
  for (int i = 0; i < 4096; ++i) {
    bytes += static_cast<char>(i * 131 % 251);
  }
  refuse(folder.write("binary.yaml", bytes), "");
}

TEST(RigFileErrorsTest, ListsThatHoldThemselvesAreRefused) {
  expect_refused(kRawRig,
                 {{"[400, 404, 319.5, 241]", "&a [*a]", {":7: pairs[0].left.intrinsics_px"}}});
}

TEST(RigFileErrorsTest, ListsThatMultiplyAreRefusedAtOnce) {
  std::string lists = "&a0 [1, 1, 1, 1, 1, 1, 1, 1, 1, 1]";
  std::string all = "[" + lists;
  for (int i = 1; i < 6; ++i) {  // a million numbers in a line
    std::string next;
    for (int k = 0; k < 10; ++k) {
      next += (k == 0 ? "*a" : ", *a") + std::to_string(i - 1);
    }
    all += ", &a" + std::to_string(i) + " [" + next + "]";
  }
  expect_refused(kRawRig,
                 {{"[400, 404, 319.5, 241]", all + "]", {":7: pairs[0].left.intrinsics_px: "}}});
}

}  // namespace
}  // namespace skyhalo

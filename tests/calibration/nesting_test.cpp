#include "skyhalo/calibration/nesting.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "support/expect_error.hpp"

namespace skyhalo {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using testing::message_of;

std::string repeated(const std::string& text, int count) {
  std::string all;
  for (int i = 0; i < count; ++i) {
    all += text;
  }
  return all;
}

void check(const std::string& text) {
  refuse_deep_nesting("a.yml", text);
}

void expect_refused(const std::string& text) {
  EXPECT_THAT(message_of([&] { check(text); }),
              AllOf(HasSubstr("a.yml: is nested too deep"), HasSubstr("100 levels")));
}

/// Each key one blank further in than the one before.
std::string staircase(int depth) {
  std::string text;
  for (int i = 0; i < depth; ++i) {
    text += repeated(" ", i) + "a:\n";
  }
  return text;
}

TEST(NestingTest, AHundredLevelsOfBracketsPass) {
  for (const std::string& start : {std::string("M: "), std::string("{\"M\": ")}) {
    const int more = start.front() == '{' ? 1 : 0;
    EXPECT_NO_THROW(check(start + repeated("[", 100 - more) + repeated("]", 100)));
    expect_refused(start + repeated("[", 101 - more) + repeated("]", 101));
    expect_refused(start + repeated("[", 200000));
    expect_refused(start + repeated("{\"a\": ", 200000));
  }
  EXPECT_NO_THROW(check("M: " + repeated("[1, 2], ", 1000)));
  expect_refused(repeated("[", 200000));
}

TEST(NestingTest, AHundredLevelsOfTagsPass) {
  const std::string head = "<?xml version=\"1.0\"?>\n<!-- c --><opencv_storage>\n";
  EXPECT_NO_THROW(check(head + repeated("<a>", 99) + "1" + repeated("</a>", 99)));
  EXPECT_NO_THROW(check(head + repeated("<a/>", 1000) + repeated("<a>1</a>\n", 1000)));
  expect_refused(head + repeated("<a>", 100) + "1" + repeated("</a>", 100));
  expect_refused(head + repeated("<a>", 200000));
}

TEST(NestingTest, AHundredLevelsOfIndentationPass) {
  EXPECT_NO_THROW(check("%YAML:1.0\n---\n" + staircase(99)));
  expect_refused("%YAML:1.0\n---\n" + staircase(102));
  expect_refused("M: " + repeated("- ", 200000));
  expect_refused(repeated("a: ", 200000));
  expect_refused(staircase(2000));
}

TEST(NestingTest, BlankAndLongLinesAreNotDeep) {
  EXPECT_NO_THROW(check(""));
  EXPECT_NO_THROW(check(" \n"));
  EXPECT_NO_THROW(check("a: 1\n" + repeated(" ", 500) + "\nb: 2\n"));
  EXPECT_NO_THROW(check("data: [ " + repeated("-1.0, ", 500) + "0 ]\n"));
  EXPECT_NO_THROW(check("# " + repeated("-", 500) + "\na: 1\n"));
}

TEST(NestingTest, ClosingBracketsInTextsDoNotHideTheDepth) {
  expect_refused("M: " + repeated("[\"]\",", 20000));
  expect_refused("{\"M\": " + repeated("[\"]\",", 20000));
  expect_refused("<a>" + repeated("<b><!--</b>-->", 20000));
}

}  // namespace
}  // namespace skyhalo

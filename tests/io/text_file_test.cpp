#include "skyhalo/io/text_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "support/expect_error.hpp"
#include "support/temp_folder.hpp"

namespace skyhalo {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::message_of;
using testing::TempFolder;

TEST(TextFileTest, ReadsAllBytes) {
  const TempFolder folder;
  const std::string bytes("a\0b\r\n\xFF", 6);
  EXPECT_EQ(read_bytes(folder.write("bytes", bytes)), bytes);
  EXPECT_EQ(read_bytes(folder.write("empty", "")), "");
}

TEST(TextFileTest, AFileThatCannotBeReadIsNamed) {
  const TempFolder folder;
  const auto missing = folder.path() / "missing.txt";
  EXPECT_THAT(message_of([&] { (void)read_bytes(missing); }), HasSubstr(missing.string()));
  EXPECT_THAT(message_of([&] { (void)read_lines(missing); }), HasSubstr(missing.string()));
  EXPECT_THAT(message_of([&] { (void)read_bytes(folder.path()); }),
              AllOf(HasSubstr(folder.path().string()), HasSubstr("folder")));
}

TEST(TextFileTest, LinesEndTheUnixOrTheWindowsWay) {
  const TempFolder folder;
  EXPECT_THAT(read_lines(folder.write("unix", "one\ntwo\n")), ElementsAre("one", "two"));
  EXPECT_THAT(read_lines(folder.write("windows", "one\r\ntwo\r\n")), ElementsAre("one", "two"));
  EXPECT_THAT(read_lines(folder.write("mixed", "one\r\ntwo\nthree")),
              ElementsAre("one", "two", "three"));
}

TEST(TextFileTest, TheLastLineMayLackItsEnd) {
  const TempFolder folder;
  EXPECT_THAT(read_lines(folder.write("unix", "one\ntwo")), ElementsAre("one", "two"));
  EXPECT_THAT(read_lines(folder.write("windows", "one\r\ntwo\r")), ElementsAre("one", "two"));
}

TEST(TextFileTest, EmptyLinesStay) {
  const TempFolder folder;
  EXPECT_THAT(read_lines(folder.write("gaps", "\none\n\n\r\ntwo\n")),
              ElementsAre("", "one", "", "", "two"));
  EXPECT_THAT(read_lines(folder.write("none", "")), IsEmpty());
}

TEST(TextFileTest, WordsAreSeparatedByBlanksOrTabs) {
  EXPECT_THAT(split_words("R: 1 2"), ElementsAre("R:", "1", "2"));
  EXPECT_THAT(split_words(" \tR:\t1  2 \t "), ElementsAre("R:", "1", "2"));
  EXPECT_THAT(split_words(""), IsEmpty());
  EXPECT_THAT(split_words(" \t "), IsEmpty());
}

TEST(TextFileTest, WordsAreViewsIntoTheLine) {
  const std::string line = "ab cd";
  const std::vector<std::string_view> words = split_words(line);
  ASSERT_EQ(words.size(), 2U);
  EXPECT_EQ(words[1].data(), line.data() + 3);
}

TEST(TextFileTest, ReadsNumbers) {
  EXPECT_EQ(parse_number("0"), 0.0);
  EXPECT_EQ(parse_number("-12.5"), -12.5);
  EXPECT_EQ(parse_number("+2"), 2.0);
  EXPECT_EQ(parse_number("7.215377e+02"), 721.5377);
  EXPECT_EQ(parse_number("1E-3"), 0.001);
  EXPECT_EQ(parse_number(".5"), 0.5);
}

TEST(TextFileTest, RefusesWhatIsNoFiniteNumber) {
  for (const std::string_view bad :
       {"",       " ",    "nan", "NaN",  "-nan", "inf", "-inf", "Infinity", "1e999",
        "-1e999", "1.5m", "1,5", "1 2",  "1 ",   " 1",  "x",    "-",        "+",
        ".",      "e5",   "1e",  "0x10", "--1",  "+-1", "++1",  "1.2.3"}) {
    EXPECT_EQ(parse_number(bad), std::nullopt) << "'" << bad << "'";
  }
}

TEST(TextFileTest, ReadsWholeNumbers) {
  EXPECT_EQ(parse_whole_number("0"), 0);
  EXPECT_EQ(parse_whole_number("0003"), 3);
  EXPECT_EQ(parse_whole_number("-1"), -1);
  EXPECT_EQ(parse_whole_number("2147483647"), 2147483647);
}

TEST(TextFileTest, RefusesWhatIsNoWholeNumber) {
  for (const std::string_view bad : {"",
                                     "1.0",
                                     "1.5",
                                     "2147483648",
                                     "99999999999999999999",
                                     "1e3",
                                     "7a",
                                     "a",
                                     " 1",
                                     "1 ",
                                     "-"}) {
    EXPECT_EQ(parse_whole_number(bad), std::nullopt) << "'" << bad << "'";
  }
}

TEST(TextFileProperty, ANumberThatIsPrintedIsReadBack) {
  std::mt19937 random(1);
  std::uniform_real_distribution mantissa(-1.0, 1.0);
  std::uniform_int_distribution exponent(-30, 30);
  for (int round = 0; round < 1000; ++round) {
    const double value = std::ldexp(mantissa(random), exponent(random));
    std::ostringstream text;
    text.precision(17);
    text << value;
    EXPECT_EQ(parse_number(text.str()), value) << text.str();
  }
}

TEST(TextFileProperty, LinesAndTheirEndsAreTheWholeFile) {
  const TempFolder folder;
  std::mt19937 random(2);
  std::uniform_int_distribution length(0, 6);
  for (int round = 0; round < 50; ++round) {
    std::vector<std::string> lines(static_cast<std::size_t>(length(random)));
    std::string text;
    for (std::string& line : lines) {
      line.assign(static_cast<std::size_t>(length(random)), 'x');
      text += line + (length(random) < 3 ? "\n" : "\r\n");
    }
    EXPECT_EQ(read_lines(folder.write("lines", text)), lines);
  }
}

}  // namespace
}  // namespace skyhalo

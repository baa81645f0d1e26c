#include "skyhalo/dataset/euroc_table.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "support/expect_error.hpp"
#include "support/temp_folder.hpp"

namespace skyhalo {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::message_of;
using testing::TempFolder;

std::vector<EurocRow> read(const std::string& text, std::size_t fields) {
  const TempFolder folder;
  return read_euroc_table(folder.write("data.csv", text), fields);
}

std::string complaint(const std::string& text, std::size_t fields) {
  return message_of([&] { (void)read(text, fields); });
}

TEST(EurocTableTest, ReadsStampsExactly) {
  // The nearest doubles are 256 ns apart there.
  const auto rows = read(
      "#timestamp [ns],filename\n1403715273262142976,a.png\n"
      "1403715273262142977,b.png\n",
      1);
  ASSERT_EQ(rows.size(), 2U);
  EXPECT_EQ(rows[0].stamp.time_since_epoch().count(), 1403715273262142976);
  EXPECT_EQ(rows[1].stamp.time_since_epoch().count(), 1403715273262142977);
  EXPECT_THAT(rows[0].fields, ElementsAre("a.png"));
  EXPECT_EQ(rows[1].line, 3);
}

TEST(EurocTableTest, PassesOverCommentsEmptyLinesAndBlanks) {
  const auto rows = read("#a,b\r\n\r\n  # more\r\n1 , x y ,\tz \r\n   \r\n2,u,v   \r\n3,,", 2);
  ASSERT_EQ(rows.size(), 3U);
  EXPECT_THAT(rows[0].fields, ElementsAre("x y", "z"));
  EXPECT_EQ(rows[0].line, 4);
  EXPECT_THAT(rows[1].fields, ElementsAre("u", "v"));
  EXPECT_EQ(rows[1].line, 6);
  EXPECT_THAT(rows[2].fields, ElementsAre("", ""));
}

TEST(EurocTableTest, AStampThatIsNoneIsNamedWithItsLine) {
  for (const std::string stamp :
       {"", "x", "-5", "12.0", "1.4e18", "0x12", "99999999999999999999", "1 2"}) {
    EXPECT_THAT(complaint("#t,f\n1,a\n" + stamp + ",b\n", 1), HasSubstr("data.csv:3: expected"))
        << stamp;
  }
}

TEST(EurocTableTest, ALineOfAnotherLengthIsNamed) {
  EXPECT_THAT(complaint("1,a\n2\n", 1), HasSubstr("data.csv:2: expected"));
  EXPECT_THAT(complaint("1,a\n2,b,c\n", 1), HasSubstr("data.csv:2: expected"));
  EXPECT_THAT(complaint("1 a\n", 1), HasSubstr("data.csv:1: expected"));
}

TEST(EurocTableTest, StampsMustGrow) {
  EXPECT_THAT(complaint("#\n5,a\n5,b\n", 1), HasSubstr("data.csv:3: "));
  EXPECT_THAT(complaint("#\n5,a\n6,b\n4,c\n", 1), HasSubstr("line 3"));
}

TEST(EurocTableTest, AFileWithoutDataIsRefused) {
  EXPECT_THAT(complaint("", 1), HasSubstr("data.csv: holds no data"));
  EXPECT_THAT(complaint("#timestamp [ns],filename\n\n", 1), HasSubstr("data.csv: holds no data"));
  const TempFolder folder;
  EXPECT_THAT(message_of([&] { (void)read_euroc_table(folder.path() / "none.csv", 1); }),
              HasSubstr("none.csv: no such file"));
}

}  // namespace
}  // namespace skyhalo

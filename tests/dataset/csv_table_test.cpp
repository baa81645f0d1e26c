#include "skyhalo/dataset/csv_table.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/expect_error.hpp"
#include "support/temp_folder.hpp"

namespace skyhalo {
namespace {

using ::testing::HasSubstr;
using testing::message_of;
using testing::TempFolder;

TEST(CsvTableTest, ReadsValuesByColumn) {
  const TempFolder folder;
  const auto rows =
      read_csv(folder.write("a.csv", "a,b,c,d\r\n7,-0.5,two words,1700000000000000001\n\n8,1e3,,0"),
               "a,b,c,d");
  ASSERT_EQ(rows.size(), 2U);
  EXPECT_EQ(rows[0].whole_number(0), 7);
  EXPECT_EQ(rows[0].number(1), -0.5);
  EXPECT_EQ(rows[0].text(2), "two words");
  EXPECT_EQ(rows[0].stamp(3).time_since_epoch().count(), 1'700'000'000'000'000'001);
  EXPECT_EQ(rows[1].number(1), 1000.0);
  EXPECT_EQ(rows[1].text(2), "");
  EXPECT_THAT(rows[1].error("odd").what(), HasSubstr("a.csv:4: odd"));
}

TEST(CsvTableTest, WhatIsWrongIsNamed) {
  const TempFolder folder;
  const auto file = folder.write("a.csv", "a,b\n1,x\n");
  const auto rows = read_csv(file, "a,b");
  EXPECT_THAT(message_of([&] { (void)rows.at(0).number(1); }),
              HasSubstr("a.csv:2: column 2: expected a finite number, found 'x'"));
  EXPECT_THAT(message_of([&] { (void)rows.at(0).whole_number(1); }), HasSubstr("a whole number"));
  EXPECT_THAT(message_of([&] { (void)rows.at(0).stamp(1); }), HasSubstr("whole nanoseconds"));
  EXPECT_THAT(message_of([&] { (void)read_csv(file, "a,c"); }),
              HasSubstr("a.csv:1: expected the line 'a,c'"));
  EXPECT_THAT(message_of([&] { (void)read_csv(folder.write("b.csv", ""), "a,b"); }),
              HasSubstr("b.csv:1: expected the line"));
  EXPECT_THAT(message_of([&] { (void)read_csv(folder.write("b.csv", "a,b\n1\n"), "a,b"); }),
              HasSubstr("b.csv:2: expected 2 values separated by commas, found '1'"));
  EXPECT_THAT(message_of([&] { (void)read_csv(folder.write("b.csv", "a,b\n1,2,\n"), "a,b"); }),
              HasSubstr("b.csv:2: expected 2 values"));
}

}  // namespace
}  // namespace skyhalo

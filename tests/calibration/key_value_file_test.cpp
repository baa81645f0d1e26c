#include "skyhalo/calibration/key_value_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/expect_error.hpp"
#include "support/temp_folder.hpp"

namespace skyhalo {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::message_of;
using testing::TempFolder;

TEST(KeyValueFileTest, ReadsNumbersWithAndWithoutAColon) {
  const TempFolder folder;
  const KeyValueFile file(
      folder.write("calib.txt", "P0: 1 2.5 -3e-1\nR_rect 4 5\n  T:\t6\t7  \n\nS: 8"));
  EXPECT_THAT(file.numbers("P0", 3), ElementsAre(1.0, 2.5, -0.3));
  EXPECT_THAT(file.numbers("R_rect", 2), ElementsAre(4.0, 5.0));
  EXPECT_THAT(file.numbers("T", 2), ElementsAre(6.0, 7.0));
  EXPECT_THAT(file.numbers("S", 1), ElementsAre(8.0));
}

TEST(KeyValueFileTest, ReadsWindowsLines) {
  const TempFolder folder;
  const KeyValueFile file(folder.write("calib.txt", "\r\nR: 1 2\r\nT: 3\r\n"));
  EXPECT_THAT(file.numbers("R", 2), ElementsAre(1.0, 2.0));
  EXPECT_THAT(file.numbers("T", 1), ElementsAre(3.0));
}

TEST(KeyValueFileTest, ValuesThatAreNoNumbersMatterOnlyWhenAskedFor) {
  const TempFolder folder;
  const auto path = folder.write("calib.txt", "calib_time: 09-Jan-2012 13:57:47\nT: 1\n");
  const KeyValueFile file(path);
  EXPECT_THAT(file.numbers("T", 1), ElementsAre(1.0));
  EXPECT_THAT(
      message_of([&] { (void)file.numbers("calib_time", 2); }),
      AllOf(HasSubstr(path.string() + ":1:"), HasSubstr("calib_time"), HasSubstr("09-Jan-2012")));
}

TEST(KeyValueFileTest, KnowsItsKeys) {
  const TempFolder folder;
  const KeyValueFile file(folder.write("calib.txt", "R: 1\nR_02: 1\n"));
  EXPECT_TRUE(file.has("R"));
  EXPECT_TRUE(file.has("R_02"));
  EXPECT_FALSE(file.has("R_0"));
  EXPECT_FALSE(file.has("R:"));
}

TEST(KeyValueFileTest, AMissingKeyIsNamed) {
  const TempFolder folder;
  const auto path = folder.write("calib.txt", "R: 1\n");
  const KeyValueFile file(path);
  EXPECT_THAT(message_of([&] { (void)file.numbers("P_rect_00", 12); }),
              AllOf(HasSubstr(path.string()), HasSubstr("P_rect_00")));
}

TEST(KeyValueFileTest, AWrongCountIsNamedWithItsLine) {
  const TempFolder folder;
  const auto path = folder.write("calib.txt", "# header 1\nR: 1 2 3\n");
  const KeyValueFile file(path);
  for (const std::size_t count : {std::size_t{2}, std::size_t{4}}) {
    EXPECT_THAT(message_of([&] { (void)file.numbers("R", count); }),
                AllOf(HasSubstr(path.string() + ":2:"),
                      HasSubstr("R"),
                      HasSubstr(std::to_string(count)),
                      HasSubstr("3")));
  }
}

TEST(KeyValueFileTest, AKeyWithoutNumbersIsNamedWithItsLine) {
  const TempFolder folder;
  const auto path = folder.write("calib.txt", "R: 1\nT:\n");
  const KeyValueFile file(path);
  EXPECT_THAT(message_of([&] { (void)file.numbers("T", 3); }),
              AllOf(HasSubstr(path.string() + ":2:"), HasSubstr("T")));
}

TEST(KeyValueFileTest, AWordThatIsNoFiniteNumberIsNamedWithItsLine) {
  const TempFolder folder;
  for (const std::string bad : {"nan", "inf", "1e999", "1.5m", "x"}) {
    SCOPED_TRACE(bad);
    const auto path = folder.write("calib.txt", "\nT: 0 " + bad + " 1\n");
    const KeyValueFile file(path);
    EXPECT_THAT(message_of([&] { (void)file.numbers("T", 3); }),
                AllOf(HasSubstr(path.string() + ":2:"), HasSubstr("T:"), HasSubstr(bad)));
  }
}

TEST(KeyValueFileTest, AnErrorOfTheCallerNamesFileLineAndKey) {
  const TempFolder folder;
  const auto path = folder.write("calib.txt", "\n\nR: 1\n");
  const Error error = KeyValueFile(path).error("R", "is not a rotation");
  EXPECT_EQ(error.kind(), ErrorKind::kInput);
  EXPECT_EQ(error.what(), path.string() + ":3: R: is not a rotation");
}

TEST(KeyValueFileTest, AMissingFileIsNamed) {
  const TempFolder folder;
  const auto path = folder.path() / "calib_cam_to_cam.txt";
  EXPECT_THAT(message_of([&] { const KeyValueFile file(path); }), HasSubstr(path.string()));
}

}  // namespace
}  // namespace skyhalo

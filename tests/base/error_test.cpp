#include "skyhalo/base/error.hpp"

#include <gtest/gtest.h>

#include <exception>

namespace skyhalo {
namespace {

TEST(ErrorTest, KeepsItsKindAndMessage) {
  const Error error(ErrorKind::kCancelled, "stopped by the user");
  EXPECT_EQ(error.kind(), ErrorKind::kCancelled);
  EXPECT_STREQ(error.what(), "stopped by the user");
}

TEST(ErrorTest, IsAStandardException) {
  try {
    throw Error(ErrorKind::kFailure, "the disk is full");
  } catch (const std::exception& error) {
    EXPECT_STREQ(error.what(), "the disk is full");
    return;
  }
  FAIL() << "an Error must be caught as std::exception";
}

TEST(ErrorTest, AnInputErrorNamesTheFile) {
  const Error error = input_error("drive/oxts/0000000001.txt", "is empty");
  EXPECT_EQ(error.kind(), ErrorKind::kInput);
  EXPECT_STREQ(error.what(), "drive/oxts/0000000001.txt: is empty");
}

TEST(ErrorTest, AnInputErrorNamesFileAndLine) {
  const Error error = input_error("a folder/calib.txt", 17, "R: expected 9 numbers");
  EXPECT_EQ(error.kind(), ErrorKind::kInput);
  EXPECT_STREQ(error.what(), "a folder/calib.txt:17: R: expected 9 numbers");
}

}  // namespace
}  // namespace skyhalo

#include "skyhalo/calibration/file_status.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "support/expect_error.hpp"
#include "support/temp_folder.hpp"

namespace skyhalo {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using testing::message_of;
using testing::TempFolder;

TEST(FileStatusTest, FilesAndFoldersAreToldApart) {
  const TempFolder folder;
  const auto file = folder.write("a.txt", "a");
  EXPECT_TRUE(is_there(file));
  EXPECT_FALSE(is_folder(file));
  EXPECT_TRUE(is_there(folder.path()));
  EXPECT_TRUE(is_folder(folder.path()));
  EXPECT_FALSE(is_there(folder.path() / "none"));
  EXPECT_FALSE(is_folder(folder.path() / "none"));
  EXPECT_FALSE(is_there(file / "below a file"));
}

TEST(FileStatusTest, WhatCannotBeToldIsAnErrorThatNamesThePath) {
  const TempFolder folder;
  const auto path = folder.path() / std::string(5000, 'x');  // no file system takes such a name
  EXPECT_THAT(message_of([&] { (void)is_there(path); }),
              AllOf(HasSubstr(path.string()), HasSubstr("cannot be read")));
  EXPECT_THAT(message_of([&] { (void)is_folder(path); }), HasSubstr("cannot be read"));
}

}  // namespace
}  // namespace skyhalo

#include "skyhalo/io/folder_lock.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <filesystem>

#include "support/expect_error.hpp"
#include "support/temp_folder.hpp"

namespace skyhalo {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using testing::message_of;
using testing::TempFolder;

TEST(FolderLockTest, ASecondOneIsRefusedUntilTheFirstIsGone) {
  const TempFolder folder;
  {
    const FolderLock first(folder.path());
    const std::string message = message_of([&] { const FolderLock second(folder.path()); });
    EXPECT_THAT(message, HasSubstr(folder.path().string()));
    EXPECT_THAT(message, HasSubstr("in use"));
  }
  EXPECT_NO_THROW(FolderLock(folder.path()));
}

TEST(FolderLockTest, AnotherNameOfTheFolderIsTheSameFolder) {
  const TempFolder folder;
  fs::create_directory(folder.path() / "there");
  fs::create_directory_symlink("there", folder.path() / "link");
  const FolderLock first(folder.path() / "there");
  EXPECT_THAT(message_of([&] { const FolderLock second(folder.path() / "link"); }),
              HasSubstr("in use"));
}

TEST(FolderLockTest, FoldersDoNotDisturbEachOther) {
  const TempFolder one;
  const TempFolder other;
  const FolderLock first(one.path());
  EXPECT_NO_THROW(FolderLock(other.path()));
}

TEST(FolderLockTest, AKilledProgramHoldsNothing) {
  const TempFolder folder;
  std::array<int, 2> locked{};
  ASSERT_EQ(::pipe(locked.data()), 0);
  const pid_t child = ::fork();
  if (child == 0) {
    const FolderLock lock(folder.path());
    (void)!::write(locked[1], "x", 1);
    ::pause();
    ::_exit(0);
  }
  char told = 0;
  ASSERT_EQ(::read(locked[0], &told, 1), 1);
  (void)message_of([&] { const FolderLock second(folder.path()); });
  ::kill(child, SIGKILL);
  (void)::waitpid(child, nullptr, 0);
  EXPECT_NO_THROW(FolderLock(folder.path()));
  ::close(locked[0]);
  ::close(locked[1]);
}

TEST(FolderLockTest, AFolderThatIsNotThereIsAFailure) {
  const TempFolder folder;
  EXPECT_THAT(
      message_of([&] { const FolderLock lock(folder.path() / "none"); }, ErrorKind::kFailure),
      HasSubstr("none"));
}

}  // namespace
}  // namespace skyhalo

#include "skyhalo/io/staged_folder.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "skyhalo/io/output_folder.hpp"
#include "skyhalo/io/text_file.hpp"
#include "support/expect_error.hpp"
#include "support/temp_folder.hpp"

namespace skyhalo {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using testing::message_of;
using testing::TempFolder;

std::string failure(const auto& action) {
  return message_of(action, ErrorKind::kFailure);
}

TEST(StagedFolderTest, FilesAppearTogether) {
  const TempFolder folder;
  const fs::path out = folder.path() / "a/out";
  StagedFolder staged(out / "");
  write_bytes(staged.file("top.txt"), "1");
  write_bytes(staged.file("deep/down/file.txt"), "2");
  EXPECT_FALSE(fs::exists(out));
  EXPECT_FALSE(staged.committed());
  staged.commit();
  EXPECT_TRUE(staged.committed());
  EXPECT_EQ(read_bytes(out / "top.txt"), "1");
  EXPECT_EQ(read_bytes(out / "deep/down/file.txt"), "2");
  EXPECT_EQ(std::distance(fs::directory_iterator(out.parent_path()), {}), 1);
  EXPECT_NE(fs::status(out).permissions() & fs::perms::owner_exec, fs::perms::none);
  EXPECT_THAT(failure([&] { staged.commit(); }), HasSubstr("the folder is finished"));
  EXPECT_THAT(failure([&] { (void)staged.file("late.txt"); }), HasSubstr("the folder is finished"));
}

TEST(StagedFolderTest, WithoutACommitNothingStays) {
  const TempFolder folder;
  {
    const StagedFolder staged(folder.path() / "out");
    write_bytes(staged.file("deep/file.txt"), "1");
    EXPECT_FALSE(fs::is_empty(folder.path()));
  }
  EXPECT_TRUE(fs::is_empty(folder.path()));
}

TEST(StagedFolderTest, WhatIsThereIsNotReplaced) {
  const TempFolder folder;
  fs::create_directory(folder.path() / "empty");
  StagedFolder empty(folder.path() / "empty");
  write_bytes(empty.file("file.txt"), "1");
  empty.commit();
  EXPECT_EQ(read_bytes(folder.path() / "empty/file.txt"), "1");
  StagedFolder again(folder.path() / "empty");
  EXPECT_THAT(failure([&] { again.commit(); }), HasSubstr("something is there already"));
  (void)folder.write("file", "");
  EXPECT_THAT(failure([&] { expect_unused(folder.path() / "file"); }),
              HasSubstr("file: cannot be"));
  EXPECT_NO_THROW(expect_unused(folder.path() / "none"));
}

TEST(StagedFolderTest, PartsJoinWhatIsThere) {
  const TempFolder folder;
  const fs::path out = folder.path() / "out";
  (void)folder.write("out/a/0.txt", "old");
  StagedFolder staged(out);
  write_bytes(staged.file("a/1.txt"), "new");
  write_bytes(staged.file("b/1/file.txt"), "new");
  write_bytes(staged.file("scratch.txt"), "gone");
  staged.commit({"a/1.txt", "b/1"});
  EXPECT_EQ(read_bytes(out / "a/0.txt"), "old");
  EXPECT_EQ(read_bytes(out / "a/1.txt"), "new");
  EXPECT_EQ(read_bytes(out / "b/1/file.txt"), "new");
  EXPECT_FALSE(fs::exists(out / "scratch.txt"));

  StagedFolder clash(out);
  write_bytes(clash.file("c.txt"), "c");
  write_bytes(clash.file("a/0.txt"), "clash");
  EXPECT_THAT(failure([&] { clash.commit({"c.txt", "a/0.txt"}); }), HasSubstr("a/0.txt: cannot"));
  EXPECT_FALSE(fs::exists(out / "c.txt"));
  EXPECT_EQ(read_bytes(out / "a/0.txt"), "old");

  StagedFolder torn(out);
  write_bytes(torn.file("c.txt"), "c");
  EXPECT_THAT(failure([&] {
                torn.commit({"c.txt", "never_written.txt"});
              }),
              HasSubstr("never_written.txt: cannot"));
  EXPECT_FALSE(fs::exists(out / "c.txt"));
  write_bytes(torn.file("never_written.txt"), "now");
  torn.commit({"c.txt", "never_written.txt"});
  EXPECT_EQ(read_bytes(out / "c.txt"), "c");
}

TEST(StagedFolderTest, AFolderThatCannotBeMadeIsNamed) {
  const TempFolder folder;
  (void)folder.write("file", "");
  EXPECT_THAT(failure([&] { const StagedFolder s(folder.path() / "file/out"); }),
              HasSubstr("file"));
  EXPECT_THAT(failure([&] { const StagedFolder s(""); }), HasSubstr("expected a name"));
}

}  // namespace
}  // namespace skyhalo

#include "skyhalo/io/output_folder.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "skyhalo/io/text_file.hpp"
#include "support/expect_error.hpp"
#include "support/temp_folder.hpp"

namespace skyhalo {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using testing::message_of;
using testing::TempFolder;

/// Names in a folder that a user sees.
int visible_entries(const fs::path& folder) {
  int count = 0;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    count += entry.path().filename().string().starts_with(".") ? 0 : 1;
  }
  return count;
}

TEST(OutputFolderTest, WritesBytesAsTheyAre) {
  const TempFolder folder;
  const std::string bytes("a\r\n\0b", 5);
  write_bytes(folder.path() / "bytes", bytes);
  EXPECT_EQ(read_bytes(folder.path() / "bytes"), bytes);
  write_bytes(folder.path() / "bytes", "short");
  EXPECT_EQ(read_bytes(folder.path() / "bytes"), "short");
}

TEST(OutputFolderTest, BytesThatCannotBeWrittenAreAFailure) {
  const TempFolder folder;
  const fs::path file = folder.path() / "missing" / "file";
  EXPECT_THAT(message_of([&] { write_bytes(file, "x"); }, ErrorKind::kFailure),
              HasSubstr(file.string()));
  EXPECT_THAT(message_of([&] { write_bytes(folder.path(), "x"); }, ErrorKind::kFailure),
              HasSubstr(folder.path().string()));
}

TEST(OutputFolderTest, NothingIsVisibleBeforeTheCommit) {
  const TempFolder folder;
  OutputFolder out(folder.path() / "out");
  EXPECT_EQ(out.folder(), folder.path() / "out");
  write_bytes(out.file("a.txt"), "a");
  write_bytes(out.file("b.txt"), "b");
  EXPECT_EQ(visible_entries(out.folder()), 0);
  out.commit();
  EXPECT_EQ(visible_entries(out.folder()), 2);
  EXPECT_EQ(read_bytes(out.folder() / "a.txt"), "a");
  EXPECT_EQ(read_bytes(out.folder() / "b.txt"), "b");
}

TEST(OutputFolderTest, NoHiddenFolderStaysBehind) {
  const TempFolder folder;
  {
    OutputFolder out(folder.path() / "out");
    write_bytes(out.file("a.txt"), "a");
    out.commit();
  }
  int entries = 0;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder.path() / "out")) {
    EXPECT_EQ(entry.path().filename(), "a.txt");
    ++entries;
  }
  EXPECT_EQ(entries, 1);
}

TEST(OutputFolderTest, WithoutACommitAFolderItCreatedGoesAway) {
  const TempFolder folder;
  {
    const OutputFolder out(folder.path() / "new" / "deep" / "out");
    write_bytes(out.file("a.txt"), "a");
    EXPECT_TRUE(fs::exists(folder.path() / "new"));
  }
  EXPECT_FALSE(fs::exists(folder.path() / "new"));
  EXPECT_TRUE(fs::exists(folder.path()));
}

TEST(OutputFolderTest, WhatOthersPutBesideItStays) {
  const TempFolder folder;
  {
    const OutputFolder out(folder.path() / "new" / "mine");
    (void)folder.write("new/theirs/map.ply", "whole");
  }
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "new/mine"));
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "new/theirs/map.ply"));
}

TEST(OutputFolderTest, ATrailingSlashChangesNothing) {
  const TempFolder folder;
  {
    const OutputFolder out(folder.path() / "new" / "");
    write_bytes(out.file("a.txt"), "a");
  }
  EXPECT_TRUE(fs::is_empty(folder.path()));
}

TEST(OutputFolderTest, WithoutACommitOldResultsAreUntouched) {
  const TempFolder folder;
  (void)folder.write("out/a.txt", "old");
  {
    const OutputFolder out(folder.path() / "out");
    write_bytes(out.file("a.txt"), "new");
    write_bytes(out.file("b.txt"), "new");
    EXPECT_EQ(read_bytes(folder.path() / "out/a.txt"), "old");
  }
  EXPECT_EQ(read_bytes(folder.path() / "out/a.txt"), "old");
  EXPECT_FALSE(fs::exists(folder.path() / "out/b.txt"));
  EXPECT_EQ(visible_entries(folder.path() / "out"), 1);
}

TEST(OutputFolderTest, ACommitReplacesOldResultsAndKeepsOtherFiles) {
  const TempFolder folder;
  (void)folder.write("out/a.txt", "old and longer");
  (void)folder.write("out/notes.txt", "mine");
  {
    OutputFolder out(folder.path() / "out");
    write_bytes(out.file("a.txt"), "new");
    out.commit();
  }
  EXPECT_EQ(read_bytes(folder.path() / "out/a.txt"), "new");
  EXPECT_EQ(read_bytes(folder.path() / "out/notes.txt"), "mine");
}

TEST(OutputFolderTest, ARegularFileInTheWayIsAFailure) {
  const TempFolder folder;
  (void)folder.write("file", "in the way");
  for (const fs::path& path : {folder.path() / "file", folder.path() / "file" / "out"}) {
    SCOPED_TRACE(path);
    EXPECT_THAT(message_of([&] { const OutputFolder out(path); }, ErrorKind::kFailure),
                HasSubstr(path.string()));
  }
  EXPECT_EQ(read_bytes(folder.path() / "file"), "in the way");
}

TEST(OutputFolderTest, AFolderThatCannotBeMadeLeavesNothing) {
  const TempFolder folder;
  const fs::path too_long = folder.path() / "new" / std::string(300, 'x');
  EXPECT_THAT(message_of([&] { const OutputFolder out(too_long); }, ErrorKind::kFailure),
              HasSubstr("xxx"));
  EXPECT_TRUE(fs::is_empty(folder.path()));
}

TEST(OutputFolderTest, ACommitThatCannotReplaceIsAFailure) {
  const TempFolder folder;
  (void)folder.write("out/a.txt/inside", "a folder has the name of a result");
  OutputFolder out(folder.path() / "out");
  write_bytes(out.file("a.txt"), "new");
  EXPECT_THAT(message_of([&] { out.commit(); }, ErrorKind::kFailure), HasSubstr("a.txt"));
  EXPECT_TRUE(fs::exists(folder.path() / "out/a.txt/inside"));
}

TEST(OutputFolderTest, WhatIsLeftOutGoesWithTheCommit) {
  const TempFolder folder;
  (void)folder.write("out/map", "earlier");
  (void)folder.write("out/notes", "mine");
  {
    OutputFolder out(folder.path() / "out");
    out.leave_out("map");
  }
  EXPECT_EQ(read_bytes(folder.path() / "out/map"), "earlier") << "nothing was committed";
  OutputFolder out(folder.path() / "out");
  out.leave_out("map");
  out.leave_out("none");
  write_bytes(out.file("summary"), "new");
  out.commit();
  EXPECT_FALSE(fs::exists(folder.path() / "out/map"));
  EXPECT_EQ(visible_entries(folder.path() / "out"), 2);
}

}  // namespace
}  // namespace skyhalo

#include "skyhalo/io/unfinished_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <string>
#include <vector>

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

std::vector<std::string> names_in(const fs::path& folder) {
  std::vector<std::string> names;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    names.push_back(entry.path().filename().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

class UnfinishedFileTest : public ::testing::Test {
 protected:
  TempFolder folder;
  fs::path file = folder.path() / "map";
};

TEST_F(UnfinishedFileTest, AppearsWithTheCommit) {
  UnfinishedFile unfinished(file);
  write_bytes(unfinished.path(), "whole");
  EXPECT_FALSE(fs::exists(file));
  EXPECT_THAT(unfinished.path().filename().string(),
              ::testing::MatchesRegex("\\.map\\.unfinished-[a-z0-9]{6}"));
  unfinished.commit();
  EXPECT_EQ(read_bytes(file), "whole");
  EXPECT_EQ(names_in(folder.path()), std::vector<std::string>{"map"});
}

TEST_F(UnfinishedFileTest, WithoutACommitTheEarlierFileStays) {
  (void)folder.write("map", "earlier");
  {
    const UnfinishedFile unfinished(file);
    write_bytes(unfinished.path(), "half");
  }
  EXPECT_EQ(read_bytes(file), "earlier");
  EXPECT_EQ(names_in(folder.path()), std::vector<std::string>{"map"});
}

TEST_F(UnfinishedFileTest, TheCommitReplacesTheEarlierFileAndKeepsItsPermissions) {
  (void)folder.write("map", "earlier and longer");
  fs::permissions(file, fs::perms(0640));
  UnfinishedFile unfinished(file);
  write_bytes(unfinished.path(), "new");
  unfinished.commit();
  EXPECT_EQ(read_bytes(file), "new");
  EXPECT_EQ(fs::status(file).permissions(), fs::perms(0640));
}

TEST_F(UnfinishedFileTest, ANewFileHasTheUsersPermissions) {
  const mode_t before = ::umask(027);
  UnfinishedFile unfinished(file);
  unfinished.commit();
  ::umask(before);
  EXPECT_EQ(fs::status(file).permissions(), fs::perms(0640));
}

TEST_F(UnfinishedFileTest, WhatAKilledProgramLeftIsRemoved) {
  (void)folder.write(".map.unfinished-abc123", "half");
  (void)folder.write(".map.unfinished-zzzzzz", "half");
  const UnfinishedFile unfinished(file);
  EXPECT_EQ(names_in(folder.path()),
            std::vector<std::string>{unfinished.path().filename().string()});
}

TEST_F(UnfinishedFileTest, LeftoversStayWhenTheyAreToStay) {
  (void)folder.write(".map.unfinished-abc123", "half");
  UnfinishedFile unfinished(file, Leftovers::kLeave);
  unfinished.commit();
  EXPECT_EQ(names_in(folder.path()), (std::vector<std::string>{".map.unfinished-abc123", "map"}));
}

TEST_F(UnfinishedFileTest, LeftoversOfManyNamesAreRemovedAtOnce) {
  for (const char* const name : {".map1.unfinished-abc123",
                                 ".map2.unfinished-abc123",
                                 ".map2.unfinished-xyz789",
                                 ".plan.unfinished-abc123",
                                 ".map3.unfinished-abc12",
                                 ".unfinished-abc123",
                                 "map4"}) {
    (void)folder.write(name, "half");
  }
  const UnfinishedFile in_work(folder.path() / "map5");
  remove_unfinished_files(folder.path(),
                          [](const std::string& name) { return name.starts_with("map"); });
  const std::vector<std::string> left = names_in(folder.path());
  EXPECT_THAT(left,
              ::testing::UnorderedElementsAre(".plan.unfinished-abc123",
                                              ".map3.unfinished-abc12",
                                              ".unfinished-abc123",
                                              "map4",
                                              in_work.path().filename().string()));
  EXPECT_NO_THROW(remove_unfinished_files(folder.path() / "none", [](auto&) { return true; }));
}

TEST_F(UnfinishedFileTest, FilesOfOtherNamesStay) {
  const std::vector<std::string> others{".map.unfinished-",
                                        ".map.unfinished-abc12",
                                        ".map.unfinished-abc1234",
                                        ".map2.unfinished-abc123",
                                        "map.unfinished-abc123",
                                        "notes"};
  for (const std::string& other : others) {
    (void)folder.write(other, "mine");
  }
  fs::create_directory(folder.path() / ".map.unfinished-folder");
  UnfinishedFile unfinished(file);
  unfinished.commit();
  EXPECT_EQ(names_in(folder.path()).size(), others.size() + 2);
}

TEST_F(UnfinishedFileTest, AFileThatIsStillBeingWrittenStays) {
  UnfinishedFile first(file);
  UnfinishedFile second(file);
  EXPECT_NE(first.path(), second.path());
  write_bytes(first.path(), "first");
  write_bytes(second.path(), "second");
  first.commit();
  EXPECT_EQ(read_bytes(file), "first");
  second.commit();
  EXPECT_EQ(read_bytes(file), "second");
}

TEST_F(UnfinishedFileTest, LinksAreFollowed) {
  fs::create_directory(folder.path() / "there");
  (void)folder.write("there/target", "earlier");
  fs::create_symlink("there/target", file);
  UnfinishedFile unfinished(file);
  write_bytes(unfinished.path(), "new");
  unfinished.commit();
  EXPECT_TRUE(fs::is_symlink(file));
  EXPECT_EQ(read_bytes(folder.path() / "there/target"), "new");
  EXPECT_EQ(names_in(folder.path() / "there"), std::vector<std::string>{"target"});
}

TEST_F(UnfinishedFileTest, DevicesAreWrittenDirectly) {
  UnfinishedFile unfinished("/dev/null");
  EXPECT_EQ(unfinished.path(), "/dev/null");
  write_bytes(unfinished.path(), "gone");
  unfinished.commit();
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
}

TEST_F(UnfinishedFileTest, ANameInTheWorkingFolderWorks) {
  const fs::path before = fs::current_path();
  fs::current_path(folder.path());
  UnfinishedFile unfinished("map");
  write_bytes(unfinished.path(), "here");
  unfinished.commit();
  fs::current_path(before);
  EXPECT_EQ(read_bytes(file), "here");
}

TEST_F(UnfinishedFileTest, WhatCannotBeWrittenIsAFailure) {
  for (const fs::path& path : {folder.path(),
                               folder.path() / "none" / "map",
                               folder.path() / "",
                               folder.path() / std::string(250, 'x'),
                               fs::path()}) {
    SCOPED_TRACE(path);
    EXPECT_THAT(message_of([&] { const UnfinishedFile unfinished(path); }, ErrorKind::kFailure),
                HasSubstr(path.string() + ": cannot be written"));
  }
  EXPECT_TRUE(fs::is_empty(folder.path()));
}

}  // namespace
}  // namespace skyhalo

// Maps that are saved by a program that is killed: whole under their name, old or new.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <random>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "io/map_cases.hpp"
#include "skyhalo/io/skymap_file.hpp"
#include "skyhalo/io/text_file.hpp"
#include "support/program.hpp"
#include "support/sanitised.hpp"
#include "support/temp_folder.hpp"

namespace skyhalo {
namespace {

namespace fs = std::filesystem;
using std::chrono::microseconds;
using testing::Program;
using testing::TempFolder;
using Clock = std::chrono::steady_clock;

class MapKillSystem : public ::testing::Test {
 protected:
  void SetUp() override {
    write_skymap(sources[0], testing::random_map(1, 12000), {});
    write_skymap(sources[1], testing::random_map(2, 12000), {});
    ASSERT_GT(fs::file_size(sources[0]), 2U << 20U);
  }

  [[nodiscard]] Program start(const fs::path& source) const {
    return Program(SKYHALO_PROGRAM,
                   {"map", "convert", source.string(), target.string(), "--quiet"},
                   logs.path());
  }

  /// Files in the folder that are being written, or were.
  [[nodiscard]] std::set<std::string> unfinished_files() const {
    std::set<std::string> names;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder.path())) {
      const std::string name = entry.path().filename().string();
      if (name.starts_with(".target.skymap.unfinished-")) {
        names.insert(name);
      }
    }
    return names;
  }

  /// Whether a file is being written that was not left by an earlier program.
  [[nodiscard]] bool has_begun(const std::set<std::string>& left) const {
    const std::set<std::string> names = unfinished_files();
    return !std::includes(left.begin(), left.end(), names.begin(), names.end());
  }

  /// Waits for a file to be begun and then to be renamed; for how long it was there.
  [[nodiscard]] microseconds watch_writing() const {
    const Clock::time_point give_up = Clock::now() + std::chrono::seconds(20);
    while (unfinished_files().empty() && Clock::now() < give_up) {
      std::this_thread::yield();
    }
    const Clock::time_point begun = Clock::now();
    while (!unfinished_files().empty() && Clock::now() < give_up) {
      std::this_thread::yield();
    }
    return std::chrono::duration_cast<microseconds>(Clock::now() - begun);
  }

  TempFolder folder;
  TempFolder logs;
  std::vector<fs::path> sources{logs.path() / "0.skymap", logs.path() / "1.skymap"};
  fs::path target = folder.path() / "target.skymap";
};

TEST_F(MapKillSystem, AHundredKillsLeaveAWholeMap) {
  constexpr int kKills = testing::rounds(100);
  const Clock::time_point begin = Clock::now();
  Program first = start(sources[0]);
  const microseconds writing_time = watch_writing();
  ASSERT_EQ(first.wait().exit_code, 0);
  const auto whole_time = std::chrono::duration_cast<microseconds>(Clock::now() - begin);
  const std::vector<std::string> bytes{read_bytes(sources[0]), read_bytes(sources[1])};
  ASSERT_EQ(read_bytes(target), bytes[0]);

  std::mt19937 random(7);
  int killed = 0;
  int hit_while_writing = 0;
  int replaced = 0;
  std::size_t held = 0;
  for (int i = 0; i < kKills; ++i) {
    const std::size_t next = 1 - held;
    const std::set<std::string> left = unfinished_files();
    Program program = start(sources[next]);
    if (i % 2 == 0) {
      const auto delay = std::uniform_int_distribution<long>(0, whole_time.count())(random);
      std::this_thread::sleep_for(microseconds(delay));
    } else {
      const Clock::time_point give_up = Clock::now() + 20 * whole_time;
      while (!has_begun(left) && Clock::now() < give_up) {
        std::this_thread::yield();
      }
      const auto delay = std::uniform_int_distribution<long>(0, writing_time.count())(random);
      std::this_thread::sleep_for(microseconds(delay));
    }
    program.send(SIGKILL);
    killed += program.wait().exit_code == 128 + SIGKILL ? 1 : 0;
    EXPECT_LE(unfinished_files().size(), 1U) << "what earlier kills left is removed";
    hit_while_writing += has_begun(left) ? 1 : 0;
    const std::string now = read_bytes(target);
    ASSERT_TRUE(now == bytes[0] || now == bytes[1]) << "kill " << i;
    if (now == bytes[next]) {
      ++replaced;
      held = next;
    }
    if (i % 10 == 0) {
      EXPECT_GT(read_skymap(target).map.brick_count(), 5000U);
    }
  }
  EXPECT_GE(killed, testing::rounds(30));
  EXPECT_GE(hit_while_writing, testing::rounds(5))
      << "no kill came while it wrote: nothing was tried";
  RecordProperty("killed", killed);
  RecordProperty("hit_while_writing", hit_while_writing);
  RecordProperty("replaced", replaced);

  ASSERT_EQ(start(sources[1]).wait().exit_code, 0);
  EXPECT_EQ(read_bytes(target), bytes[1]);
  EXPECT_TRUE(unfinished_files().empty());
}

TEST_F(MapKillSystem, AnInterruptLeavesTheEarlierMapAndNothingElse) {
  ASSERT_EQ(start(sources[0]).wait().exit_code, 0);
  const std::string before = read_bytes(target);
  Program program = start(sources[1]);
  while (unfinished_files().empty() && read_bytes(target) == before) {
    std::this_thread::yield();
  }
  program.send(SIGTERM);
  const int code = program.wait().exit_code;
  EXPECT_TRUE(unfinished_files().empty());
  if (code != 0) {  // else it was done before
    EXPECT_EQ(code, 130);
    EXPECT_EQ(read_bytes(target), before);
  }
}

}  // namespace
}  // namespace skyhalo

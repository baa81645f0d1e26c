// An OctoMap of a real building, through our files and back, and other projects' programs on what
// we write.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <octomap/OcTree.h>

#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include "skyhalo/io/text_file.hpp"
#include "support/program.hpp"
#include "support/recorded_data.hpp"
#include "support/temp_folder.hpp"

namespace skyhalo {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using testing::ProgramResult;
using testing::TempFolder;

/// Key and depth of a leaf.
using Leaf = std::tuple<unsigned, unsigned, unsigned, unsigned>;

struct Leaves {
  std::set<Leaf> occupied;
  std::set<Leaf> free;
};

Leaves leaves_of(const fs::path& file) {
  octomap::OcTree tree(1.0);
  EXPECT_TRUE(tree.readBinary(file.string())) << file;
  tree.prune();
  Leaves leaves;
  for (auto leaf = tree.begin_leafs(), end = tree.end_leafs(); leaf != end; ++leaf) {
    const octomap::OcTreeKey key = leaf.getIndexKey();
    (tree.isNodeOccupied(*leaf) ? leaves.occupied : leaves.free)
        .emplace(key[0], key[1], key[2], leaf.getDepth());
  }
  return leaves;
}

class RecordedOctomapSystem : public ::testing::Test {
 protected:
  [[nodiscard]] std::string path(const std::string& name) const {
    return (folder.path() / name).string();
  }

  void convert(const std::string& from, const std::string& to) const {
    const ProgramResult result =
        testing::run_program(SKYHALO_PROGRAM, {"map", "convert", from, to}, folder.path());
    EXPECT_EQ(result.exit_code, 0) << result.err;
  }

  TempFolder folder;
  fs::path building = testing::recorded_data() / "octomap/geb079.bt";
};

TEST_F(RecordedOctomapSystem, ABuildingComesBackLeafByLeaf) {
  SKYHALO_SKIP_WITHOUT(building);
  convert(building.string(), path("building.skymap"));
  convert(path("building.skymap"), path("building.bt"));
  const Leaves before = leaves_of(building);
  const Leaves after = leaves_of(path("building.bt"));
  EXPECT_GT(before.occupied.size(), 10'000U);
  EXPECT_EQ(after.occupied, before.occupied);
  EXPECT_EQ(after.free, before.free);
}

TEST_F(RecordedOctomapSystem, ABuildingComesBackWithItsLogOdds) {
  SKYHALO_SKIP_WITHOUT(building);
  convert(building.string(), path("building.ot"));
  convert(path("building.ot"), path("building.bt"));
  EXPECT_EQ(leaves_of(path("building.bt")).occupied, leaves_of(building).occupied);
}

TEST_F(RecordedOctomapSystem, OctomapsOwnProgramReadsTheBuilding) {
  SKYHALO_SKIP_WITHOUT(building);
  const fs::path program = "/usr/bin/bt2vrml";
  if (!fs::exists(program)) {
    GTEST_SKIP() << "no bt2vrml; it is in Debian's octomap-tools";
  }
  convert(building.string(), path("building.skymap"));
  convert(path("building.skymap"), path("building.bt"));
  const ProgramResult result =
      testing::run_program(program.string(), {path("building.bt")}, folder.path());
  EXPECT_EQ(result.exit_code, 0) << result.err;
  const std::string vrml = read_bytes(path("building.bt.wrl"));
  EXPECT_THAT(vrml.substr(0, 20), HasSubstr("VRML"));
  std::size_t cubes = 0;
  for (std::size_t at = vrml.find("Box"); at != std::string::npos; at = vrml.find("Box", at + 1)) {
    ++cubes;
  }
  EXPECT_EQ(cubes, leaves_of(building).occupied.size());
}

TEST_F(RecordedOctomapSystem, ThePointCloudLibraryReadsTheBuilding) {
  SKYHALO_SKIP_WITHOUT(building);
  const fs::path program = "/usr/bin/pcl_pcd2ply";
  if (!fs::exists(program)) {
    GTEST_SKIP() << "no pcl_pcd2ply; it is in Debian's pcl-tools";
  }
  convert(building.string(), path("building.pcd"));
  const ProgramResult result = testing::run_program(
      program.string(), {path("building.pcd"), path("building.ply")}, folder.path());
  EXPECT_EQ(result.exit_code, 0) << result.out << result.err;
  const std::string pcd = read_bytes(path("building.pcd"));
  const std::size_t at = pcd.find("POINTS ") + 7;
  const std::string points = pcd.substr(at, pcd.find('\n', at) - at);
  EXPECT_GT(std::stoul(points), 10'000U);
  EXPECT_THAT(read_bytes(path("building.ply")).substr(0, 300),
              HasSubstr("element vertex " + points + "\n"));
}

}  // namespace
}  // namespace skyhalo

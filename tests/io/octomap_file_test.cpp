#include "skyhalo/io/octomap_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
// OctoMap's templates print what they do unless told not to.
#define OCTOMAP_NODEBUGOUT
#include <octomap/ColorOcTree.h>
#include <octomap/OcTree.h>

#include <memory>
#include <string>

#include "io/map_cases.hpp"
#include "skyhalo/io/text_file.hpp"
#include "support/expect_error.hpp"
#include "support/temp_folder.hpp"

namespace skyhalo {
namespace {

using testing::difference;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::message_of;
using testing::TempFolder;

class OctomapFileTest : public ::testing::Test {
 protected:
  [[nodiscard]] SparseMap written_and_read(const SparseMap& map, OctreeForm form) const {
    write_octomap(file, map, form);
    return read_octomap(file, form);
  }

  /// What OctoMap itself reads from the `.ot` file.
  [[nodiscard]] std::unique_ptr<octomap::OcTree> octree() const {
    std::unique_ptr<octomap::AbstractOcTree> tree(octomap::AbstractOcTree::read(file.string()));
    auto* const typed = dynamic_cast<octomap::OcTree*>(tree.get());
    EXPECT_NE(typed, nullptr);
    (void)(typed != nullptr ? tree.release() : nullptr);
    return std::unique_ptr<octomap::OcTree>(typed);
  }

  TempFolder folder;
  std::filesystem::path file = folder.path() / "map.ot";
};

using OctomapFileProperty = OctomapFileTest;

SparseMap at_origin(double voxel_m = 0.25) {
  return SparseMap({.voxel_m = voxel_m});
}

constexpr OctreeForm kFull = OctreeForm::kFull;
constexpr OctreeForm kBinary = OctreeForm::kBinary;

// --- there and back

TEST_F(OctomapFileTest, CellsComeBack) {
  SparseMap map = at_origin();
  map.set({0, 0, 0}, 1500);
  map.set({-1, -1, -1}, -1250);
  map.set({100, -7, 3}, 0);
  map.set({32767, 32767, 32767}, 32767);
  map.set({-32768, -32768, -32768}, -32767);
  EXPECT_THAT(difference(map, written_and_read(map, kFull)), IsEmpty());
}

TEST_F(OctomapFileTest, UniformBricksComeBackAsSuch) {
  SparseMap map = at_origin();
  map.set_uniform({0, 0, 0}, -2000);
  map.set_uniform({5, -5, 5}, 3000);
  const SparseMap read = written_and_read(map, kFull);
  EXPECT_THAT(difference(map, read), IsEmpty());
  EXPECT_EQ(read.uniform({5, -5, 5}), LogOdds{3000});
  EXPECT_EQ(octree()->getNumLeafNodes(), 2U);
}

TEST_F(OctomapFileTest, LargeLeavesComeBackAsManyBricks) {
  SparseMap map = at_origin();
  for (int i = 0; i < 64; ++i) {
    map.set_uniform({4 + i / 16, i / 4 % 4, -4 + i % 4}, -2000);
  }
  const SparseMap read = written_and_read(map, kFull);
  EXPECT_EQ(octree()->getNumLeafNodes(), 1U) << "32 cells a side";
  EXPECT_EQ(read.brick_count(), 64U);
  EXPECT_THAT(difference(map, read), IsEmpty());
}

TEST_F(OctomapFileTest, BinaryTreesJoinWhatBecomesEqual) {
  SparseMap map = at_origin();
  for (int i = 0; i < 16 * 16 * 16; ++i) {
    map.set({i / 256, i / 16 % 16, i % 16}, static_cast<LogOdds>(-1 - i));
  }
  EXPECT_EQ(written_and_read(map, kBinary).uniform({1, 1, 1}), LogOdds{-2000});
  // The root, eleven nodes below it and the leaf of 16 cells a side, on level 12.
  EXPECT_THAT(read_bytes(file), HasSubstr("\nsize 13\n"));
}

TEST_F(OctomapFileTest, WritingAndReadingPrintNothing) {
  ::testing::internal::CaptureStderr();
  ::testing::internal::CaptureStdout();
  for (const OctreeForm form : {kFull, kBinary}) {
    (void)written_and_read(testing::random_map(1, 10, 2), form);
  }
  EXPECT_THAT(::testing::internal::GetCapturedStderr(), IsEmpty());
  EXPECT_THAT(::testing::internal::GetCapturedStdout(), IsEmpty());
}

TEST_F(OctomapFileTest, AnEmptyMapComesBack) {
  for (const OctreeForm form : {kFull, kBinary}) {
    EXPECT_EQ(written_and_read(at_origin(), form).brick_count(), 0U);
  }
}

TEST_F(OctomapFileTest, BinaryTreesKeepFreeAndOccupied) {
  SparseMap map = at_origin();
  map.set({0, 0, 0}, 1);
  map.set({0, 0, 1}, 0);
  map.set({0, 0, 2}, -1);
  map.set({0, 0, 3}, -5000);
  const SparseMap read = written_and_read(map, kBinary);
  // OctoMap clamps to probabilities of 0.971 and 0.1192: log(0.971/0.029) and log(0.1192/0.8808).
  EXPECT_EQ(read.at({0, 0, 0}), 3511);
  EXPECT_EQ(read.at({0, 0, 1}), 3511) << "OctoMap calls 0.5 occupied";
  EXPECT_EQ(read.at({0, 0, 2}), -2000);
  EXPECT_EQ(read.at({0, 0, 3}), -2000);
  EXPECT_EQ(read.at({0, 0, 4}), kUnknown);
}

TEST_F(OctomapFileTest, TheCellKeepsItsDigits) {
  for (const double voxel_m : {0.1, 1.0 / 3.0, 0.05, 12.5}) {
    EXPECT_EQ(written_and_read(at_origin(voxel_m), kFull).lattice().voxel_m, voxel_m);
  }
  write_octomap(file, at_origin(0.1), kFull);
  EXPECT_THAT(read_bytes(file), HasSubstr("res 0.1\n"));
}

TEST_F(OctomapFileTest, WholeCellsOfOriginOnlyRenumber) {
  SparseMap map({.origin_m = {-1.0, 2.5, 0.75}, .voxel_m = 0.25});  // (-4, 10, 3) cells
  map.set({0, 0, 0}, 700);
  map.set({30, 1, -9}, -700);
  map.set_uniform({7, 7, 7}, -100);
  const SparseMap read = written_and_read(map, kFull);
  EXPECT_EQ(read.at({-4, 10, 3}), 700);
  EXPECT_EQ(read.at({26, 11, -6}), -700);
  EXPECT_EQ(read.at({52, 66, 59}), -100);
  EXPECT_EQ(read.at({59, 73, 66}), -100);
  EXPECT_EQ(read.at({60, 73, 66}), kUnknown);
}

TEST_F(OctomapFileTest, OtherOriginsMoveTheMapByLessThanHalfACell) {
  SparseMap map({.origin_m = {0.1, -0.1, 0.35}, .voxel_m = 0.25});  // 0.4, -0.4 and 1.4 cells
  map.set({5, 5, 5}, 700);
  const SparseMap read = written_and_read(map, kFull);
  EXPECT_EQ(read.at({5, 5, 6}), 700);
}

TEST_F(OctomapFileTest, ReadsWhatOctomapWrites) {
  octomap::OcTree tree(0.5);
  tree.updateNode(octomap::point3d(1.25F, -0.75F, 3.25F), true);    // cell (2, -2, 6)
  tree.updateNode(octomap::point3d(-10.25F, 0.25F, 0.25F), false);  // cell (-21, 0, 0)
  tree.write(file.string());
  const SparseMap full = read_octomap(file, kFull);
  // OctoMap's hit is log(0.7/0.3), its miss log(0.4/0.6).
  EXPECT_EQ(full.at({2, -2, 6}), 847);
  EXPECT_EQ(full.at({-21, 0, 0}), -405);
  tree.writeBinary(file.string());
  const SparseMap binary = read_octomap(file, kBinary);
  EXPECT_EQ(binary.at({2, -2, 6}), 3511);
  EXPECT_EQ(binary.at({-21, 0, 0}), -2000);
  EXPECT_EQ(binary.brick_count(), 2U);
}

TEST_F(OctomapFileTest, ValuesBeyondACellAreKeptWithinIt) {
  octomap::OcTree tree(0.5);
  tree.setClampingThresMin(0.0);
  tree.setClampingThresMax(1.0);
  tree.setNodeValue(octomap::point3d(0.25F, 0.25F, 0.25F), 1e30F);
  tree.setNodeValue(octomap::point3d(0.75F, 0.25F, 0.25F), -1e30F);
  tree.write(file.string());
  const SparseMap read = read_octomap(file, kFull);
  EXPECT_EQ(read.at({0, 0, 0}), 32767);
  EXPECT_EQ(read.at({1, 0, 0}), -32767);
}

// --- errors

TEST_F(OctomapFileTest, AMapBeyondTheOctreeIsAFailure) {
  for (const Eigen::Vector3i& cell : {Eigen::Vector3i(32768, 0, 0),
                                      Eigen::Vector3i(0, -32769, 0),
                                      Eigen::Vector3i(0, 0, 99999)}) {
    SparseMap map = at_origin();
    map.set(cell, 100);
    EXPECT_THAT(message_of([&] { write_octomap(file, map, kFull); }, ErrorKind::kFailure),
                HasSubstr("beyond what an octree"));
  }
  SparseMap map({.origin_m = {1e9, 0.0, 0.0}, .voxel_m = 1e-3});
  map.set({0, 0, 0}, 100);
  EXPECT_THAT(message_of([&] { write_octomap(file, map, kFull); }, ErrorKind::kFailure),
              HasSubstr("beyond what an octree"));
  EXPECT_FALSE(std::filesystem::exists(file));
}

TEST_F(OctomapFileTest, LeavesThatWouldFillTheMemoryAreRefused) {
  // The whole octree occupied: 2^39 bricks, of one node.
  (void)folder.write("map.ot",
                     "# Octomap OcTree file\nid OcTree\nsize 1\nres 0.1\ndata\n" +
                         std::string("\0\0\x80\x3f\0", 5));
  EXPECT_THAT(message_of([&] { (void)read_octomap(file, kFull); }),
              HasSubstr("more than 4096 MiB"));
}

TEST_F(OctomapFileTest, TheLimitOfMemoryCountsNodesAndBricks) {
  SparseMap map = at_origin();
  for (int i = 0; i < 4000; ++i) {
    map.set({i % 20 * 8, i / 20 % 20 * 8, i / 400 * 8}, 100);
  }
  write_octomap(file, map, kFull);
  EXPECT_EQ(read_octomap(file, kFull).brick_count(), 4000U);
  EXPECT_THAT(message_of([&] { (void)read_octomap(file, kFull, 4U << 20U); }),
              HasSubstr("more than 4 MiB"));
  EXPECT_THAT(message_of([&] { (void)read_octomap(file, kFull, 1000); }), HasSubstr("0 MiB"));
}

TEST_F(OctomapFileTest, FilesThatCannotBeReadAreNamed) {
  EXPECT_THAT(message_of([&] { (void)read_octomap(file, kFull); }), HasSubstr("no such file"));
  EXPECT_THAT(message_of([&] { (void)read_octomap(folder.path(), kFull); }),
              HasSubstr("regular file"));
  EXPECT_THAT(message_of([&] { (void)read_octomap("/dev/zero", kFull); }),
              HasSubstr("regular file"));
}

TEST_F(OctomapFileTest, AColourTreeIsNamed) {
  octomap::ColorOcTree tree(0.1);
  tree.updateNode(octomap::point3d(0.0F, 0.0F, 0.0F), true);
  tree.write(file.string());
  EXPECT_THAT(message_of([&] { (void)read_octomap(file, kFull); }),
              HasSubstr("expected id OcTree"));
}

TEST_F(OctomapFileTest, EveryByteThatChangesIsReadOrRefusedInWords) {
  SparseMap map = at_origin();
  map.set({0, 0, 0}, 1000);
  map.set({9, 0, 0}, -1000);
  for (const OctreeForm form : {kFull, kBinary}) {
    write_octomap(file, map, form);
    const std::string whole = read_bytes(file);
    ::testing::internal::CaptureStderr();
    for (std::size_t at = 0; at < whole.size(); ++at) {
      for (const int change : {1, 16, 128, 255}) {
        std::string bytes = whole;
        bytes[at] = static_cast<char>(bytes[at] ^ change);
        std::filesystem::remove(folder.path() / "damaged");
        (void)folder.write("damaged", bytes);
        try {
          EXPECT_LE(read_octomap(folder.path() / "damaged", form, 64U << 20U).brick_count(),
                    (64U << 20U) / 192U);
        } catch (const Error& error) {
          EXPECT_EQ(error.kind(), ErrorKind::kInput);
          EXPECT_THAT(error.what(), HasSubstr("damaged"));
        }
      }
    }
    EXPECT_THAT(::testing::internal::GetCapturedStderr(), IsEmpty()) << "OctoMap says something";
  }
}

TEST_F(OctomapFileProperty, RandomMapsComeBack) {
  for (unsigned seed = 0; seed < 5; ++seed) {
    SCOPED_TRACE(seed);
    const SparseMap map = testing::random_map(seed, 60, 4);  // origin (-6, 9, 0.5) cells
    const SparseMap read = written_and_read(map, kFull);
    SparseMap expected = at_origin();
    for (const Eigen::Vector3i& brick : map.bricks()) {
      for (std::size_t place = 0; place < kBrickCells; ++place) {
        const Eigen::Vector3i cell = cell_in_brick(brick, place);
        if (map.at(cell) != kUnknown) {
          expected.set(cell + Eigen::Vector3i(-6, 9, 1), map.at(cell));
        }
      }
    }
    EXPECT_THAT(difference(expected, read), IsEmpty());
  }
}

TEST_F(OctomapFileProperty, OctomapFindsEveryCell) {
  const SparseMap map = testing::random_map(9, 40, 2);
  write_octomap(file, map, kFull);
  const auto tree = octree();
  ASSERT_NE(tree, nullptr);
  std::size_t known = 0;
  for (const Eigen::Vector3i& brick : map.bricks()) {
    for (std::size_t place = 0; place < kBrickCells; ++place) {
      const Eigen::Vector3i cell = cell_in_brick(brick, place);
      const Eigen::Vector3i key = cell + Eigen::Vector3i(32768 - 6, 32768 + 9, 32768 + 1);
      const octomap::OcTreeNode* const node =
          tree->search(octomap::OcTreeKey(static_cast<octomap::key_type>(key.x()),
                                          static_cast<octomap::key_type>(key.y()),
                                          static_cast<octomap::key_type>(key.z())));
      ASSERT_EQ(node != nullptr, map.at(cell) != kUnknown) << cell.transpose();
      if (node != nullptr) {
        ASSERT_NEAR(node->getLogOdds(), 0.001 * map.at(cell), 1e-5);
        ++known;
      }
    }
  }
  EXPECT_GT(known, 5000U);
}

}  // namespace
}  // namespace skyhalo

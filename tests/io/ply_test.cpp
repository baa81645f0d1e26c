#include "skyhalo/io/ply.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>
#include <string>
#include <vector>

#include "skyhalo/io/text_file.hpp"
#include "support/expect_error.hpp"
#include "support/temp_folder.hpp"

namespace skyhalo {
namespace {

using ::testing::HasSubstr;
using testing::message_of;
using testing::TempFolder;

/// The header's lines without comments, and what follows the header.
struct Ply {
  std::vector<std::string> header;
  std::string body;
};

Ply read_ply(const std::filesystem::path& file) {
  const std::string bytes = read_bytes(file);
  const std::string end = "end_header\n";
  const std::size_t at = bytes.find(end);
  Ply ply;
  ply.body = at == std::string::npos ? "" : bytes.substr(at + end.size());
  std::istringstream lines(bytes.substr(0, at));
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with("comment")) {
      ply.header.push_back(line);
    }
  }
  return ply;
}

TEST(PlyTest, HasTheBytesOfTheFormat) {
  const TempFolder folder;
  const auto file = folder.path() / "points.ply";
  write_ply(file, {{{1.0F, -2.0F, 0.5F}, {10, 20, 30}}, {{0.0F, 3.0F, -0.0F}, {255, 0, 1}}});
  const Ply ply = read_ply(file);
  EXPECT_THAT(ply.header,
              ::testing::ElementsAre("ply",
                                     "format binary_little_endian 1.0",
                                     "element vertex 2",
                                     "property float x",
                                     "property float y",
                                     "property float z",
                                     "property uchar red",
                                     "property uchar green",
                                     "property uchar blue"));
  // IEEE 754: 1 = 3f800000, -2 = c0000000, 0.5 = 3f000000, 3 = 40400000, -0 = 80000000; low byte
  // first.
  const std::string expected =
      std::string("\x00\x00\x80\x3f\x00\x00\x00\xc0\x00\x00\x00\x3f\x1e\x14\x0a", 15) +
      std::string("\x00\x00\x00\x00\x00\x00\x40\x40\x00\x00\x00\x80\x01\x00\xff", 15);
  EXPECT_EQ(ply.body, expected);
}

TEST(PlyTest, NoPointsAreAValidFile) {
  const TempFolder folder;
  const auto file = folder.path() / "points.ply";
  write_ply(file, {});
  const Ply ply = read_ply(file);
  EXPECT_THAT(ply.header, ::testing::Contains("element vertex 0"));
  EXPECT_EQ(ply.body, "");
}

TEST(PlyTest, AFileThatCannotBeWrittenIsAFailure) {
  const TempFolder folder;
  const auto file = folder.path() / "missing" / "points.ply";
  EXPECT_THAT(message_of([&] { write_ply(file, {}); }, ErrorKind::kFailure),
              HasSubstr(file.string()));
}

}  // namespace
}  // namespace skyhalo

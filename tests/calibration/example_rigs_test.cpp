// The rig files that come with the project.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <string>

#include "skyhalo/calibration/rig_check.hpp"
#include "skyhalo/calibration/rig_file.hpp"
#include "skyhalo/geometry/angle.hpp"

namespace skyhalo {
namespace {

namespace fs = std::filesystem;
using ::testing::IsEmpty;
using ::testing::SizeIs;

const fs::path kRigs = fs::path(SKYHALO_SOURCE_DIR) / "config/rigs";

TEST(ExampleRigsTest, AllCanBeUsedAndNothingLooksWrong) {
  int count = 0;
  for (const fs::directory_entry& entry : fs::directory_iterator(kRigs)) {
    SCOPED_TRACE(entry.path().string());
    ASSERT_EQ(entry.path().extension(), ".yaml");
    const RigFile file = read_rig_file(entry.path());
    EXPECT_THAT(file.warnings, IsEmpty());
    const RigReport report = check_rig(file.description, {});
    EXPECT_THAT(report.warnings, IsEmpty());
    EXPECT_THAT(report.unusable, IsEmpty());
    EXPECT_EQ(report.pairs.size(), file.description.pairs.size());
    EXPECT_EQ(load_rig(entry.path()).pairs.size(), file.description.pairs.size());
    EXPECT_EQ(file.description.name, entry.path().stem().string());
    ++count;
  }
  EXPECT_GE(count, 4);
}

/// What the thesis says of a pair (METHOD 8), and the way that it looks.
struct PlatformPair {
  std::string name;
  cv::Size size_px;
  double hfov_deg;
  bool spherical;
  Eigen::Vector3d axis_body;
  Eigen::Vector3d rows_body;
};

TEST(ExampleRigsTest, TheReferencePlatformIsThatOfTheThesis) {
  const double c = std::cos(rad_from_deg(100.0));
  const double s = std::sin(rad_from_deg(100.0));
  // The rows of an image run to the right of where its camera looks.
  const std::vector<PlatformPair> expected = {
      {"front", {1920, 1080}, 91.0, false, {1, 0, 0}, {0, -1, 0}},
      {"left", {1280, 720}, 170.0, true, {c, s, 0}, {s, -c, 0}},
      {"right", {1280, 720}, 170.0, true, {c, -s, 0}, {-s, -c, 0}},
      {"down", {1280, 720}, 105.0, false, {0, 0, -1}, {0, -1, 0}}};
  const RigDescription rig = read_rig_file(kRigs / "matrice100.yaml").description;
  const RigReport report = check_rig(rig, {});
  ASSERT_THAT(report.pairs, SizeIs(expected.size()));
  for (std::size_t i = 0; i < expected.size(); ++i) {
    const PairReport& pair = report.pairs[i];
    SCOPED_TRACE(pair.name);
    EXPECT_EQ(pair.name, expected[i].name);
    EXPECT_TRUE(pair.raw);
    EXPECT_EQ(pair.size_px, expected[i].size_px);
    EXPECT_NEAR(baseline_m(pair.model), 0.15, 1e-12);
    EXPECT_NEAR(deg_from_rad(pair.field.horizontal_rad), expected[i].hfov_deg, 1e-9);
    EXPECT_EQ(std::holds_alternative<SphericalPair>(pair.model), expected[i].spherical);
    EXPECT_LT((pair.axis_body - expected[i].axis_body).norm(), 1e-12);
    EXPECT_LT((pair.rows_body - expected[i].rows_body).norm(), 1e-12);
    EXPECT_GT(pair.seen_share, 0.99);
    const RawPair& cameras = std::get<RawPairDescription>(rig.pairs[i].images).cameras;
    EXPECT_EQ(cameras.left.size_px, expected[i].size_px);
    EXPECT_EQ(cameras.right.size_px, expected[i].size_px);
    EXPECT_EQ(rig.pairs[i].rcrop_px, 64);  // the thesis's value
    EXPECT_EQ(rig.pairs[i].downscale, 2);
    EXPECT_GT(rig.pairs[i].line_time_s, 0.0);  // rolling shutters
    // On a frame 65 cm across.
    EXPECT_LT(pair.position_body_m.norm(), 0.33);
  }
}

TEST(ExampleRigsTest, TheSideCamerasAreFisheyesOf175Degrees) {
  const RigDescription rig = read_rig_file(kRigs / "matrice100.yaml").description;
  for (const std::size_t i : {1U, 2U}) {
    const RawCamera& camera = std::get<RawPairDescription>(rig.pairs.at(i).images).cameras.right;
    EXPECT_TRUE(std::holds_alternative<KannalaBrandtLens>(camera.lens));
    // From edge to edge of the 1280 columns; the angle grows evenly.
    EXPECT_NEAR(deg_from_rad(1280.0 / intrinsics(camera.lens).fx_px), 175.0, 0.01);
  }
}

TEST(ExampleRigsTest, TheLeftCamerasStandToTheLeft) {
  for (const fs::directory_entry& entry : fs::directory_iterator(kRigs)) {
    for (const PairDescription& pair : read_rig_file(entry.path()).description.pairs) {
      if (const auto* raw = std::get_if<RawPairDescription>(&pair.images)) {
        EXPECT_LT(raw->cameras.T_right_left.translation().x(), -0.05) << entry.path();
      }
    }
  }
}

}  // namespace
}  // namespace skyhalo

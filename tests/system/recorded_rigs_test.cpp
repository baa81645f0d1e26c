// The program and the library with the rig files of recordings: the same as with the recordings'
// own calibration.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <random>
#include <string>
#include <vector>

#include "skyhalo/calibration/calibration_import.hpp"
#include "skyhalo/calibration/rig_file.hpp"
#include "skyhalo/dataset/kitti_raw.hpp"
#include "skyhalo/io/image_file.hpp"
#include "skyhalo/io/text_file.hpp"
#include "support/program.hpp"
#include "support/recorded_data.hpp"
#include "support/temp_folder.hpp"

namespace skyhalo {
namespace {

namespace fs = std::filesystem;
using testing::ProgramResult;
using testing::recorded_data;
using testing::recorded_drive;
using testing::run_program;
using testing::TempFolder;

const fs::path kRigs = fs::path(SKYHALO_SOURCE_DIR) / "config/rigs";

/// The point that a pixel with a disparity sees, in body.
Eigen::Vector3d point(const StereoPair& pair, const Eigen::Vector3d& pixel_and_disparity_px) {
  const Eigen::Vector3d& p = pixel_and_disparity_px;
  return pair.T_body_camera * reproject(pair.model, p.x(), p.y(), p.z());
}

/// Expects the same points of random pixels and disparities, within 1e-9 of their range.
void expect_same_points(const StereoPair& actual, const StereoPair& expected) {
  ASSERT_EQ(actual.image_size_px, expected.image_size_px);
  std::mt19937 random(3);
  const auto in = [&](double from, double to) {
    return std::uniform_real_distribution<double>(from, to)(random);
  };
  for (int i = 0; i < 10000; ++i) {
    const Eigen::Vector3d pixel(in(0, expected.image_size_px.width - 1),
                                in(0, expected.image_size_px.height - 1),
                                in(1, 128));
    const Eigen::Vector3d p = point(expected, pixel);
    ASSERT_LE((point(actual, pixel) - p).norm(), 1e-9 * p.norm()) << pixel.transpose();
  }
}

TEST(RecordedRigsSystem, TheKittiRigIsTheCalibrationOfTheDrive) {
  SKYHALO_SKIP_WITHOUT(recorded_drive());
  const KittiRawDrive own(recorded_drive(), {});
  const RigDescription rig = read_rig_file(kRigs / "kitti.yaml").description;
  ASSERT_EQ(rig.pairs.size(), 1U);
  ASSERT_TRUE(rig.T_body_imu.has_value());
  EXPECT_EQ(rig.T_body_imu->matrix(), Eigen::Matrix4d::Identity());  // the body is the INS
  expect_same_points(resolve(rig).pairs[0], own.rig().pairs.at(0));
  const KittiRawDrive given(recorded_drive(), {}, KittiRig{resolve(rig), *rig.T_body_imu});
  expect_same_points(given.rig().pairs.at(0), own.rig().pairs.at(0));
}

TEST(RecordedRigsSystem, TheEurocRigIsTheCalibrationOfTheFlight) {
  const fs::path flight = recorded_data() / "euroc_V1_01_flight";
  SKYHALO_SKIP_WITHOUT(flight);
  const RigDescription own =
      import_calibration(
          {flight},
          {.format = CalibrationFormat::kEuroc, .mounting = {}, .size_px = {}, .name = ""})
          .rig;
  const RigDescription given = read_rig_file(kRigs / "euroc.yaml").description;
  expect_same_points(resolve(given).pairs.at(0), resolve(own).pairs.at(0));
  ASSERT_TRUE(given.T_body_imu && own.T_body_imu);
  EXPECT_TRUE(given.T_body_imu->isApprox(*own.T_body_imu, 1e-12));
}

/// Runs over the first five frames of the drive into `folder`.
void run_drive(const TempFolder& folder, std::vector<std::string> more) {
  more.insert(more.begin(), {"run", recorded_drive().string(), "--frames", "0:4", "--quiet"});
  more.insert(more.end(), {"--out", (folder.path() / "out").string()});
  const ProgramResult result = run_program(SKYHALO_PROGRAM, more, folder.path());
  ASSERT_EQ(result.exit_code, 0) << result.err;
}

TEST(RecordedRigsSystem, ARunWithTheKittiRigGivesTheSameMaps) {
  SKYHALO_SKIP_WITHOUT(recorded_drive());
  const TempFolder own;
  const TempFolder given;
  run_drive(own, {});
  run_drive(given, {"--rig", (kRigs / "kitti.yaml").string()});
  for (const std::string name : {"map.ply", "map.ot", "trajectory.tum"}) {
    const std::string expected = read_bytes(own.path() / "out" / name);
    EXPECT_GT(expected.size(), 500U);
    EXPECT_TRUE(read_bytes(given.path() / "out" / name) == expected) << name;
  }
}

TEST(RecordedRigsSystem, ImportAndRectifyTheFisheyePair) {
  const fs::path data = recorded_data() / "fisheye_mynteye";
  SKYHALO_SKIP_WITHOUT(data);
  const TempFolder folder;
  const std::string rig = (folder.path() / "rig.yaml").string();
  const fs::path out = folder.path() / "out";
  const ProgramResult imported = run_program(SKYHALO_PROGRAM,
                                             {"rig",
                                              "import",
                                              (data / "left_sensor_fisheye.yaml").string(),
                                              (data / "right_sensor_fisheye.yaml").string(),
                                              "-o",
                                              rig},
                                             folder.path());
  ASSERT_EQ(imported.exit_code, 0) << imported.err;
  const ProgramResult rectify = run_program(SKYHALO_PROGRAM,
                                            {"rectify",
                                             (data / "left_fisheye_img_0.png").string(),
                                             (data / "right_fisheye_img_0.png").string(),
                                             "--rig",
                                             rig,
                                             "-o",
                                             out.string()},
                                            folder.path());
  ASSERT_EQ(rectify.exit_code, 0) << rectify.err;
  const nlohmann::json summary = nlohmann::json::parse(read_bytes(out / "summary.json"));
  EXPECT_NEAR(summary["baseline_m"].get<double>(), 0.1203, 1e-4);
  EXPECT_LE(summary["rows"]["median_abs_dv_px"].get<double>(), 0.3);
  const cv::Size size(summary["size_px"][0].get<int>(), summary["size_px"][1].get<int>());
  EXPECT_EQ(read_image(out / "left_000000.png").size(), size);
  EXPECT_EQ(read_image(out / "side_by_side.png").size(), cv::Size(2 * size.width, size.height));
  // The rectified pair is a spherical one, and its rig says so.
  const StereoPair pair = load_rig(out / "rig.yaml").pairs.at(0);
  EXPECT_TRUE(std::holds_alternative<SphericalPair>(pair.model));
  EXPECT_EQ(pair.image_size_px, size);
}

}  // namespace
}  // namespace skyhalo

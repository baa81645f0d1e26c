// Rectification of recorded images: rows must be level whatever the lens model of the calibration.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "skyhalo/calibration/calibration_import.hpp"
#include "skyhalo/calibration/rig_check.hpp"
#include "skyhalo/dataset/euroc_flight.hpp"
#include "skyhalo/evaluation/row_difference.hpp"
#include "skyhalo/geometry/angle.hpp"
#include "skyhalo/io/epipolar_picture.hpp"
#include "skyhalo/io/image_file.hpp"
#include "skyhalo/rectify/rectifier.hpp"
#include "support/recorded_data.hpp"

namespace skyhalo {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::recorded_data;

const fs::path kStanding = recorded_data() / "euroc_micro_V1_01";
const fs::path kFlight = recorded_data() / "euroc_V1_01_flight";
const fs::path kFisheye = recorded_data() / "fisheye_mynteye";

/// The row differences of the matches of many pairs together.
struct Rows {
  std::vector<double> abs_dv_px;
  int negative = 0;
  int pairs = 0;

  void add(const RectifiedPair& pair) {
    const RowDifference rows =
        row_difference(pair.left, pair.right, pair.left_valid, pair.right_valid);
    EXPECT_GT(rows.matches, 20) << "pair " << pairs;
    EXPECT_GT(rows.median_disparity_px, 0.0) << "pair " << pairs;
    for (const PairMatch& match : rows.inliers) {
      abs_dv_px.push_back(std::abs(match.dv_px));
      negative += match.disparity_px < 0.0 ? 1 : 0;
    }
    ++pairs;
  }

  [[nodiscard]] double median_px() {
    const auto middle = abs_dv_px.begin() + static_cast<std::ptrdiff_t>(abs_dv_px.size() / 2);
    std::nth_element(abs_dv_px.begin(), middle, abs_dv_px.end());
    return *middle;
  }

  [[nodiscard]] double negative_share() const {
    return static_cast<double>(negative) / static_cast<double>(abs_dv_px.size());
  }
};

RigDescription imported_rig(const std::vector<fs::path>& files) {
  const ImportResult imported = import_calibration(files, {});
  if (imported.format == CalibrationFormat::kBasalt) {  // these refer to cam0 and not to an IMU
    EXPECT_THAT(imported.warnings, ElementsAre(HasSubstr("first camera is the identity")));
  } else {
    EXPECT_THAT(imported.warnings, IsEmpty());
  }
  EXPECT_THAT(check_rig(imported.rig, {}).warnings, IsEmpty());
  return imported.rig;
}

/// Expects level rows and positive disparities in all pairs of a flight.
void expect_level(const fs::path& flight, const RigDescription& rig, int pairs, double limit_px) {
  const EurocFlight source(flight, resolve(rig), rig.T_body_imu.value_or(Pose::Identity()));
  ASSERT_EQ(source.frame_count(), pairs);
  Rectifier rectifier(source.rig().pairs.front(), 1);
  Rows rows;
  for (int frame = 0; frame < pairs; ++frame) {
    rows.add(rectifier.rectify(source.read(frame).pairs.front()));
  }
  ::testing::Test::RecordProperty("matches", std::to_string(rows.abs_dv_px.size()));
  ::testing::Test::RecordProperty("median_abs_dv_px", std::to_string(rows.median_px()));
  ::testing::Test::RecordProperty("negative_share", std::to_string(rows.negative_share()));
  EXPECT_GT(rows.abs_dv_px.size(), static_cast<std::size_t>(pairs) * 100);
  EXPECT_LE(rows.median_px(), limit_px);
  EXPECT_LE(rows.negative_share(), 0.02);
}

TEST(RecordedRectificationSystem, AStandingDrone) {
  SKYHALO_SKIP_WITHOUT(kStanding);
  expect_level(kStanding, imported_rig({kStanding / "mav0"}), 4, 0.2);
}

TEST(RecordedRectificationSystem, AFlightWithRadialTangentialLenses) {
  SKYHALO_SKIP_WITHOUT(kFlight);
  expect_level(kFlight, imported_rig({kFlight / "mav0"}), 50, 0.3);
}

/// The flight with the same cameras in another lens model.
void expect_level_with(const std::string& calibration, std::size_t lens_index) {
  const RigDescription rig = imported_rig({kFlight / "calib" / calibration});
  const RawPair& cameras = std::get<RawPairDescription>(rig.pairs.at(0).images).cameras;
  EXPECT_EQ(cameras.left.lens.index(), lens_index);
  EXPECT_EQ(cameras.right.lens.index(), lens_index);
  expect_level(kFlight, rig, 50, 0.3);
}

TEST(RecordedRectificationSystem, AFlightWithKannalaBrandtLenses) {
  SKYHALO_SKIP_WITHOUT(kFlight);
  expect_level_with("gt_calib_kb4.json", 1);
}

TEST(RecordedRectificationSystem, AFlightWithDoubleSphereLenses) {
  SKYHALO_SKIP_WITHOUT(kFlight);
  expect_level_with("gt_calib_ds.json", 2);
}

TEST(RecordedRectificationSystem, AFlightWithExtendedUnifiedLenses) {
  SKYHALO_SKIP_WITHOUT(kFlight);
  expect_level_with("gt_calib_eucm.json", 3);
}

TEST(RecordedRectificationSystem, TheRightCameraIsWhereItsPosesSay) {
  SKYHALO_SKIP_WITHOUT(kFlight);
  // T_BS of cam1 has the translation (-0.0198435579556, 0.0453689425024, 0.00786212447038) in the
  // IMU's axes: x up, y right, z forward. The body has x forward, y left, z up.
  const RigDescription rig = imported_rig({kFlight / "mav0"});
  const Eigen::Vector3d expected(0.00786212447038, -0.0453689425024, -0.0198435579556);
  EXPECT_LT((rig.pairs.at(0).T_body_camera.translation() - expected).norm(), 1e-12);
  const RigReport report = check_rig(rig, {});
  EXPECT_NEAR(baseline_m(report.pairs.at(0).model), 0.11007784, 1e-6);  // of T_BS0 and T_BS1
  EXPECT_GT(report.pairs.at(0).axis_body.x(), 0.999);
}

/// The fisheye pair and the rig of its calibration, rectified to one of the models.
struct Fisheye {
  explicit Fisheye(const VirtualPairWish& wish)
      : rig(imported_rig(
            {kFisheye / "left_sensor_fisheye.yaml", kFisheye / "right_sensor_fisheye.yaml"})) {
    std::get<RawPairDescription>(rig.pairs.at(0).images).rectify_to = wish;
    pair = resolve(rig).pairs.at(0);
    images = {read_image(kFisheye / "left_fisheye_img_0.png"),
              read_image(kFisheye / "right_fisheye_img_0.png")};
  }

  RigDescription rig;
  StereoPair pair;
  StereoImages images;
};

void expect_level(const Fisheye& fisheye) {
  Rectifier rectifier(fisheye.pair, 1);
  Rows rows;
  rows.add(rectifier.rectify(fisheye.images));
  ::testing::Test::RecordProperty("matches", std::to_string(rows.abs_dv_px.size()));
  ::testing::Test::RecordProperty("median_abs_dv_px", std::to_string(rows.median_px()));
  EXPECT_LE(rows.median_px(), 0.3);
  EXPECT_LE(rows.negative_share(), 0.02);
}

TEST(RecordedRectificationSystem, AFisheyePairToTheSphericalModel) {
  SKYHALO_SKIP_WITHOUT(kFisheye);
  const Fisheye fisheye({.model = PairModelKind::kSpherical});
  EXPECT_TRUE(std::holds_alternative<SphericalPair>(fisheye.pair.model));
  EXPECT_NEAR(baseline_m(fisheye.pair.model), 0.1203, 1e-4);
  EXPECT_GT(field_of_view(fisheye.pair.model, fisheye.pair.image_size_px).horizontal_rad,
            rad_from_deg(115.0));
  expect_level(fisheye);
}

TEST(RecordedRectificationSystem, AFisheyePairToAPinhole) {
  SKYHALO_SKIP_WITHOUT(kFisheye);
  const Fisheye fisheye({.model = PairModelKind::kPinhole, .hfov_rad = rad_from_deg(90.0)});
  EXPECT_TRUE(std::holds_alternative<PinholePair>(fisheye.pair.model));
  EXPECT_NEAR(field_of_view(fisheye.pair.model, fisheye.pair.image_size_px).horizontal_rad,
              rad_from_deg(90.0),
              1e-9);
  expect_level(fisheye);
}

TEST(RecordedRectificationSystem, SwappedImagesShowInTheirDisparities) {
  SKYHALO_SKIP_WITHOUT(kFisheye);
  const Fisheye fisheye({.model = PairModelKind::kSpherical});
  Rectifier rectifier(fisheye.pair, 1);
  const RectifiedPair& pair = rectifier.rectify(fisheye.images);
  const RowDifference swapped =
      row_difference(pair.right, pair.left, pair.right_valid, pair.left_valid);
  EXPECT_GT(swapped.negative_disparity_share, 0.9);
}

}  // namespace
}  // namespace skyhalo

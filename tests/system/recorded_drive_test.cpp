// The recorded KITTI drive: poses, calibration, boxes and ground truth, each held by a number of
// its own.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "skyhalo/dataset/kitti_labels.hpp"
#include "skyhalo/dataset/kitti_raw.hpp"
#include "skyhalo/evaluation/ground_truth.hpp"
#include "skyhalo/io/text_file.hpp"
#include "skyhalo/rectify/rectifier.hpp"
#include "skyhalo/stereo/matcher.hpp"
#include "support/recorded_data.hpp"

namespace skyhalo {
namespace {

using testing::recorded_drive;
using testing::recorded_labels;

constexpr double kRangeM = 33.0;

TEST(RecordedDriveSystem, PosesMoveAsFastAsTheInsSays) {
  SKYHALO_SKIP_WITHOUT(recorded_drive());
  const KittiRawDrive drive(recorded_drive(), {});
  ASSERT_EQ(drive.frame_count(), 72);
  double path_m = 0.0;
  double expected_m = 0.0;
  double sideways_m = 0.0;
  for (int frame = 1; frame < drive.frame_count(); ++frame) {
    const Pose T_before_now = drive.T_map_body(frame - 1).inverse() * drive.T_map_body(frame);
    path_m += T_before_now.translation().norm();
    sideways_m += std::abs(T_before_now.translation().y());
    // Columns 9 to 11 of the INS file are the speeds forward, leftward and upward; the poses come
    // from columns 1 to 6.
    const std::string name = "0000000000" + std::to_string(frame);
    const std::string line =
        read_lines(recorded_drive() / "oxts/data" / (name.substr(name.size() - 10) + ".txt"))
            .front();
    const double speed_mps = *parse_number(split_words(line)[8]);
    expected_m += speed_mps * (seconds_since_epoch(drive.stamp(frame)) -
                               seconds_since_epoch(drive.stamp(frame - 1)));
  }
  EXPECT_GT(expected_m, 50.0);
  EXPECT_NEAR(path_m, expected_m, 0.01 * expected_m);
  EXPECT_LT(sideways_m, 0.03 * path_m);  // a car drives forward
}

TEST(RecordedDriveSystem, CalibrationPutsLaserPointsOnTheMeasuredDisparity) {
  SKYHALO_SKIP_WITHOUT(recorded_drive());
  const KittiRawDrive drive(recorded_drive(), {});
  const StereoPair& pair = drive.rig().pairs.front();
  EXPECT_NEAR(std::get<PinholePair>(pair.model).baseline_m,
              0.5372,
              1e-4);  // as the data's description says
  EXPECT_NEAR(std::get<PinholePair>(pair.model).focal_px, 721.54, 0.01);

  Rectifier rectifier(pair, 1);
  const RectifiedPair& images = rectifier.rectify(drive.read(0).pairs.front());
  Matcher matcher({.max_disparity_px = 128});
  cv::Mat1f disparity;
  matcher.match(images.left, images.right, disparity);

  const Pose T_camera_laser = pair.T_body_camera.inverse() * drive.T_body_laser();
  std::vector<double> errors_px;
  const std::optional<LaserScan> scan = drive.read_scan(0);
  ASSERT_TRUE(scan.has_value());
  for (const Eigen::Vector3f& point : *scan) {
    const Eigen::Vector3d p_camera_m = T_camera_laser * point.cast<double>();
    if (p_camera_m.z() < 4.0) {
      continue;
    }
    const Eigen::Vector3d expected = project(pair.model, p_camera_m);
    const cv::Point pixel(static_cast<int>(std::lround(expected.x())),
                          static_cast<int>(std::lround(expected.y())));
    if (pixel.inside(cv::Rect({0, 0}, disparity.size())) && !std::isnan(disparity(pixel))) {
      errors_px.push_back(std::abs(static_cast<double>(disparity(pixel)) - expected.z()));
    }
  }
  ASSERT_GT(errors_px.size(), 5000U);
  std::nth_element(errors_px.begin(),
                   errors_px.begin() + static_cast<long>(errors_px.size() / 2),
                   errors_px.end());
  const double median_px = errors_px[errors_px.size() / 2];
  RecordProperty("median_disparity_error_px", std::to_string(median_px));
  EXPECT_LT(median_px, 1.0);
}

TEST(RecordedDriveSystem, TheBoxOfTheNearCarIsFullOfPoints) {
  SKYHALO_SKIP_WITHOUT(recorded_drive());
  const KittiRawDrive drive(recorded_drive(), {});
  const TrackLabels labels(recorded_labels());
  const auto objects = labels.objects(0);
  const auto nearest =
      std::min_element(objects.begin(), objects.end(), [](const auto& a, const auto& b) {
        return a.box.corner_m.norm() < b.box.corner_m.norm();
      });
  ASSERT_NE(nearest, objects.end());
  EXPECT_EQ(nearest->type, "Car");
  const std::optional<LaserScan> scan = drive.read_scan(0);
  ASSERT_TRUE(scan.has_value());
  const Pose T_annotation_laser = drive.T_annotation_laser();
  const auto inside = std::count_if(scan->begin(), scan->end(), [&](const Eigen::Vector3f& point) {
    return contains(nearest->box, T_annotation_laser * point.cast<double>());
  });
  EXPECT_GT(inside, 1000);
}

TEST(RecordedDriveSystem, GroundTruthHasTheCellsOfAnIndependentCount) {
  SKYHALO_SKIP_WITHOUT(recorded_drive());
  const KittiRawDrive drive(recorded_drive(), {});
  const TrackLabels labels(recorded_labels());
  const Eigen::AlignedBox3d bounds(Eigen::Vector3d(0, -50, -3), Eigen::Vector3d(120, 50, 2.5));
  GroundTruth truth(make_voxel_grid(bounds, 0.5));
  ASSERT_EQ(truth.grid().cell_count(), 528000);
  for (int frame = 0; frame < drive.frame_count(); ++frame) {
    std::vector<OrientedBox> boxes;
    for (const TrackedObject& object : labels.objects(frame)) {
      boxes.push_back(object.box);
    }
    const std::optional<LaserScan> scan = drive.read_scan(frame);
    ASSERT_TRUE(scan.has_value());
    const TruthView view{drive.truth_camera(),
                         drive.T_annotation_laser(),
                         drive.T_map_body(frame) * drive.T_body_laser(),
                         kRangeM};
    truth.mark(occupied_cells(*scan, view, boxes, truth.grid()));
  }
  const auto occupied = static_cast<double>(truth.occupied_offsets().size());
  RecordProperty("occupied_cells", std::to_string(occupied));
  EXPECT_NEAR(occupied, 18024.0, 0.005 * 18024.0);
}

}  // namespace
}  // namespace skyhalo

// A simulated flight in KITTI's layout, read back as KITTI's own: its laser against the exact
// cells.

#include <gtest/gtest.h>

#include <algorithm>
#include <iostream>
#include <vector>

#include "skyhalo/dataset/kitti_labels.hpp"
#include "skyhalo/dataset/kitti_tracking.hpp"
#include "skyhalo/dataset/kitti_tracking_writer.hpp"
#include "skyhalo/evaluation/ground_truth.hpp"
#include "skyhalo/evaluation/tolerant_score.hpp"
#include "skyhalo/sim/exact_occupancy.hpp"
#include "skyhalo/sim/make_scene.hpp"
#include "skyhalo/sim/simulated_flight.hpp"
#include "skyhalo/sim/waypoint_flight.hpp"
#include "support/sanitised.hpp"
#include "support/temp_folder.hpp"

namespace skyhalo {
namespace {

constexpr int kFrames = 10;

StereoRig kitti_rig() {
  StereoPair pair{.name = "colour",
                  .image_size_px = {1242, 375},
                  .model = PinholePair{.focal_px = 721.5377,
                                       .principal_u_px = 609.5593,
                                       .principal_v_px = 172.854,
                                       .baseline_m = 0.5327}};
  pair.T_body_camera.linear() << 0.0, 0.0, 1.0, -1.0, 0.0, 0.0, 0.0, -1.0, 0.0;
  return {.pairs = {pair}};
}

/// How many cells of the ground truth there are, and how many of them something exact is in.
struct Agreement {
  std::size_t cells = 0;
  std::size_t exact = 0;
  std::size_t near = 0;  // within one cell
  std::size_t objects = 0;

  [[nodiscard]] double share() const {
    return static_cast<double>(exact) / static_cast<double>(cells);
  }

  [[nodiscard]] double near_share() const {
    return static_cast<double>(near) / static_cast<double>(cells);
  }
};

void write_flight(const SimulatedFlight& flight, const std::filesystem::path& folder) {
  KittiTrackingWriter writer(folder, 7, {flight.rig().pairs.front(), flight.config().T_body_laser});
  for (int frame = 0; frame < kFrames; ++frame) {
    LaserReturns scan;
    for (const LaserReturn& one : flight.laser_returns(frame)) {
      scan.points_m.push_back(one.point_m);
      scan.reflectances.push_back(one.reflectance);
    }
    const cv::Mat3b blank(375, 1242, cv::Vec3b(0, 0, 0));  // images do not matter here
    writer.add({.images = {blank, blank},
                .T_map_body = flight.T_scene_body(frame),
                .scan = scan,
                .objects = flight.objects(frame, {0.0, 0.5327, 0.0})});
  }
  writer.finish();
}

Agreement agreement(const std::string& name, double laser_sigma_m) {
  Scene scene = make_scene({.name = name});
  Trajectory trajectory = fly_waypoints(scene.route_m, {}, scene.route_closed);
  SimulationConfig config;
  config.frames = kFrames;
  config.rate_hz = 2.0;
  config.laser.range_sigma_m = laser_sigma_m;
  const SimulatedFlight flight(std::move(scene), std::move(trajectory), kitti_rig(), config);
  const testing::TempFolder folder;
  write_flight(flight, folder.path() / "kitti");

  const KittiTrackingSequence sequence(folder.path() / "kitti", "0007");
  const TrackLabels labels(sequence.label_file());
  // The sequence's map frame is its first body.
  TriangleMesh mesh;
  append(mesh, flight.scene().fixed, flight.T_scene_body(0).inverse());
  const VoxelGrid grid =
      make_voxel_grid({Eigen::Vector3d(-10.0, -40.0, -8.0), Eigen::Vector3d(60.0, 40.0, 8.0)}, 0.5);
  const std::vector<std::uint8_t> exact = exact_occupancy(mesh, grid);
  GroundTruth truth(grid);
  Agreement found;
  for (int frame = 0; frame < kFrames; ++frame) {
    std::vector<OrientedBox> boxes;
    for (const TrackedObject& object : labels.objects(frame)) {
      boxes.push_back(object.box);
    }
    found.objects += boxes.size();
    truth.mark(occupied_cells(*sequence.read_scan(frame),
                              {sequence.truth_camera(),
                               sequence.T_annotation_laser(),
                               sequence.T_map_body(frame) * sequence.T_body_laser(),
                               33.0},
                              boxes,
                              grid));
  }
  for (const std::int64_t cell : truth.occupied_offsets()) {
    ++found.cells;
    found.exact += exact[static_cast<std::size_t>(cell)];
  }
  std::vector<LogOdds> claimed(exact.size(), kUnknown);
  for (const std::int64_t cell : truth.occupied_offsets()) {
    claimed[static_cast<std::size_t>(cell)] = 5000;
  }
  const std::vector<std::uint8_t> all(exact.size(), 1);
  found.near =
      static_cast<std::size_t>(tolerant_score({grid, claimed, exact, all}, 0.7).claimed_right);
  std::cout << name << ", sigma " << laser_sigma_m << " m: " << found.exact << " of " << found.cells
            << " cells (" << found.share() << "), " << found.near_share() << " within one, "
            << found.objects << " boxes\n";
  return found;
}

TEST(KittiFlightSystem, LaserTruthAgreesWithTheExactCellsWhereThingsMove) {
  const Agreement found = agreement("yard", 0.0);
  EXPECT_GT(found.cells, 1000U);
  EXPECT_GT(found.objects, 5U);
  EXPECT_GE(found.share(), 0.99);
}

TEST(KittiFlightSystem, LaserTruthAgreesWithTheExactCellsOfLeaves) {
  if (testing::kSanitised) {
    GTEST_SKIP() << "takes minutes under a sanitiser, and others run the same code there";
  }
  const Agreement found = agreement("forest", 0.0);
  EXPECT_GT(found.cells, 1000U);
  EXPECT_GE(found.share(), 0.99);
}

TEST(KittiFlightSystem, NoiseOfTheLaserLeavesCellsBesideTheExactOnes) {
  if (testing::kSanitised) {
    GTEST_SKIP() << "takes minutes under a sanitiser, and others run the same code there";
  }
  const Agreement found = agreement("yard", 0.02);
  EXPECT_GE(found.share(), 0.85);
  EXPECT_GE(found.near_share(), 0.999);
}

}  // namespace
}  // namespace skyhalo

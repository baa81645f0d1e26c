// Scans entered into maps against the naive integration, cell by cell.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <sstream>
#include <string>
#include <vector>

#include "map/random_scans.hpp"
#include "reference/naive_scan_integration.hpp"
#include "skyhalo/map/dense_map.hpp"
#include "skyhalo/map/local_map.hpp"
#include "skyhalo/map/scan_integrator.hpp"
#include "skyhalo/map/sparse_map.hpp"
#include "support/instruction_set.hpp"

namespace skyhalo {
namespace {

using reference::NaiveBox;
using reference::NaiveIncrements;
using testing::Random;

/// What the table of the model's increments may be wrong by, in units of log odds: 0.04.
constexpr int kAllowedUnits = NaiveIncrements::kMostDoubt;
/// A limit that a single scan never comes to.
constexpr int kNoLimitUnits = 32000;
/// Cells of which the scans of a test say something, at the least.
constexpr int kLeastSaid = 3000;

/// One scan and the maps it goes into.
struct Case {
  std::string name;
  RangeScan scan;
  Pose T_map_body = Pose::Identity();
  double voxel_m = 0.25;
  Eigen::Vector3i size = Eigen::Vector3i(40, 40, 20);
  SensorModelConfig sensor{};
};

reference::NaiveScan naive_scan(const RangeScan& scan) {
  reference::NaiveScan naive = reference::naive_unseen_scan(scan.rows());
  naive.z_m.assign(scan.z_m().begin(), scan.z_m().end());
  naive.delta_z_m.assign(scan.delta_z_m().begin(), scan.delta_z_m().end());
  naive.free_to_m.assign(scan.free_to_m().begin(), scan.free_to_m().end());
  return naive;
}

NaiveIncrements naive_increments(const Case& one,
                                 const NaiveBox& box,
                                 IntegrationMethod method,
                                 bool cell_size_term = true) {
  return reference::naive_scan_integration(
      method == IntegrationMethod::kRays ? reference::NaiveMethod::kRays
                                         : reference::NaiveMethod::kSweep,
      naive_scan(one.scan),
      one.T_map_body,
      {.model = {.k = one.sensor.k, .p_unknown = one.sensor.p_unknown, .p_free = one.sensor.p_free},
       .cell_size_term = cell_size_term},
      box);
}

/// The cells of the scan's map, from `first` on.
NaiveBox box_of(const Case& one, const Eigen::Vector3d& origin_m, const Eigen::Vector3i& first) {
  return {.origin_m = origin_m, .voxel_m = one.voxel_m, .first = first, .size = one.size};
}

IntegrationConfig config_of(const Case& one, IntegrationMethod method, int limit_units) {
  IntegrationConfig config;
  config.sensor = one.sensor;
  config.limit_units = limit_units;
  config.method = method;
  return config;
}

DenseMap dense_map(const NaiveBox& box) {
  return DenseMap(VoxelGrid{.min_m = box.origin_m, .voxel_m = box.voxel_m, .size = box.size});
}

/// Counts of a comparison, and the first cells that disagree.
struct Outcome {
  int compared = 0;
  int left_out = 0;  ///< hang on a comparison too close to call
  int wrong = 0;
  int worst_units = 0;
  std::string first_wrong{};
};

void describe(Outcome& outcome, const Eigen::Vector3i& cell, int expected, LogOdds found) {
  if (++outcome.wrong <= 5) {
    std::ostringstream text;
    text << "cell " << cell.transpose() << ": expected " << expected << ", found " << found << '\n';
    outcome.first_wrong += text.str();
  }
}

template <class Map>
Outcome compare(const Map& map, const NaiveIncrements& naive) {
  Outcome outcome;
  for (std::size_t i = 0; i < naive.box().cell_count(); ++i) {
    const Eigen::Vector3i cell = naive.box().cell(i);
    const int expected = naive.increment(i);
    const LogOdds found = map.at(cell);
    const int units = found == kUnknown ? 0 : found;
    if (naive.near_border(i)) {
      ++outcome.left_out;
      continue;
    }
    ++outcome.compared;
    outcome.worst_units = std::max(outcome.worst_units, std::abs(units - expected));
    const bool vague = naive.says(i) && std::abs(expected) <= kAllowedUnits;
    const bool wrongly_known = !vague && (found == kUnknown) != (expected == 0);
    if (std::abs(units - expected) > kAllowedUnits || wrongly_known) {
      describe(outcome, cell, expected, found);
    }
  }
  return outcome;
}

/// Cells of which the scan says something.
int said(const NaiveIncrements& naive) {
  int count = 0;
  for (std::size_t i = 0; i < naive.box().cell_count(); ++i) {
    count += naive.increment(i) != 0 ? 1 : 0;
  }
  return count;
}

/// Gives the number of cells of which the scan says something.
template <class Map>
int expect_agreement(const Map& map, const NaiveIncrements& naive, const std::string& name) {
  const Outcome outcome = compare(map, naive);
  EXPECT_EQ(outcome.wrong, 0) << name << ", worst by " << outcome.worst_units << " of "
                              << outcome.compared << " compared:\n"
                              << outcome.first_wrong;
  EXPECT_LT(outcome.left_out, 0.1 * outcome.compared) << name;
  ::testing::Test::RecordProperty(name + "_worst_units", outcome.worst_units);
  ::testing::Test::RecordProperty(name + "_left_out", outcome.left_out);
  ::testing::Test::RecordProperty(name + "_compared", outcome.compared);
  return said(naive);
}

/// Rooms and noise, 2 and 5 degrees, voxels of 0.1 to 0.5 m; a sixth is seen from outside of the
/// map that begins at the lattice's origin, a fifth has another p_unknown than 1/2.
std::vector<Case> cases() {
  std::vector<Case> all;
  Random random(20181);
  for (int i = 0; i < 24; ++i) {
    const double voxel_m = testing::between(random, 0.1, 0.5);
    const Eigen::Vector3i size{24 + static_cast<int>(random() % 17U),
                               24 + static_cast<int>(random() % 17U),
                               10 + static_cast<int>(random() % 11U)};
    const Eigen::Vector3d far_m = voxel_m * size.cast<double>();
    const bool outside = i % 6 == 5;
    const Eigen::AlignedBox3d about(
        outside ? Eigen::Vector3d(1.1 * far_m.x(), -0.5 * far_m.y(), 0.0) : 0.2 * far_m,
        outside ? Eigen::Vector3d(1.4 * far_m.x(), 0.5 * far_m.y(), far_m.z()) : 0.8 * far_m);
    const Pose T_map_body = testing::pose_in(random, about);
    const testing::Room room{
        {testing::between(random, -0.1, 0.15) * far_m, testing::between(random, 0.85, 1.2) * far_m},
        {0.4 * far_m, Eigen::Vector3d(0.45, 0.5, 0.9).cwiseProduct(far_m)}};
    const int rows = i % 2 == 0 ? 90 : 36;
    const double max_range_m = (outside ? 1.5 : testing::between(random, 0.4, 1.0)) * far_m.norm();
    all.push_back(
        {.name = "case_" + std::to_string(i),
         .scan = i % 4 < 3 ? testing::room_scan(random, rows, room, T_map_body, max_range_m)
                           : testing::noise_scan(random, rows, max_range_m),
         .T_map_body = T_map_body,
         .voxel_m = voxel_m,
         .size = size,
         .sensor = i % 5 != 4 ? SensorModelConfig{}
                              : SensorModelConfig{.k = 0.5, .p_unknown = 0.6, .p_free = 0.4}});
  }
  return all;
}

class ScanIntegrationReference : public ::testing::TestWithParam<IntegrationMethod> {};

TEST_P(ScanIntegrationReference, AScanInADenseMap) {
  int total = 0;
  for (const Case& one : cases()) {
    // Beside the lattice's planes and not at the origin.
    const Eigen::Vector3d origin_m(0.013, -0.04, 0.02);
    const NaiveBox box = box_of(one, origin_m, Eigen::Vector3i::Zero());
    DenseMap map = dense_map(box);
    ScanIntegrator integrator(config_of(one, GetParam(), kNoLimitUnits));
    (void)integrator.integrate(one.scan, one.T_map_body, map);
    total += expect_agreement(map, naive_increments(one, box, GetParam()), one.name);
  }
  EXPECT_GT(total, kLeastSaid);
}

TEST_P(ScanIntegrationReference, AScanInALocalMap) {
  int total = 0;
  for (const Case& one : cases()) {
    // The last scan is taken near a side of the map.
    const double aside = one.name == "case_23" ? 0.4 : 0.0;
    const Eigen::Vector3d aside_m = aside * one.voxel_m * one.size.cast<double>();
    LocalMap map(one.size, one.voxel_m);
    map.follow(one.T_map_body.translation() + aside_m);
    const NaiveBox box = box_of(one, Eigen::Vector3d::Zero(), map.bounds().min);
    ScanIntegrator integrator(config_of(one, GetParam(), kNoLimitUnits));
    (void)integrator.integrate(one.scan, one.T_map_body, map);
    total += expect_agreement(map, naive_increments(one, box, GetParam()), one.name);
  }
  EXPECT_GT(total, kLeastSaid);
}

TEST_P(ScanIntegrationReference, AScanInASparseMap) {
  int total = 0;
  for (const Case& one : cases()) {
    const VoxelLattice lattice{{0.3, -0.1, 5.0}, one.voxel_m};
    SparseMap map(lattice);
    const Eigen::Vector3i drone = lattice.cell_of(one.T_map_body.translation());
    const NaiveBox box = box_of(one, lattice.origin_m, drone - one.size / 2);
    ScanIntegrator integrator(config_of(one, GetParam(), kNoLimitUnits));
    (void)integrator.integrate(one.scan, one.T_map_body, map);
    total += expect_agreement(map, naive_increments(one, box, GetParam()), one.name);
  }
  EXPECT_GT(total, kLeastSaid);
}

/// A scan of things up to 1 m away, with nothing about the poles: there a steep patch is much
/// longer than its range.
RangeScan short_scan(Random& random) {
  RangeScan scan = testing::noise_scan(random, 36, 1.0);
  for (const int row : {0, 1, 2, 33, 34, 35}) {
    for (int col = 0; col < scan.cols(); ++col) {
      scan.set_free(row, col, 0.0F);
    }
  }
  return scan;
}

/// Known cells of a map.
int known_cells(const SparseMap& map) {
  int known = 0;
  for (const Eigen::Vector3i& brick : map.bricks()) {
    BrickCells cells{};
    map.copy_brick(brick, cells);
    known += static_cast<int>(std::count_if(
        cells.cells.begin(), cells.cells.end(), [](LogOdds cell) { return cell != kUnknown; }));
  }
  return known;
}

TEST_P(ScanIntegrationReference, ASparseMapHoldsNothingElse) {
  Random random(77);
  int total = 0;
  for (int i = 0; i < 3; ++i) {
    const Case one{.name = "short_" + std::to_string(i),
                   .scan = short_scan(random),
                   .T_map_body = testing::pose_in(
                       random, {Eigen::Vector3d(-30, -30, -9), Eigen::Vector3d(30, 30, 9)}),
                   .size = Eigen::Vector3i::Constant(96)};
    SparseMap map({Eigen::Vector3d::Zero(), one.voxel_m});
    ScanIntegrator integrator(config_of(one, GetParam(), kNoLimitUnits));
    (void)integrator.integrate(one.scan, one.T_map_body, map);
    const Eigen::Vector3i drone = map.lattice().cell_of(one.T_map_body.translation());
    const NaiveBox box = box_of(one, Eigen::Vector3d::Zero(), drone - one.size / 2);
    total += expect_agreement(map, naive_increments(one, box, GetParam()), one.name);
    int known_inside = 0;
    for (std::size_t cell = 0; cell < box.cell_count(); ++cell) {
      known_inside += map.at(box.cell(cell)) != kUnknown ? 1 : 0;
    }
    EXPECT_EQ(known_cells(map), known_inside) << one.name;
  }
  EXPECT_GT(total, kLeastSaid);
}

TEST_P(ScanIntegrationReference, TheMapsAgreeExactly) {
  int total = 0;
  for (const Case& one : cases()) {
    DenseMap dense = dense_map(box_of(one, Eigen::Vector3d::Zero(), Eigen::Vector3i::Zero()));
    LocalMap local(one.size, one.voxel_m);
    SparseMap sparse({Eigen::Vector3d::Zero(), one.voxel_m});
    local.follow(one.T_map_body.translation());
    ScanIntegrator integrator(config_of(one, GetParam(), kNoLimitUnits));
    (void)integrator.integrate(one.scan, one.T_map_body, dense);
    (void)integrator.integrate(one.scan, one.T_map_body, local);
    (void)integrator.integrate(one.scan, one.T_map_body, sparse);
    int different = 0;
    int known = 0;
    const auto count = [&](const auto& map) {
      const NaiveBox box = box_of(one, Eigen::Vector3d::Zero(), map.bounds().min);
      for (std::size_t i = 0; i < box.cell_count(); ++i) {
        different += map.at(box.cell(i)) != sparse.at(box.cell(i)) ? 1 : 0;
        known += map.at(box.cell(i)) != kUnknown ? 1 : 0;
      }
    };
    count(dense);
    count(local);
    EXPECT_EQ(different, 0) << one.name;
    total += known;
  }
  EXPECT_GT(total, kLeastSaid);
}

TEST_P(ScanIntegrationReference, SeveralScansWithinTheLimit) {
  constexpr int kLimitUnits = 5000;
  constexpr int kScans = 10;
  Random random(99);
  Case one{.name = "flight", .scan = RangeScan(90)};
  const Eigen::Vector3d far_m = one.voxel_m * one.size.cast<double>();
  const testing::Room room{{0.05 * far_m, 0.95 * far_m}, {0.4 * far_m, 0.5 * far_m}};
  const NaiveBox box = box_of(one, Eigen::Vector3d::Zero(), Eigen::Vector3i::Zero());
  DenseMap map = dense_map(box);
  reference::NaiveScanMap naive(box, kLimitUnits);
  ScanIntegrator integrator(config_of(one, GetParam(), kLimitUnits));
  for (int i = 0; i < kScans; ++i) {
    one.T_map_body = testing::pose_in(random, {0.15 * far_m, 0.35 * far_m});
    one.scan = testing::room_scan(random, 90, room, one.T_map_body, 8.0);
    (void)integrator.integrate(one.scan, one.T_map_body, map);
    naive.add(naive_increments(one, box, GetParam()));
  }
  int wrong = 0;
  int compared = 0;
  int at_limit = 0;
  for (std::size_t i = 0; i < box.cell_count(); ++i) {
    const LogOdds found = map.at(box.cell(i));
    at_limit += std::abs(int{found}) == kLimitUnits ? 1 : 0;
    EXPECT_TRUE(found == kUnknown || std::abs(int{found}) <= kLimitUnits);
    if (!naive.near_border(i)) {
      ++compared;
      const int units = found == kUnknown ? 0 : found;
      wrong += std::abs(units - naive.units(i)) > kScans * kAllowedUnits ? 1 : 0;
    }
  }
  EXPECT_EQ(wrong, 0) << "of " << compared;
  EXPECT_GT(compared, 0.55 * static_cast<double>(box.cell_count()));
  EXPECT_GT(at_limit, 50);
}

INSTANTIATE_TEST_SUITE_P(Methods,
                         ScanIntegrationReference,
                         ::testing::Values(IntegrationMethod::kRays, IntegrationMethod::kSweep),
                         [](const auto& method) {
                           return method.param == IntegrationMethod::kRays ? "Rays" : "Sweep";
                         });

TEST(ScanSweepReference, WithEachInstructionSet) {
  for (const Case& one : cases()) {
    const NaiveBox box = box_of(one, Eigen::Vector3d::Zero(), Eigen::Vector3i::Zero());
    const NaiveIncrements naive = naive_increments(one, box, IntegrationMethod::kSweep);
    for (const std::int64_t target : testing::InstructionSet::all()) {
      const testing::InstructionSet in_use(target);
      DenseMap map = dense_map(box);
      ScanIntegrator integrator(config_of(one, IntegrationMethod::kSweep, kNoLimitUnits));
      (void)integrator.integrate(one.scan, one.T_map_body, map);
      (void)expect_agreement(map, naive, one.name + "_" + testing::InstructionSet::name(target));
    }
  }
}

TEST(ScanSweepReference, WithoutTheTermOfTheCellsSize) {
  int total = 0;
  for (const Case& one : cases()) {
    const NaiveBox box = box_of(one, Eigen::Vector3d::Zero(), Eigen::Vector3i::Zero());
    DenseMap map = dense_map(box);
    IntegrationConfig config = config_of(one, IntegrationMethod::kSweep, kNoLimitUnits);
    config.cell_size_term = false;
    ScanIntegrator integrator(config);
    (void)integrator.integrate(one.scan, one.T_map_body, map);
    total += expect_agreement(
        map, naive_increments(one, box, IntegrationMethod::kSweep, false), one.name);
  }
  EXPECT_GT(total, kLeastSaid);
}

}  // namespace
}  // namespace skyhalo

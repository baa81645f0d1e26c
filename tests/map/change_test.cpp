// What maps do with things that come and go, and with thin ones that stay.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "map/random_scans.hpp"
#include "skyhalo/geometry/lattice_walk.hpp"
#include "skyhalo/geometry/spherical.hpp"
#include "skyhalo/map/cell_map.hpp"
#include "skyhalo/map/map_query.hpp"
#include "skyhalo/map/scan_integrator.hpp"
#include "skyhalo/map/sparse_map.hpp"
#include "support/sanitised.hpp"

namespace skyhalo {
namespace {

using testing::between;
using testing::Random;

/// 1 deg.
constexpr int kRows = 180;

/// Place of a direction in a scan's memory.
std::size_t place_of(const RangeScan& scan, int row, int col) {
  return static_cast<std::size_t>(row) * static_cast<std::size_t>(scan.cols()) +
         static_cast<std::size_t>(col);
}

/// A drone that is held by hand: turned by a few degrees about each axis.
Pose shaken(Random& random, const Eigen::Vector3d& position_m) {
  const auto about = [&](const Eigen::Vector3d& axis) {
    return Eigen::AngleAxisd(between(random, -0.05, 0.05), axis);
  };
  const Eigen::Quaterniond turned = about(Eigen::Vector3d::UnitZ()) *
                                    about(Eigen::Vector3d::UnitY()) *
                                    about(Eigen::Vector3d::UnitX());
  return make_pose(turned.toRotationMatrix(), position_m);
}

/// Says in a scan what the rays within 41 deg of straight ahead meet, free to 10 m beyond that:
/// `range_m(map-frame direction)`. Elsewhere nothing is seen.
template <class Range>
void look(RangeScan& scan, const Pose& T_map_body, Range&& range_m) {
  scan.clear();
  for (int row = 0; row < scan.rows(); ++row) {
    for (int col = 0; col < scan.cols(); ++col) {
      const Eigen::Vector3d u = scan.direction(row, col);
      const double z_m = u.x() > 0.75 ? range_m(Eigen::Vector3d(T_map_body.linear() * u)) : 0.0;
      if (z_m <= 10.0) {
        scan.set_depth(row,
                       col,
                       static_cast<float>(z_m),
                       static_cast<float>(testing::pair_uncertainty_m(z_m)));
      } else {
        scan.set_free(row, col, 10.0F);
      }
    }
  }
}

/// Range (m) to a wall at x = wall_m, infinite for rays that go the other way.
double wall_range_m(double wall_m, const Eigen::Vector3d& from_m, const Eigen::Vector3d& u) {
  return u.x() > 1e-6 ? (wall_m - from_m.x()) / u.x() : std::numeric_limits<double>::infinity();
}

std::vector<Eigen::Vector3i> occupied_cells(const SparseMap& map, const CellBox& box) {
  std::vector<Eigen::Vector3i> cells;
  for_each_known_cell(map, box, [&](const Eigen::Vector3i& cell, LogOdds value) {
    if (value > 0) {
      cells.push_back(cell);
    }
  });
  return cells;
}

int count_occupied(const SparseMap& map, const std::vector<Eigen::Vector3i>& cells) {
  return static_cast<int>(std::count_if(
      cells.begin(), cells.end(), [&](const Eigen::Vector3i& cell) { return map.at(cell) > 0; }));
}

class MapChangeTest : public ::testing::TestWithParam<IntegrationMethod> {
 protected:
  [[nodiscard]] static IntegrationConfig config(int limit_units = 5000, double p_free = 0.3) {
    IntegrationConfig config;
    config.method = GetParam();
    config.limit_units = limit_units;
    config.sensor.p_free = p_free;
    return config;
  }

  /// Frames in which a cell that was never more than the limit is no longer occupied.
  [[nodiscard]] static int frames_to_clear(const IntegrationConfig& config) {
    const double crossed = std::log(config.sensor.p_free / (1.0 - config.sensor.p_free));
    return static_cast<int>(std::ceil(config.limit_units * kLogOddsPerUnit / std::abs(crossed))) +
           1;
  }
};

TEST_P(MapChangeTest, WhatLeavesIsClearedWithinTheFramesOfTheLimit) {
  std::vector<IntegrationConfig> all_settings{config(), config(2000), config(5000, 0.4)};
  all_settings.resize(static_cast<std::size_t>(testing::rounds(3)));
  for (const IntegrationConfig& settings : all_settings) {
    Random random(61);
    const Eigen::AlignedBox3d box_m(Eigen::Vector3d(3.0, -0.8, -0.6),
                                    Eigen::Vector3d(3.4, 0.7, 0.9));
    const Eigen::Vector3d at_m(0.1, 0.05, 0.1);
    SparseMap map({Eigen::Vector3d::Zero(), 0.25});
    ScanIntegrator integrator(settings);
    RangeScan scan(kRows);
    const auto frame = [&](bool is_there) {
      const Pose T_map_body = shaken(random, at_m);
      look(scan, T_map_body, [&](const Eigen::Vector3d& u) {
        const double wall_m = wall_range_m(7.0, at_m, u);
        return is_there ? std::min(wall_m, testing::Room::surface_m(box_m, at_m, u)) : wall_m;
      });
      (void)integrator.integrate(scan, T_map_body, map);
    };
    for (int i = 0; i < 40; ++i) {
      frame(true);
    }
    const std::vector<Eigen::Vector3i> box =
        occupied_cells(map, cells_touching(map.lattice(), {2.0, -2.0, -2.0}, {4.4, 2.0, 2.0}));
    ASSERT_GT(box.size(), 30U);
    const auto at_limit = std::count_if(box.begin(), box.end(), [&](const Eigen::Vector3i& cell) {
      return map.at(cell) == settings.limit_units;
    });
    ASSERT_GT(at_limit, 20);
    const int frames = frames_to_clear(settings);
    for (int i = 0; i < frames; ++i) {
      if (i == frames - 3) {
        EXPECT_GT(count_occupied(map, box), 0) << "it went sooner than the limit allows";
      }
      frame(false);
    }
    EXPECT_EQ(count_occupied(map, box), 0)
        << "of " << box.size() << " cells, after " << frames << " frames";
  }
}

/// A vertical pole that is much thinner than a direction, in front of a wall.
struct Pole {
  Eigen::Vector2d middle_m;
  double bottom_m = -1.2;
  double top_m = 1.2;

  /// In each direction that sees a part of it, the scan has the nearest part's range.
  void put_into(RangeScan& scan, const Pose& T_map_body) const {
    const Pose T_body_map = T_map_body.inverse();
    std::vector<double> nearest_m(scan.z_m().size(), std::numeric_limits<double>::infinity());
    for (double z_m = bottom_m; z_m <= top_m; z_m += 0.005) {
      const SphericalPoint seen =
          to_spherical(T_body_map * Eigen::Vector3d(middle_m.x(), middle_m.y(), z_m));
      const int row = static_cast<int>(seen.theta_rad / scan.step_rad());
      const int col = static_cast<int>((seen.phi_rad + std::numbers::pi) / scan.step_rad());
      double& nearest = nearest_m[place_of(scan, row, col)];
      nearest = std::min(nearest, seen.rho_m - 0.015);
      scan.set_depth(row,
                     col,
                     static_cast<float>(nearest),
                     static_cast<float>(testing::pair_uncertainty_m(nearest)));
    }
  }
};

TEST_P(MapChangeTest, AThinPoleStaysWhileItIsSeen) {
  constexpr int kFrames = testing::rounds(200);
  for (const double voxel_m : {0.25, 0.1}) {
    if (testing::kSanitised && voxel_m == 0.1) {
      continue;  // many times as many cells
    }
    SCOPED_TRACE(voxel_m);
    Random random(62);
    SparseMap map({Eigen::Vector3d::Zero(), voxel_m});
    const Eigen::Vector3i foot = map.lattice().cell_of({4.0 + 1e-6, 1e-6, -1.0 + 1e-6});
    const Pole pole{.middle_m = map.lattice().center_m(foot).head<2>()};
    ScanIntegrator integrator(config());
    RangeScan scan(kRows);
    int missing = 0;
    for (int frame = 0; frame < kFrames; ++frame) {
      const Eigen::Vector3d at_m(0.0, -1.5 + 3.0 * frame / kFrames, 0.03);
      const Pose T_map_body = shaken(random, at_m);
      look(scan, T_map_body, [&](const Eigen::Vector3d& u) { return wall_range_m(8.0, at_m, u); });
      pole.put_into(scan, T_map_body);
      (void)integrator.integrate(scan, T_map_body, map);
      for (Eigen::Vector3i cell = foot; map.lattice().center_m(cell).z() < 1.0; ++cell.z()) {
        missing += map.at(cell) > 0 ? 0 : 1;
      }
    }
    EXPECT_EQ(missing, 0) << "cells of " << kFrames << " frames";
    EXPECT_LT(at_point(map, {4.0, 1.0, 0.0}), -1000) << "it is free beside the pole";
    EXPECT_LT(at_point(map, {4.0, -1.0, 0.0}), -1000);
    EXPECT_GT(at_point(map, {8.0 + 0.3 * voxel_m, 0.5, 0.0}), 1000) << "the wall is behind";
  }
}

/// The cells that hold the ends of a scan's rays, but those that end within 0.1 mm of a face.
std::vector<Eigen::Vector3i> ends_of(const RangeScan& scan,
                                     const Pose& T_map_body,
                                     const VoxelLattice& lattice) {
  std::vector<Eigen::Vector3i> ends;
  for (int row = 0; row < scan.rows(); ++row) {
    for (int col = 0; col < scan.cols(); ++col) {
      const double z_m = scan.z_m()[place_of(scan, row, col)];
      if (!(z_m > 0.0)) {
        continue;
      }
      const Eigen::Vector3d end_m = T_map_body * (z_m * scan.direction(row, col));
      const Eigen::Array3d scaled = (end_m - lattice.origin_m).array() / lattice.voxel_m;
      if (lattice.voxel_m * (scaled - scaled.round()).abs().minCoeff() > 1e-4) {
        ends.push_back(lattice.cell_of(end_m));
      }
    }
  }
  return ends;
}

TEST_P(MapChangeTest, AScansFreeRaysDoNotEraseItsHits) {
  Random random(63);
  std::size_t hits = 0;
  for (int round = 0; round < 10; ++round) {
    const Pose T_map_body =
        testing::pose_in(random, {Eigen::Vector3d(-9, -9, -9), Eigen::Vector3d(9, 9, 9)});
    // Things and free directions without any order: all hits are crossed by other rays.
    const RangeScan scan = testing::noise_scan(random, 36, 5.0);
    SparseMap map({{0.01, 0.02, 0.03}, round % 2 == 0 ? 0.25 : 0.1});
    ScanIntegrator integrator(config());
    const std::vector<Eigen::Vector3i> ends = ends_of(scan, T_map_body, map.lattice());
    hits += ends.size();
    for (int repeat = 0; repeat < 3; ++repeat) {
      const SparseMap before = map;
      (void)integrator.integrate(scan, T_map_body, map);
      int erased = 0;
      for (const Eigen::Vector3i& cell : ends) {
        const int units_before = before.at(cell) == kUnknown ? 0 : before.at(cell);
        erased += map.at(cell) > units_before || map.at(cell) == 5000 ? 0 : 1;
      }
      EXPECT_EQ(erased, 0) << "of " << ends.size() << " hits, round " << round;
    }
  }
  EXPECT_GT(hits, 5000U);
}

TEST_P(MapChangeTest, WhatComesIsThereAtOnce) {
  // A cell that was seen free for long is occupied after as many hits as it takes from the limit.
  SparseMap map({Eigen::Vector3d::Zero(), 0.25});
  ScanIntegrator integrator(config());
  RangeScan scan(kRows);
  const Pose T_map_body = make_pose(Eigen::Matrix3d::Identity(), {0.1, 0.1, 0.1});
  const auto frame = [&](double wall_m) {
    look(scan, T_map_body, [&](const Eigen::Vector3d& u) {
      return wall_range_m(wall_m, T_map_body.translation(), u);
    });
    (void)integrator.integrate(scan, T_map_body, map);
  };
  for (int i = 0; i < 50; ++i) {
    frame(8.0);
  }
  ASSERT_EQ(at_point(map, {2.1, 0.1, 0.1}), -5000);
  // 2 m: uncertain by 0.05 m, so that the peak is 0.5 + 0.375 exp(-0.05).
  const double p = 0.5 + 0.375 * std::exp(-testing::pair_uncertainty_m(2.0));
  const int frames = static_cast<int>(std::ceil(5.0 / (std::log(p / (1.0 - p)) - 0.04)));
  for (int i = 0; i < frames; ++i) {
    frame(2.1);
  }
  EXPECT_GT(at_point(map, {2.1, 0.1, 0.1}), 0) << frames << " frames";
}

INSTANTIATE_TEST_SUITE_P(Methods,
                         MapChangeTest,
                         ::testing::Values(IntegrationMethod::kRays, IntegrationMethod::kSweep),
                         [](const auto& method) {
                           return method.param == IntegrationMethod::kRays ? "Rays" : "Sweep";
                         });

}  // namespace
}  // namespace skyhalo

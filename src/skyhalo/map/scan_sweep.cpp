#include "skyhalo/map/scan_sweep.hpp"

#include <algorithm>
#include <array>

#include "skyhalo/geometry/lattice_walk.hpp"
#include "skyhalo/map/body_reach.hpp"

namespace skyhalo {
namespace {

/// Cubes that are judged as a whole are 16, 4 and 1 bricks along each axis.
constexpr int kCubeRatio = 4;

CellFrame frame_of(const VoxelLattice& lattice,
                   const Pose& T_map_body,
                   const Eigen::Vector3i& first,
                   bool thick) {
  const Eigen::Vector3d from_first_m = T_map_body.translation() - lattice.corner_m(first);
  return {T_map_body.linear().cast<float>(),
          (from_first_m / lattice.voxel_m).cast<float>(),
          static_cast<float>(lattice.voxel_m),
          thick};
}

/// Half the edge of a cube that holds the middles of the cells of one.
float half_edge_m(int edge_cells, double voxel_m) noexcept {
  return static_cast<float>(0.5 * (edge_cells - 1) * voxel_m);
}

}  // namespace

ScanSweep::ScanSweep(bool cell_size_term)
    : computed_(kBatch), says_(kBatch), cell_size_term_(cell_size_term) {}

void ScanSweep::reserve(std::size_t bricks) {
  ends_.reserve(bricks);
  jobs_.reserve(bricks);
}

void ScanSweep::begin(const RangeScan& scan,
                      const IncrementTable& table,
                      const Pose& T_map_body,
                      const VoxelLattice& lattice,
                      const CellBox& bounds) {
  table_ = &table;
  lattice_ = lattice;
  T_map_body_ = T_map_body;
  jobs_.clear();
  const double most_m = kMostReachCells * lattice.voxel_m;
  const Eigen::Vector3i first = lattice.cell_of(
      T_map_body.translation() -
      Eigen::Vector3d::Constant(std::min(scan.farthest_m(), most_m) + lattice.voxel_m));
  const CellFrame frame = frame_of(lattice, T_map_body, first, cell_size_term_);
  patches_.find(scan, table, frame);
  pyramid_.build(patches_, frame);
  offsets_.find(frame);
  const CellBox region = cells_in_reach(lattice, bounds, T_map_body, pyramid_.reach_m());
  if (region.empty()) {
    return;
  }
  bricks_ = bricks_touching(region);
  // A ray's end marks its cell, however small the part of the cell's view is that the ray stands
  // for: thin things stay.
  ends_.begin(bricks_, scan.z_m().size());
  patches_.mark_ends(first, region, ends_);
  find_jobs();
}

/// A place from the body's origin, in the body's frame.
Eigen::Vector3f ScanSweep::seen_from_body(const Eigen::Vector3d& point_m) const noexcept {
  return (T_map_body_.linear().transpose() * (point_m - T_map_body_.translation())).cast<float>();
}

void ScanSweep::find_jobs() {
  constexpr int kEdge = kCubeRatio * kCubeRatio;
  const auto cube_of = [](int brick) { return brick >> 4; };
  static_assert(kEdge == 1 << 4);
  const CellBox cubes{bricks_.min.unaryExpr(cube_of),
                      (bricks_.max.array() - 1).matrix().unaryExpr(cube_of).array() + 1};
  split(cubes, kEdge);
}

/// Judges cubes of bricks, `edge` along each axis, and what is mixed by its parts.
void ScanSweep::split(const CellBox& cubes, int edge) {
  std::array<Eigen::Vector3i, kCubesAtOnce> group;
  std::size_t count = 0;
  for_each_cell(cubes, [&](const Eigen::Vector3i& cube) {
    const CellBox bricks{cube * edge, (cube.array() + 1) * edge};
    if (!overlap(bricks, bricks_).empty()) {
      group[count++] = cube;
    }
    if (count == kCubesAtOnce) {
      judge(group, edge);
      count = 0;
    }
    return true;
  });
  judge(std::span(group).first(count), edge);
}

void ScanSweep::judge(std::span<const Eigen::Vector3i> cubes, int edge) {
  const double side_m = lattice_.voxel_m * (edge * kBrickEdge - 1);
  Cubes balls;  // NOLINT(*-member-init): as many as are counted
  balls.half_edge_m = half_edge_m(edge * kBrickEdge, lattice_.voxel_m);
  for (const Eigen::Vector3i& cube : cubes) {
    const Eigen::Vector3d first_m = lattice_.center_m(first_cell(cube * edge));
    balls.add(seen_from_body(first_m + Eigen::Vector3d::Constant(0.5 * side_m)),
              edge == 1 && ends_.has(cube));
  }
  Verdicts verdicts;  // NOLINT(*-member-init)
  pyramid_.judge(balls, verdicts);
  for (std::size_t i = 0; i < cubes.size(); ++i) {
    const CellBox bricks = overlap({cubes[i] * edge, (cubes[i].array() + 1) * edge}, bricks_);
    if (edge == 1) {
      if (verdicts.verdict[i] != CubeVerdict::kNothing) {
        jobs_.push_back({cubes[i], verdicts.verdict[i] == CubeVerdict::kCrossed});
      }
    } else if (verdicts.verdict[i] == CubeVerdict::kMixed) {
      split({cubes[i] * kCubeRatio, (cubes[i].array() + 1) * kCubeRatio}, edge / kCubeRatio);
    } else if (verdicts.verdict[i] == CubeVerdict::kCrossed) {
      for_each_cell(bricks, [&](const Eigen::Vector3i& brick) {
        jobs_.push_back({brick, true});
        return true;
      });
    }
  }
}

/// Works out what a group of bricks gets.
void ScanSweep::compute(std::size_t begin, std::size_t end) noexcept {
  Cubes balls;  // NOLINT(*-member-init): as many as are counted
  balls.half_edge_m = half_edge_m(kEighthEdge, lattice_.voxel_m);
  std::array<Eigen::Vector3f, kGroup> firsts_m;
  for (std::size_t job = begin; job < end; ++job) {
    if (!jobs_[job].whole) {
      Eigen::Vector3f& first_m = firsts_m[job - begin];
      first_m = seen_from_body(lattice_.center_m(first_cell(jobs_[job].brick)));
      const std::uint32_t marked = ends_.eighths(jobs_[job].brick);
      for (std::size_t eighth = 0; eighth < kEighths; ++eighth) {
        balls.add(first_m + offsets_.eighth_m[eighth] + offsets_.to_middle_m,
                  (marked >> eighth & 1) != 0);
      }
    }
  }
  Verdicts verdicts;  // NOLINT(*-member-init)
  pyramid_.judge(balls, verdicts);
  std::size_t eighth = 0;
  for (std::size_t job = begin; job < end; ++job) {
    says_[job % kBatch] = 1;
    if (!jobs_[job].whole) {
      BrickCells& increments = computed_[job % kBatch];
      const bool swept = sweep_brick({patches_, offsets_, *table_, balls, verdicts},
                                     firsts_m[job - begin],
                                     eighth,
                                     increments);
      eighth += kEighths;
      const bool marked = ends_.merge(jobs_[job].brick, increments);
      says_[job % kBatch] = swept || marked ? 1 : 0;
    }
  }
}

}  // namespace skyhalo

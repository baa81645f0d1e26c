#include "skyhalo/map/scan_integrator.hpp"

#include <algorithm>
#include <type_traits>

#include "skyhalo/base/error.hpp"
#include "skyhalo/base/for_each_index.hpp"
#include "skyhalo/map/body_reach.hpp"
#include "skyhalo/map/integration_cost.hpp"

namespace skyhalo {
namespace {

/// A local map touches at most so many bricks, wherever it begins.
std::size_t most_bricks(const LocalMap& map) {
  const Eigen::Array3i most = (map.bounds().size().array() + 2 * (kBrickEdge - 1)) / kBrickEdge;
  return static_cast<std::size_t>(most.prod());
}

}  // namespace

void check(const IntegrationConfig& config) {
  check(config.sensor);
  if (config.limit_units < 1 || config.limit_units > 32767) {
    throw Error(ErrorKind::kInput, "limit of the log odds: expected 1 to 32767 units");
  }
}

ScanIntegrator::ScanIntegrator(const IntegrationConfig& config)
    : sweep_((check(config), config.cell_size_term)),
      table_(config.sensor, kLogOddsPerUnit),
      config_(config) {}

template <class Map>
IntegrationReport ScanIntegrator::integrate(const RangeScan& scan,
                                            const Pose& T_map_body,
                                            Map& map) {
  IntegrationReport report;
  if (!can_enter(map.lattice(), T_map_body)) {
    return report;
  }
  if constexpr (std::is_same_v<Map, LocalMap>) {
    // So that no later scan of the same way allocates, wherever the map and its bricks are.
    sweep_.reserve(most_bricks(map));
    rays_.reserve(most_bricks(map));
  }
  const ScanSize size = size_of(scan);
  report.things = size.things;
  report.free = size.free;
  const CellBox region = cells_in_reach(map.lattice(), map.bounds(), T_map_body, size.longest_m);
  report.used = config_.method == IntegrationMethod::kAuto
                    ? cheaper_method(size, region, map.lattice().voxel_m)
                    : config_.method;
  map.begin_change();
  if (size.things + size.free == 0) {
    return report;
  }
  if (report.used == IntegrationMethod::kRays) {
    rays_.walk(scan, table_, T_map_body, map.lattice(), map.bounds());
    apply_marks(map);
    report.bricks = static_cast<std::int64_t>(rays_.marks().bricks().size());
  } else {
    sweep_.begin(scan, table_, T_map_body, map.lattice(), map.bounds());
    run_jobs(map);
    report.bricks = static_cast<std::int64_t>(sweep_.jobs().size());
  }
  return report;
}

/// By batches: what each brick gets is worked out side by side, room is made one by one, and the
/// bricks change side by side again.
template <class Map>
void ScanIntegrator::run_jobs(Map& map) {
  constexpr std::size_t kBatch = ScanSweep::kBatch;
  constexpr std::size_t kGroup = ScanSweep::kGroup;
  const std::span<const SweepJob> jobs = sweep_.jobs();
  const auto for_groups = [](std::size_t begin, std::size_t end, const auto& work) {
    for_each_index((end - begin + kGroup - 1) / kGroup, [&](std::size_t group) {
      const std::size_t from = begin + group * kGroup;
      work(from, std::min(from + kGroup, end));
    });
  };
  for (std::size_t begin = 0; begin < jobs.size(); begin += kBatch) {
    const std::size_t end = std::min(begin + kBatch, jobs.size());
    for_groups(begin, end, [&](std::size_t from, std::size_t to) { sweep_.compute(from, to); });
    for (std::size_t job = begin; job < end; ++job) {
      if (sweep_.says(job)) {
        map.prepare(jobs[job].brick, jobs[job].whole);
      }
    }
    for_groups(begin, end, [&](std::size_t from, std::size_t to) {
      for (std::size_t job = from; job < to; ++job) {
        if (jobs[job].whole) {
          map.change_whole(
              jobs[job].brick, static_cast<Increment>(table_.crossed()), config_.limit_units);
        } else if (sweep_.says(job)) {
          map.change(jobs[job].brick, sweep_.increments(job), config_.limit_units);
        }
      }
    });
  }
}

template <class Map>
void ScanIntegrator::apply_marks(Map& map) {
  const BrickMarks& marks = rays_.marks();
  for (const Eigen::Vector3i& brick : marks.bricks()) {
    map.prepare(brick, false);
  }
  for_each_index(marks.bricks().size(), [&](std::size_t i) {
    const Eigen::Vector3i& brick = marks.bricks()[i];
    map.change(brick, *marks.find(brick), config_.limit_units);
  });
}

template IntegrationReport ScanIntegrator::integrate(const RangeScan&, const Pose&, DenseMap&);
template IntegrationReport ScanIntegrator::integrate(const RangeScan&, const Pose&, LocalMap&);
template IntegrationReport ScanIntegrator::integrate(const RangeScan&, const Pose&, SparseMap&);

}  // namespace skyhalo

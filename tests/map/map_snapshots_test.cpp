#include "skyhalo/map/map_snapshots.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <cstdint>
#include <thread>
#include <type_traits>
#include <utility>
#include <vector>

#include "map/random_scans.hpp"
#include "skyhalo/geometry/lattice_walk.hpp"
#include "skyhalo/map/cell_map.hpp"
#include "skyhalo/map/dense_map.hpp"
#include "skyhalo/map/local_map.hpp"
#include "skyhalo/map/scan_integrator.hpp"
#include "skyhalo/map/sparse_map.hpp"

namespace skyhalo {
namespace {

constexpr int kFrames = 150;
constexpr int kMostFrames = 20000;
/// States that the reader sees, at the least.
constexpr int kStates = 20;

/// A number that depends on every known cell of a map and its place (FNV-1a, Fowler et al. 1991).
template <class Map>
std::uint64_t checksum(const Map& map) {
  std::uint64_t sum = 14695981039346656037U;
  const auto take = [&sum](int value) {
    sum = (sum ^ static_cast<std::uint32_t>(value)) * 1099511628211U;
  };
  for_each_known_cell(map, map.bounds(), [&](const Eigen::Vector3i& cell, LogOdds value) {
    take(cell.x());
    take(cell.y());
    take(cell.z());
    take(value);
  });
  return sum;
}

/// Where the drone is at a frame: it winds along.
Pose pose_at(int frame) {
  const double at = 0.05 * frame;
  return make_pose(Eigen::AngleAxisd(at, Eigen::Vector3d(0.3, 0.1, 0.9).normalized()).matrix(),
                   {2.0 * std::sin(at), at, 0.5 * std::cos(2.0 * at)});
}

/// What happens to a map in a frame: the drone moves on, cells fade now and then, a scan comes in.
template <class Map>
void fly(Map& map, int frame, ScanIntegrator& integrator, testing::Random& random) {
  if constexpr (std::is_same_v<Map, LocalMap>) {
    map.follow(pose_at(frame).translation());
  }
  if (frame % 16 == 15) {
    map.begin_change();
    map.decay({.keep_occupied = 50000, .keep_free = 30000, .unknown_below = 400});
  }
  (void)integrator.integrate(testing::noise_scan(random, 18, 3.0), pose_at(frame), map);
}

/// The states that the writer has published, by tick.
class Published {
 public:
  /// Before the state itself is published.
  void add(std::uint64_t tick, std::uint64_t sum) {
    const std::size_t count = count_.load(std::memory_order_relaxed);
    states_[count] = {tick, sum};
    count_.store(count + 1, std::memory_order_release);
  }

  [[nodiscard]] bool has(std::uint64_t tick, std::uint64_t sum) const {
    const std::size_t count = count_.load(std::memory_order_acquire);
    for (std::size_t i = 0; i < count; ++i) {
      if (states_[i] == std::pair(tick, sum)) {
        return true;
      }
    }
    return false;
  }

 private:
  std::vector<std::pair<std::uint64_t, std::uint64_t>> states_{kMostFrames + 1};
  std::atomic<std::size_t> count_ = 0;
};

/// Runs a check with an empty map of each kind.
template <class Check>
void with_each_map(Check&& check) {
  {
    SCOPED_TRACE("dense map");
    check(DenseMap(VoxelGrid{{-3.0, -1.0, -2.0}, 0.25, {24, 40, 16}}));
  }
  {
    SCOPED_TRACE("local map");
    check(LocalMap({24, 21, 17}, 0.25));
  }
  {
    SCOPED_TRACE("sparse map");
    check(SparseMap({{0.1, 0.2, 0.3}, 0.25}));
  }
}

TEST(MapSnapshotsTest, TheFirstCopyIsTheMapAsItWas) {
  with_each_map([](auto map) {
    using Map = decltype(map);
    map.set({1, 2, 3}, 77);
    MapSnapshots<Map> snapshots(map);
    map.set({1, 2, 3}, 88);
    EXPECT_EQ(snapshots.latest().at({1, 2, 3}), 77);
  });
}

TEST(MapSnapshotsTest, TheNewestOfSeveralCounts) {
  with_each_map([](auto map) {
    using Map = decltype(map);
    MapSnapshots<Map> snapshots(map);
    for (int published = 0; published < 5; ++published) {
      for (int i = 0; i <= published; ++i) {
        map.set({1, 2, 3}, static_cast<LogOdds>(100 * published + i));
        snapshots.publish(map);
      }
      EXPECT_EQ(snapshots.latest().at({1, 2, 3}), 101 * published);
      EXPECT_EQ(snapshots.latest().at({1, 2, 3}), 101 * published) << "nothing new";
    }
  });
}

TEST(MapSnapshotsTest, ACopyStaysUntilTheNextCall) {
  with_each_map([](auto map) {
    using Map = decltype(map);
    MapSnapshots<Map> snapshots(map);
    map.set({1, 2, 3}, 5);
    snapshots.publish(map);
    const Map& copy = snapshots.latest();
    for (int i = 0; i < 10; ++i) {
      map.set({1, 2, 3}, static_cast<LogOdds>(100 + i));
      snapshots.publish(map);
      EXPECT_EQ(copy.at({1, 2, 3}), 5);
    }
    EXPECT_EQ(snapshots.latest().at({1, 2, 3}), 109);
  });
}

TEST(MapSnapshotsTest, EachCopyIsOnePublishedStateAsAWhole) {
  with_each_map([](auto map) {
    using Map = decltype(map);
    MapSnapshots<Map> snapshots(map);
    Published published;
    published.add(map.tick(), checksum(map));
    std::atomic<bool> done = false;
    std::atomic<int> states = 0;
    std::thread writer([&] {
      ScanIntegrator integrator(IntegrationConfig{});
      testing::Random random(7);
      for (int frame = 0; frame < kFrames || (states < kStates && frame < kMostFrames); ++frame) {
        fly(map, frame, integrator, random);
        published.add(map.tick(), checksum(map));
        snapshots.publish(map);
      }
      done = true;
    });
    int wrong = 0;
    std::uint64_t last_tick = 0;
    bool last_round = false;
    while (!last_round) {
      last_round = done;
      const Map& copy = snapshots.latest();
      wrong += published.has(copy.tick(), checksum(copy)) && copy.tick() >= last_tick ? 0 : 1;
      states += copy.tick() != last_tick ? 1 : 0;
      last_tick = copy.tick();
    }
    writer.join();
    EXPECT_EQ(wrong, 0);
    EXPECT_GE(states, kStates) << "the reader saw too few states to tell";
    EXPECT_EQ(last_tick, map.tick());
    EXPECT_EQ(checksum(snapshots.latest()), checksum(map));
  });
}

}  // namespace
}  // namespace skyhalo

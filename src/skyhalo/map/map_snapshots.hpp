#pragma once

#include <array>
#include <atomic>

namespace skyhalo {

/// Hands copies of a map from the thread that changes it to one other thread that asks it, without
/// either waiting for the other: three copies, of which the writer has one, the reader one, and the
/// third is the newest that is finished. Bringing a copy up to date takes only what has changed.
template <class Map>
class MapSnapshots {
 public:
  /// Takes three times the map's memory.
  explicit MapSnapshots(const Map& map) : copies_{map, map, map} {}

  MapSnapshots(const MapSnapshots&) = delete;
  MapSnapshots(MapSnapshots&&) = delete;
  MapSnapshots& operator=(const MapSnapshots&) = delete;
  MapSnapshots& operator=(MapSnapshots&&) = delete;
  ~MapSnapshots() = default;

  /// The writer: makes the map as it is now the newest copy. It is the map that the copies are of.
  void publish(const Map& map) {
    copies_[writers_].catch_up(map);
    writers_ = newest_.exchange(writers_ | kFresh, std::memory_order_acq_rel) & ~kFresh;
  }

  /// The reader: the newest copy that was published, or the first one. It stays as it is until the
  /// next call.
  [[nodiscard]] const Map& latest() noexcept {
    if ((newest_.load(std::memory_order_relaxed) & kFresh) != 0U) {
      readers_ = newest_.exchange(readers_, std::memory_order_acq_rel) & ~kFresh;
    }
    return copies_[readers_];
  }

 private:
  static constexpr unsigned kFresh = 4;

  std::array<Map, 3> copies_;
  unsigned writers_ = 0;
  unsigned readers_ = 1;
  std::atomic<unsigned> newest_ = 2;
};

}  // namespace skyhalo

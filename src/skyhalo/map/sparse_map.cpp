#include "skyhalo/map/sparse_map.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "skyhalo/map/update_cells.hpp"

namespace skyhalo {
namespace {

constexpr std::size_t kFirstSlots = 1024;

/// Mixes the bits of a brick's place (the finaliser of SplitMix64, Steele et al. 2014).
std::uint64_t mixed(const Eigen::Vector3i& brick) noexcept {
  const auto part = [](int value) {
    return static_cast<std::uint64_t>(static_cast<std::uint32_t>(value)) & 0x1FFFFFU;
  };
  std::uint64_t h = part(brick.x()) << 42U | part(brick.y()) << 21U | part(brick.z());
  h = (h ^ (h >> 30U)) * 0xBF58476D1CE4E5B9U;
  h = (h ^ (h >> 27U)) * 0x94D049BB133111EBU;
  return h ^ (h >> 31U);
}

/// A brick's cells lie in one piece.
LogOddsBlock block_of(BrickCells& cells) noexcept {
  return {.cells = cells.cells.data()};
}

bool all_equal(const BrickCells& cells) noexcept {
  return std::all_of(cells.cells.begin(), cells.cells.end(), [&](LogOdds cell) {
    return cell == cells.cells.front();
  });
}

}  // namespace

SparseMap::SparseMap(const VoxelLattice& lattice)
    : lattice_(lattice), slots_(kFirstSlots, kEmpty) {}

SparseMap::SparseMap(const SparseMap& other)
    : lattice_(other.lattice_),
      slots_(other.slots_),
      bricks_(other.bricks_),
      unused_cells_(other.unused_cells_),
      tick_(other.tick_),
      forgot_at_(other.forgot_at_) {
  pages_.reserve(other.pages_.size());
  unused_cells_.reserve(other.pages_.size() * kPageBricks);
  for (const Page& page : other.pages_) {
    unused_cells_.reserve((pages_.size() + 1) *
                          kPageBricks);  // so that giving back never allocates
    pages_.push_back(std::make_unique<std::array<BrickCells, kPageBricks>>(*page));
  }
}

SparseMap& SparseMap::operator=(const SparseMap& other) {
  if (this != &other) {
    *this = SparseMap(other);
  }
  return *this;
}

CellBox SparseMap::known_bounds() const noexcept {
  CellBox box;
  for (const Brick& brick : bricks_) {
    const Eigen::Vector3i first = first_cell(brick.place);
    const Eigen::Vector3i end = first + Eigen::Vector3i::Constant(kBrickEdge);
    const bool is_first = &brick == &bricks_.front();
    box.min = is_first ? first : box.min.cwiseMin(first);
    box.max = is_first ? end : box.max.cwiseMax(end);
  }
  return box;
}

LogOdds SparseMap::at(const Eigen::Vector3i& cell) const noexcept {
  const Brick* brick = find(brick_of(cell));
  if (brick == nullptr) {
    return kUnknown;
  }
  return brick->cells < 0 ? brick->uniform : cells(brick->cells).cells[place_in_brick(cell)];
}

void SparseMap::set(const Eigen::Vector3i& cell, LogOdds value) {
  Brick& brick = obtain(brick_of(cell));
  give_cells(brick);
  cells(brick.cells).cells[place_in_brick(cell)] = value;
  brick.changed_at = ++tick_;
}

std::vector<Eigen::Vector3i> SparseMap::bricks() const {
  std::vector<Eigen::Vector3i> places;
  places.reserve(bricks_.size());
  for (const Brick& brick : bricks_) {
    places.push_back(brick.place);
  }
  std::sort(places.begin(), places.end(), [](const auto& a, const auto& b) {
    return std::lexicographical_compare(a.data(), a.data() + 3, b.data(), b.data() + 3);
  });
  return places;
}

bool SparseMap::holds_brick(const Eigen::Vector3i& brick) const noexcept {
  return find(brick) != nullptr;
}

std::optional<LogOdds> SparseMap::uniform(const Eigen::Vector3i& brick) const noexcept {
  const Brick* found = find(brick);
  if (found == nullptr) {
    return kUnknown;
  }
  return found->cells < 0 ? std::optional(found->uniform) : std::nullopt;
}

void SparseMap::copy_brick(const Eigen::Vector3i& brick, BrickCells& to) const noexcept {
  const Brick* found = find(brick);
  if (found != nullptr && found->cells >= 0) {
    to = cells(found->cells);
  } else {
    to.cells.fill(found == nullptr ? kUnknown : found->uniform);
  }
}

void SparseMap::set_brick(const Eigen::Vector3i& brick, const BrickCells& from) {
  if (all_equal(from)) {
    set_uniform(brick, from.cells.front());
    return;
  }
  Brick& target = obtain(brick);
  give_cells(target);
  cells(target.cells) = from;
  target.changed_at = ++tick_;
}

void SparseMap::set_uniform(const Eigen::Vector3i& brick, LogOdds value) {
  if (value == kUnknown) {
    erase_brick(brick);
    return;
  }
  Brick& target = obtain(brick);
  take_cells(target);
  target.uniform = value;
  target.changed_at = ++tick_;
}

void SparseMap::erase_brick(const Eigen::Vector3i& brick) noexcept {
  const std::size_t slot = slot_of(brick);
  if (slots_[slot] != kEmpty) {
    remove(slot);
  }
}

void SparseMap::clear() noexcept {
  std::fill(slots_.begin(), slots_.end(), kEmpty);
  bricks_.clear();
  pages_.clear();
  unused_cells_.clear();
  forgot_at_ = ++tick_;
}

void SparseMap::catch_up(const SparseMap& other) {
  if (other.forgot_at_ > tick_ || forgot_at_ > other.tick_) {
    *this = other;
    return;
  }
  const std::uint64_t since = tick_;
  for (const Brick& brick : other.bricks_) {
    if (brick.changed_at > since || find(brick.place) == nullptr) {
      Brick& target = obtain(brick.place);
      if (brick.cells >= 0) {
        give_cells(target);
        cells(target.cells) = other.cells(brick.cells);
      } else {
        take_cells(target);
      }
      target.uniform = brick.uniform;
      target.changed_at = brick.changed_at;
    }
  }
  tick_ = other.tick_;
}

std::size_t SparseMap::held_bytes() const noexcept {
  return held_bytes(bricks_.size(), pages_.size() * kPageBricks - unused_cells_.size());
}

std::size_t SparseMap::held_bytes(std::size_t bricks, std::size_t mixed) noexcept {
  return bricks * (sizeof(Brick) + 2 * sizeof(slots_[0])) + mixed * sizeof(BrickCells);
}

std::size_t SparseMap::memory_bytes() const noexcept {
  return slots_.capacity() * sizeof(slots_[0]) + bricks_.capacity() * sizeof(Brick) +
         pages_.size() * kPageBricks * sizeof(BrickCells) +
         unused_cells_.capacity() * sizeof(unused_cells_[0]);
}

void SparseMap::prepare(const Eigen::Vector3i& brick, bool whole) {
  Brick& target = obtain(brick);
  if (!whole) {
    give_cells(target);
  }
}

void SparseMap::change(const Eigen::Vector3i& brick,
                       const BrickCells& increments,
                       int limit) noexcept {
  Brick* target = find(brick);
  if (target != nullptr && target->cells >= 0 &&
      add_increments(block_of(cells(target->cells)), increments, limit)) {
    target->changed_at = tick_;
  }
}

void SparseMap::change_whole(const Eigen::Vector3i& brick,
                             Increment increment,
                             int limit) noexcept {
  Brick* target = find(brick);
  if (target == nullptr) {
    return;
  }
  bool changed = false;
  if (target->cells >= 0) {
    changed = add_increment(block_of(cells(target->cells)), increment, limit);
  } else if (increment != 0) {
    const LogOdds before =
        std::exchange(target->uniform, updated(target->uniform, increment, limit));
    changed = before != target->uniform;
  }
  target->changed_at = changed ? tick_ : target->changed_at;
}

void SparseMap::decay(const DecayStep& step) {
  begin_change();
  // From the last one on: removing a brick puts the last one in its place.
  for (std::size_t i = bricks_.size(); i-- > 0;) {
    Brick& brick = bricks_[i];
    bool changed = false;
    if (brick.cells >= 0) {
      changed = skyhalo::decay(cells(brick.cells).cells, step);
      if (all_equal(cells(brick.cells))) {
        brick.uniform = cells(brick.cells).cells.front();
        take_cells(brick);
      }
    } else {
      changed = decayed(brick.uniform, step) != brick.uniform;
      brick.uniform = decayed(brick.uniform, step);
    }
    brick.changed_at = changed ? tick_ : brick.changed_at;
    if (brick.cells < 0 && brick.uniform == kUnknown) {
      remove(slot_of(brick.place));
    }
  }
}

std::uint64_t SparseMap::changed_at(const Eigen::Vector3i& brick) const noexcept {
  const Brick* found = find(brick);
  return found == nullptr ? 0 : found->changed_at;
}

/// The slot of a brick, or the empty one where it would go.
std::size_t SparseMap::slot_of(const Eigen::Vector3i& brick) const noexcept {
  const std::size_t mask = slots_.size() - 1;
  std::size_t slot = static_cast<std::size_t>(mixed(brick)) & mask;
  while (slots_[slot] != kEmpty && bricks_[static_cast<std::size_t>(slots_[slot])].place != brick) {
    slot = (slot + 1) & mask;
  }
  return slot;
}

const SparseMap::Brick* SparseMap::find(const Eigen::Vector3i& brick) const noexcept {
  const std::int32_t index = slots_[slot_of(brick)];
  return index == kEmpty ? nullptr : &bricks_[static_cast<std::size_t>(index)];
}

SparseMap::Brick* SparseMap::find(const Eigen::Vector3i& brick) noexcept {
  const std::int32_t index = slots_[slot_of(brick)];
  return index == kEmpty ? nullptr : &bricks_[static_cast<std::size_t>(index)];
}

SparseMap::Brick& SparseMap::obtain(const Eigen::Vector3i& brick) {
  std::size_t slot = slot_of(brick);
  if (slots_[slot] == kEmpty) {
    if (2 * (bricks_.size() + 1) > slots_.size()) {
      grow();
      slot = slot_of(brick);
    }
    bricks_.push_back({.place = brick, .changed_at = tick_});
    slots_[slot] = static_cast<std::int32_t>(bricks_.size() - 1);
  }
  return bricks_[static_cast<std::size_t>(slots_[slot])];
}

void SparseMap::give_cells(Brick& brick) {
  if (brick.cells >= 0) {
    return;
  }
  if (unused_cells_.empty()) {
    unused_cells_.reserve((pages_.size() + 1) * kPageBricks);  // giving back never allocates
    pages_.push_back(std::make_unique<std::array<BrickCells, kPageBricks>>());
    const std::size_t first = (pages_.size() - 1) * kPageBricks;
    for (std::size_t i = kPageBricks; i-- > 0;) {
      unused_cells_.push_back(static_cast<std::int32_t>(first + i));
    }
  }
  brick.cells = unused_cells_.back();
  unused_cells_.pop_back();
  cells(brick.cells).cells.fill(brick.uniform);
}

void SparseMap::take_cells(Brick& brick) noexcept {
  if (brick.cells >= 0) {
    unused_cells_.push_back(brick.cells);  // within its capacity: the index has been there before
    brick.cells = -1;
  }
}

/// Empties a slot, and moves up what went past it (Knuth, volume 3, algorithm 6.4 R). The last
/// brick takes the place of the one that goes.
void SparseMap::remove(std::size_t slot) noexcept {
  const auto index = static_cast<std::size_t>(slots_[slot]);
  take_cells(bricks_[index]);
  const std::size_t last_slot = slot_of(bricks_.back().place);
  slots_[last_slot] = static_cast<std::int32_t>(index);
  bricks_[index] = bricks_.back();
  bricks_.pop_back();
  const std::size_t mask = slots_.size() - 1;
  std::size_t hole = slot;
  for (std::size_t next = (hole + 1) & mask; slots_[next] != kEmpty; next = (next + 1) & mask) {
    const std::size_t home =
        static_cast<std::size_t>(mixed(bricks_[static_cast<std::size_t>(slots_[next])].place)) &
        mask;
    if (((next - home) & mask) >= ((next - hole) & mask)) {
      slots_[hole] = slots_[next];
      hole = next;
    }
  }
  slots_[hole] = kEmpty;
  forgot_at_ = ++tick_;
}

void SparseMap::grow() {
  slots_.assign(2 * slots_.size(), kEmpty);
  for (std::size_t i = 0; i < bricks_.size(); ++i) {
    slots_[slot_of(bricks_[i].place)] = static_cast<std::int32_t>(i);
  }
}

BrickCells& SparseMap::cells(std::int32_t index) noexcept {
  const auto at = static_cast<std::size_t>(index);
  return (*pages_[at / kPageBricks])[at % kPageBricks];
}

const BrickCells& SparseMap::cells(std::int32_t index) const noexcept {
  const auto at = static_cast<std::size_t>(index);
  return (*pages_[at / kPageBricks])[at % kPageBricks];
}

}  // namespace skyhalo

#include "skyhalo/map/cell_window.hpp"

#include <algorithm>
#include <array>

#include "skyhalo/geometry/lattice_walk.hpp"
#include "skyhalo/map/update_cells.hpp"

namespace skyhalo {
namespace {

/// The largest multiple of `room` that is not above `first`.
int ring_start(int first, int room) noexcept {
  const int rest = first % room;
  return first - (rest < 0 ? rest + room : rest);
}

Eigen::Vector3i ring_starts(const Eigen::Vector3i& first, const Eigen::Vector3i& room) noexcept {
  return first.binaryExpr(room, [](int from, int length) { return ring_start(from, length); });
}

/// A brick has at most two pieces in each of its rows.
using BrickRows = std::array<LogOddsRow, std::size_t{2} * kBrickEdge * kBrickEdge>;

}  // namespace

CellWindow::CellWindow(const VoxelLattice& lattice,
                       const CellBox& bounds,
                       const Eigen::Vector3i& room)
    : lattice_(lattice),
      bounds_(bounds),
      room_(room),
      ring_start_(ring_starts(bounds.min, room)),
      // A box of n cells that begins anywhere touches this many bricks at most.
      brick_room_((room.array() + 2 * (kBrickEdge - 1)) / kBrickEdge),
      cells_(static_cast<std::size_t>(room.cast<std::int64_t>().prod()), kUnknown),
      changed_at_(static_cast<std::size_t>(brick_room_.cast<std::int64_t>().prod()), 0) {}

/// Where a cell is along one axis of the ring.
std::size_t CellWindow::wrapped(int cell, int axis) const noexcept {
  const int place = cell - ring_start_[axis];
  return static_cast<std::size_t>(place < room_[axis] ? place : place - room_[axis]);
}

std::size_t CellWindow::place_of(const Eigen::Vector3i& cell) const noexcept {
  const auto rows = static_cast<std::size_t>(room_.y());
  const auto columns = static_cast<std::size_t>(room_.z());
  return (wrapped(cell.x(), 0) * rows + wrapped(cell.y(), 1)) * columns + wrapped(cell.z(), 2);
}

std::size_t CellWindow::stamp_of(const Eigen::Vector3i& brick) const noexcept {
  using Place = Eigen::Matrix<std::size_t, 3, 1>;
  const Place place = (brick - ring_starts(brick, brick_room_)).cast<std::size_t>();
  const Place room = brick_room_.cast<std::size_t>();
  return (place.x() * room.y() + place.y()) * room.z() + place.z();
}

template <class Visit>
void CellWindow::for_each_row(const Eigen::Vector3i& brick, Visit&& visit) const noexcept {
  const Eigen::Vector3i first = first_cell(brick);
  const CellBox inside = overlap(bounds_, {first, first + Eigen::Vector3i::Constant(kBrickEdge)});
  if (inside.empty()) {
    return;
  }
  // Where the ring of z begins anew, a row is in two pieces.
  const int seam = ring_start_.z() + room_.z();
  const int middle = std::clamp(seam, inside.min.z(), inside.max.z());
  const auto columns = static_cast<std::size_t>(room_.z());
  const auto slices = static_cast<std::size_t>(room_.y()) * columns;
  for (int x = inside.min.x(); x < inside.max.x(); ++x) {
    for (int y = inside.min.y(); y < inside.max.y(); ++y) {
      const std::size_t row = wrapped(x, 0) * slices + wrapped(y, 1) * columns;
      const std::size_t place = place_in_brick({x, y, 0});
      const auto piece = [&](int from, int to) {
        if (from < to) {
          visit(row + wrapped(from, 2),
                static_cast<int>(place) + (from & (kBrickEdge - 1)),
                to - from);
        }
      };
      piece(inside.min.z(), middle);
      piece(middle, inside.max.z());
    }
  }
}

void CellWindow::set(const Eigen::Vector3i& cell, LogOdds value) noexcept {
  cells_[place_of(cell)] = value;
  changed_at_[stamp_of(brick_of(cell))] = ++tick_;
}

void CellWindow::copy_brick(const Eigen::Vector3i& brick, BrickCells& cells) const noexcept {
  cells.cells.fill(kUnknown);
  for_each_row(brick, [&](std::size_t from, int place, int count) {
    std::copy_n(
        cells_.begin() + static_cast<std::ptrdiff_t>(from), count, cells.cells.begin() + place);
  });
}

void CellWindow::catch_up(const CellWindow& other) noexcept {
  const std::uint64_t since = tick_;
  bounds_ = other.bounds_;
  ring_start_ = other.ring_start_;
  tick_ = other.tick_;
  for_each_cell(bricks_touching(bounds_), [&](const Eigen::Vector3i& brick) {
    const std::size_t stamp = stamp_of(brick);
    if (other.changed_at_[stamp] > since) {
      for_each_row(brick, [&](std::size_t from, int /*place*/, int count) {
        const auto first = static_cast<std::ptrdiff_t>(from);
        std::copy_n(other.cells_.begin() + first, count, cells_.begin() + first);
      });
    }
    changed_at_[stamp] = other.changed_at_[stamp];
    return true;
  });
}

/// A brick's cells when they all lie within the bounds and no ring begins anew between them; none
/// otherwise.
std::optional<LogOddsBlock> CellWindow::block_of(const Eigen::Vector3i& brick) noexcept {
  const Eigen::Vector3i first = first_cell(brick);
  const Eigen::Vector3i last = first.array() + (kBrickEdge - 1);
  const Eigen::Vector3i seam = ring_start_ + room_;
  const bool inside =
      (first.array() >= bounds_.min.array()).all() && (last.array() < bounds_.max.array()).all();
  const bool whole = ((last.array() < seam.array()) || (first.array() >= seam.array())).all();
  if (!inside || !whole) {
    return std::nullopt;
  }
  const auto columns = static_cast<std::ptrdiff_t>(room_.z());
  return LogOddsBlock{cells_.data() + place_of(first), room_.y() * columns, columns};
}

/// `add` what a scan says of a brick, to a block of its cells or to rows.
template <class Add>
void CellWindow::change_cells(const Eigen::Vector3i& brick, const Add& add) noexcept {
  bool changed = false;
  if (const std::optional<LogOddsBlock> block = block_of(brick)) {
    changed = add(*block);
  } else {
    BrickRows rows;
    std::size_t count = 0;
    for_each_row(brick, [&](std::size_t from, int place, int length) {
      rows[count++] = {cells_.data() + from, place, length};
    });
    changed = add(std::span<const LogOddsRow>(rows).first(count));
  }
  if (changed) {
    changed_at_[stamp_of(brick)] = tick_;
  }
}

void CellWindow::change(const Eigen::Vector3i& brick,
                        const BrickCells& increments,
                        int limit) noexcept {
  change_cells(brick, [&](const auto& cells) { return add_increments(cells, increments, limit); });
}

void CellWindow::change_whole(const Eigen::Vector3i& brick,
                              Increment increment,
                              int limit) noexcept {
  change_cells(brick, [&](const auto& cells) { return add_increment(cells, increment, limit); });
}

void CellWindow::decay(const DecayStep& step) noexcept {
  begin_change();
  for_each_cell(bricks_touching(bounds_), [&](const Eigen::Vector3i& brick) {
    bool changed = false;
    for_each_row(brick, [&](std::size_t from, int /*place*/, int count) {
      const std::span<LogOdds> row =
          std::span(cells_).subspan(from, static_cast<std::size_t>(count));
      changed = skyhalo::decay(row, step) || changed;
    });
    if (changed) {
      changed_at_[stamp_of(brick)] = tick_;
    }
    return true;
  });
}

std::uint64_t CellWindow::changed_at(const Eigen::Vector3i& brick) const noexcept {
  const Eigen::Vector3i first = first_cell(brick);
  const bool inside =
      !overlap(bounds_, {first, first + Eigen::Vector3i::Constant(kBrickEdge)}).empty();
  return inside ? changed_at_[stamp_of(brick)] : 0;
}

void CellWindow::forget(const CellBox& cells) noexcept {
  for_each_cell(cells, [this](const Eigen::Vector3i& cell) {
    cells_[place_of(cell)] = kUnknown;
    return true;
  });
}

void CellWindow::mark(const CellBox& bricks) noexcept {
  for_each_cell(bricks, [this](const Eigen::Vector3i& brick) {
    changed_at_[stamp_of(brick)] = tick_;
    return true;
  });
}

void CellWindow::move_to(const CellBox& bounds) noexcept {
  if (bounds == bounds_) {
    return;
  }
  begin_change();
  const CellBox before = bounds_;
  bounds_ = bounds;
  ring_start_ = ring_starts(bounds.min, room_);
  for_each_piece_without(bounds, before, [this](const CellBox& entering) {
    forget(entering);
    mark(bricks_touching(entering));
  });
  // Bricks of which a part has left.
  for_each_piece_without(before, bounds, [this](const CellBox& leaving) {
    mark(overlap(bricks_touching(leaving), bricks_touching(bounds_)));
  });
}

}  // namespace skyhalo

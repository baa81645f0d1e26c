#include "skyhalo/evaluation/tolerant_score.hpp"

#include <algorithm>
#include <limits>
#include <vector>

namespace skyhalo {
namespace {

/// Whether a cell or one of its 26 neighbours within the grid is marked.
bool is_near(const VoxelGrid& grid, std::span<const std::uint8_t> marked, std::int64_t offset) {
  const Eigen::Vector3i cell = grid.cell_at(offset);
  const Eigen::Vector3i low = (cell.array() - 1).max(0);
  const Eigen::Vector3i high = (cell.array() + 1).min(grid.size.array() - 1);
  for (int x = low.x(); x <= high.x(); ++x) {
    for (int y = low.y(); y <= high.y(); ++y) {
      for (int z = low.z(); z <= high.z(); ++z) {
        if (marked[static_cast<std::size_t>(grid.offset_of({x, y, z}))] != 0) {
          return true;
        }
      }
    }
  }
  return false;
}

double ratio(std::int64_t part, std::int64_t whole) noexcept {
  return whole > 0 ? static_cast<double>(part) / static_cast<double>(whole)
                   : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

double TolerantScore::precision() const noexcept {
  return ratio(claimed_right, claimed);
}

double TolerantScore::recall() const noexcept {
  return ratio(exact_found, exact);
}

TolerantScore tolerant_score(const MapAgainstExact& cells, double occupied_probability) {
  std::vector<std::uint8_t> occupied(cells.map.size());
  std::transform(cells.map.begin(), cells.map.end(), occupied.begin(), [&](LogOdds cell) {
    return static_cast<std::uint8_t>(probability_of(cell) > occupied_probability ? 1 : 0);
  });
  TolerantScore score;
  for (std::size_t i = 0; i < occupied.size(); ++i) {
    if (cells.counted[i] == 0) {
      continue;
    }
    const auto offset = static_cast<std::int64_t>(i);
    if (occupied[i] != 0) {
      ++score.claimed;
      score.claimed_right += is_near(cells.grid, cells.exact, offset) ? 1 : 0;
    }
    if (cells.exact[i] != 0) {
      ++score.exact;
      score.exact_found += is_near(cells.grid, occupied, offset) ? 1 : 0;
    }
  }
  return score;
}

}  // namespace skyhalo

#include "skyhalo/map/patch_pyramid.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "skyhalo/map/patch_pyramid.cpp"
#include <hwy/foreach_target.h>
// It must come after what includes this file again for each target.
#include <hwy/highway.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

#include "skyhalo/map/gather_nodes-inl.hpp"
#include "skyhalo/map/judge_cubes-inl.hpp"

#if HWY_ONCE
namespace skyhalo {

HWY_EXPORT(judge_cubes);
HWY_EXPORT(take_row);
HWY_EXPORT(gather_row);

void PatchPyramid::resize(const ScanPatches& patches) {
  rows = patches.rows;
  cols = patches.cols;
  levels = 0;
  std::int32_t next = 0;
  Level level{.rows = rows, .columns = cols, .step_rad = std::numbers::pi / rows};
  for (std::vector<float>* values : {&sin_phi, &cos_phi, &sin_theta, &cos_theta}) {
    values->clear();
  }
  while (true) {
    const auto at = static_cast<std::size_t>(levels);
    level.first_column = static_cast<std::int32_t>(sin_phi.size());
    level.first_row = static_cast<std::int32_t>(sin_theta.size());
    shape[at] = level;
    first[at] = next;
    stride[at] = level.columns + level.columns % 2;
    next += level.rows * stride[at];
    if (levels == 0) {
      // Vectors write past the end of a row, and the next level is begun before this one ends.
      next += static_cast<std::int32_t>(kScanPadding);
    }
    find_middles(level);
    ++levels;
    if (level.columns <= 2) {
      break;
    }
    level = {.rows = (level.rows + 1) / 2,
             .columns = (level.columns + 1) / 2,
             .step_rad = 2.0 * level.step_rad};
  }
  for (std::vector<float>* values : nodes.all()) {
    values->assign(static_cast<std::size_t>(next) + kScanPadding, 0.0F);
  }
  for (std::vector<float>* values : {&sin_phi, &cos_phi}) {
    values->resize(values->size() + kScanPadding, 0.0F);
  }
}

/// The middles of a level's rows and columns. The last column, at an even place, is its own
/// neighbour.
void PatchPyramid::find_middles(const Level& level) {
  for (int row = 0; row < level.rows; ++row) {
    const double theta_rad = (row + 0.5) * level.step_rad;
    sin_theta.push_back(static_cast<float>(std::sin(theta_rad)));
    cos_theta.push_back(static_cast<float>(std::cos(theta_rad)));
  }
  for (int col = 0; col < level.columns + level.columns % 2; ++col) {
    const double phi_rad = (std::min(col, level.columns - 1) + 0.5) * level.step_rad;
    sin_phi.push_back(static_cast<float>(-std::sin(phi_rad)));  // azimuths begin at -pi
    cos_phi.push_back(static_cast<float>(-std::cos(phi_rad)));
  }
}

void PatchPyramid::build(const ScanPatches& patches, const CellFrame& frame) {
  if (patches.rows != rows) {
    resize(patches);
  }
  R_map_body = frame.R_map_body;
  for (int row = 0; row < rows; ++row) {
    const DirectionRow taken{
        .first = static_cast<std::size_t>(row) * static_cast<std::size_t>(cols),
        .to = row_of(0, row),
        .sin_theta = sin_theta[static_cast<std::size_t>(row)],
        .cos_theta = cos_theta[static_cast<std::size_t>(row)],
        .rows_per_rad = static_cast<float>(1.0 / shape[0].step_rad)};
    HWY_DYNAMIC_DISPATCH(take_row)(patches, taken, *this);
    if (row % 2 == 1 || row + 1 == rows) {
      gather(1, row / 2);
    }
  }
  for (int level = 2; level < levels; ++level) {
    for (int row = 0; row < shape[static_cast<std::size_t>(level)].rows; ++row) {
      gather(level, row);
    }
  }
  const int top = levels - 1;
  const std::span<const float> far_m(nodes.far_m);
  const std::size_t begin = row_of(top, 0);
  const std::size_t end = row_of(top, shape[static_cast<std::size_t>(top)].rows);
  reach_m_ = std::max(0.0F, *std::max_element(&far_m[begin], &far_m[end]));
}

/// The first node of a row.
std::size_t PatchPyramid::row_of(int level, int row) const noexcept {
  const auto at = static_cast<std::size_t>(level);
  return static_cast<std::size_t>(first[at]) +
         static_cast<std::size_t>(row) * static_cast<std::size_t>(stride[at]);
}

/// One row of a level from the two finer ones, of which the second may be missing.
void PatchPyramid::gather(int level, int row) {
  const auto at = static_cast<std::size_t>(level);
  const Level& fine = shape[at - 1];
  const auto fine_row = [&](int index) {
    const std::size_t at_row =
        static_cast<std::size_t>(fine.first_row) + static_cast<std::size_t>(index);
    return NodeRow{.first = row_of(level - 1, index),
                   .first_column = static_cast<std::size_t>(fine.first_column),
                   .sin_theta = sin_theta[at_row],
                   .cos_theta = cos_theta[at_row],
                   // Half an edge by theta and half an edge by phi, and room for rounding.
                   .extent_rad = static_cast<float>(0.5001 * std::sqrt(2.0) * fine.step_rad)};
  };
  const NodeRow above = fine_row(2 * row);
  const NodeRow below = fine_row(std::min(2 * row + 1, fine.rows - 1));
  HWY_DYNAMIC_DISPATCH(gather_row)
  (*this, above, below, row_of(level, row), shape[at].columns);
  close_row(level, row);
}

/// Ends a row of nodes: a last one at an even place is its own neighbour.
void PatchPyramid::close_row(int level, int row) {
  const Level& here = shape[static_cast<std::size_t>(level)];
  const std::size_t last = row_of(level, row) + static_cast<std::size_t>(here.columns) - 1;
  if (here.columns % 2 != 0) {
    for (std::vector<float>* values : nodes.all()) {
      (*values)[last + 1] = (*values)[last];
    }
  }
}

void PatchPyramid::judge(const Cubes& cubes, Verdicts& verdicts) const noexcept {
  HWY_DYNAMIC_DISPATCH(judge_cubes)(*this, cubes, verdicts);
}

}  // namespace skyhalo
#endif

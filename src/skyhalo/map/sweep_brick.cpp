#include "skyhalo/map/sweep_brick.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "skyhalo/map/sweep_brick.cpp"
#include <hwy/foreach_target.h>
// It must come after what includes this file again for each target.
#include <hwy/highway.h>

#include <cstring>

#include "skyhalo/map/look_up_cells-inl.hpp"

HWY_BEFORE_NAMESPACE();

namespace skyhalo::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Finds the directions of an eighth's cells.
HWY_INLINE void locate_eighth(const SweepInput& input,
                              const Eigen::Vector3f& first_m,
                              std::size_t eighth,
                              Places& places) {
  const std::size_t lanes = hn::Lanes(Floats());
  if (input.verdicts.narrow[eighth] != 0) {
    const Sight sight = sight_of(input, first_m, eighth);
    for (std::size_t i = 0; i < kEighthCells; i += lanes) {
      locate_near(input, sight, i, places);
    }
  } else {
    for (std::size_t i = 0; i < kEighthCells; i += lanes) {
      locate(input, first_m, i, places);
    }
  }
  if (lanes < kWindowLanes) {
    places.in_window = false;
  } else if (input.verdicts.windows.fits(eighth, kWindowEdge, input.patches.cols)) {
    places.window.row = input.verdicts.windows.first_row[eighth];
    places.window.col = input.verdicts.windows.first_col[eighth];
    find_rows(input.patches, places.window);
    places.in_window = true;
  } else {
    find_window(input.patches, places);
  }
}

/// Looks an eighth's cells up in their directions.
HWY_INLINE void look_up_eighth(const SweepInput& input, Places& places) {
  if (places.in_window) {
    look_up_in_window(input, places);
    return;
  }
  for (std::size_t i = 0; i < kEighthCells; i += hn::Lanes(Floats())) {
    look_up(input, i, places);
  }
}

/// Stores what two eighths get, of which the second one is behind the first along z, in the rows of
/// their brick. Returns whether that is anything.
HWY_INLINE bool store_pair(const std::int16_t* low, const std::int16_t* high, std::int16_t* rows) {
  constexpr std::size_t kRow = sizeof(std::uint64_t);
  std::uint64_t said = 0;
  for (std::size_t x = 0; x < kEighthEdge; ++x) {
    for (std::size_t y = 0; y < kEighthEdge; ++y) {
      const std::size_t from = (x * kEighthEdge + y) * kEighthEdge;
      const std::size_t to = (x * kBrickEdge + y) * kBrickEdge;
      std::array<std::uint64_t, 2> row{};
      std::memcpy(&row[0], low + from, kRow);
      std::memcpy(&row[1], high + from, kRow);
      std::memcpy(rows + to, row.data(), 2 * kRow);
      said |= row[0] | row[1];
    }
  }
  return said != 0;
}

bool sweep_cells(const SweepInput& input,
                 const Eigen::Vector3f& first_m,
                 std::size_t first_eighth,
                 std::int16_t* increments) {
  std::array<Places, kEighths> places;  // NOLINT(*-member-init): filled before it is read
  for (std::size_t eighth = 0; eighth < kEighths; ++eighth) {
    const CubeVerdict verdict = input.verdicts.verdict[first_eighth + eighth];
    if (verdict == CubeVerdict::kMixed) {
      locate_eighth(
          input, first_m + input.offsets.eighth_m[eighth], first_eighth + eighth, places[eighth]);
    } else {
      const bool crossed = verdict == CubeVerdict::kCrossed;
      places[eighth].increment.fill(static_cast<std::int16_t>(crossed ? input.table.crossed() : 0));
    }
  }
  // Not before all are located: each window is waited for.
  bool said = false;
  for (std::size_t eighth = 0; eighth < kEighths; ++eighth) {
    if (input.verdicts.verdict[first_eighth + eighth] == CubeVerdict::kMixed) {
      look_up_eighth(input, places[eighth]);
    }
    if (eighth % 2 == 1) {
      std::int16_t* const rows = increments + place_in_brick(first_of_eighth(eighth - 1));
      const bool pair_says =
          store_pair(places[eighth - 1].increment.data(), places[eighth].increment.data(), rows);
      said = said || pair_says;
    }
  }
  return said;
}

}  // namespace skyhalo::HWY_NAMESPACE

HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace skyhalo {

HWY_EXPORT(sweep_cells);

void BrickOffsets::find(const CellFrame& frame) {
  const Eigen::Matrix3f R_body_map = frame.R_map_body.transpose();
  const auto seen = [&](const Eigen::Vector3f& cells) -> Eigen::Vector3f {
    return R_body_map * (frame.voxel_m * cells);
  };
  for (std::size_t i = 0; i < kEighthCells; ++i) {
    const int at = static_cast<int>(i);
    const Eigen::Vector3f offset_m =
        seen(Eigen::Vector3i(at >> 4, (at >> 2) & 3, at & 3).cast<float>());
    x_m[i] = offset_m.x();
    y_m[i] = offset_m.y();
    z_m[i] = offset_m.z();
  }
  for (std::size_t eighth = 0; eighth < kEighths; ++eighth) {
    eighth_m[eighth] = seen(first_of_eighth(eighth).cast<float>());
  }
  to_middle_m = seen(Eigen::Vector3f::Constant(0.5F * (kEighthEdge - 1)));
}

bool sweep_brick(const SweepInput& input,
                 const Eigen::Vector3f& first_m,
                 std::size_t first_eighth,
                 BrickCells& increments) noexcept {
  return HWY_DYNAMIC_DISPATCH(sweep_cells)(input, first_m, first_eighth, increments.cells.data());
}

}  // namespace skyhalo
#endif

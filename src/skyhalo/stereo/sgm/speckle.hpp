#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "skyhalo/stereo/sgm/link_bits.hpp"
#include "skyhalo/stereo/sgm/plane.hpp"

namespace skyhalo::sgm {

/// Finds islands of disparity and drops the small ones (Hirschmueller 2008: removal of peaks). Rows
/// are cut into runs of linked pixels; runs that are linked to one in the row above are one island.
class SpeckleFilter {
 public:
  SpeckleFilter() = default;
  SpeckleFilter(int width, int height);

  /// How row v hangs together. Rows may be looked at in any order, by any thread.
  void look_at(const Plane<std::int16_t>& disparity_64, int v, int step_64) noexcept;

  /// After all rows were looked at: islands of fewer than `size_px` pixels become -1.
  void drop_small(Plane<std::int16_t>& disparity_64, int size_px) noexcept;

 private:
  /// Pixels [first, last) of a row, and the island they belong to.
  struct Run {
    int first;
    int last;
    int parent;
    int size_px;
  };

  [[nodiscard]] LinkBits bits_of(int v) noexcept;
  void find_runs(int v) noexcept;
  void join_row_above(int v) noexcept;
  int root_of(int run) noexcept;
  void join(int a, int b) noexcept;

  int width_ = 0;
  int height_ = 0;
  std::size_t words_ = 0;  // of a row
  std::vector<std::uint64_t> bits_;
  std::vector<Run> runs_;       // room for all that an image can have
  std::vector<int> first_run_;  // of each row, and the end
};

}  // namespace skyhalo::sgm

#include "skyhalo/stereo/sgm/speckle.hpp"

#include <algorithm>
#include <bit>

namespace skyhalo::sgm {
namespace {

constexpr std::uint64_t kAll = ~std::uint64_t{0};

/// The first bit at or after `from` that is set in `word(i)`, words of 64; `end` if there is none.
template <class Word>
int next_bit(const Word& word, int from, int end) noexcept {
  int at = from;
  while (at < end) {
    const std::uint64_t rest = word(at / 64) & (kAll << static_cast<unsigned>(at % 64));
    if (rest != 0) {
      return std::min(end, at / 64 * 64 + std::countr_zero(rest));
    }
    at = at / 64 * 64 + 64;
  }
  return end;
}

}  // namespace

SpeckleFilter::SpeckleFilter(int width, int height)
    : width_(width),
      height_(height),
      words_(static_cast<std::size_t>((width + 63) / 64 + 2)),
      bits_(3 * words_ * static_cast<std::size_t>(height)),
      runs_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height)),
      first_run_(static_cast<std::size_t>(height) + 1) {}

LinkBits SpeckleFilter::bits_of(int v) noexcept {
  std::uint64_t* const row = bits_.data() + 3 * words_ * static_cast<std::size_t>(v);
  return {row, row + words_, row + 2 * words_};
}

void SpeckleFilter::look_at(const Plane<std::int16_t>& disparity_64, int v, int step_64) noexcept {
  find_links(disparity_64, v, step_64, bits_of(v));
}

int SpeckleFilter::root_of(int run) noexcept {
  while (runs_[static_cast<std::size_t>(run)].parent != run) {
    Run& here = runs_[static_cast<std::size_t>(run)];
    here.parent = runs_[static_cast<std::size_t>(here.parent)].parent;
    run = here.parent;
  }
  return run;
}

void SpeckleFilter::join(int a, int b) noexcept {
  const int root_a = root_of(a);
  const int root_b = root_of(b);
  if (root_a == root_b) {
    return;
  }
  Run& first = runs_[static_cast<std::size_t>(std::min(root_a, root_b))];
  Run& second = runs_[static_cast<std::size_t>(std::max(root_a, root_b))];
  second.parent = std::min(root_a, root_b);
  first.size_px += second.size_px;
}

void SpeckleFilter::find_runs(int v) noexcept {
  const LinkBits bits = bits_of(v);
  const auto starts = [&bits](int i) { return bits.valid[i] & ~bits.across[i]; };
  const auto not_across = [&bits](int i) { return ~bits.across[i]; };
  int count = first_run_[static_cast<std::size_t>(v)];
  for (int u = next_bit(starts, 0, width_); u < width_;) {
    const int last = next_bit(not_across, u + 1, width_);
    runs_[static_cast<std::size_t>(count)] = {u, last, count, last - u};
    ++count;
    u = next_bit(starts, last, width_);
  }
  first_run_[static_cast<std::size_t>(v) + 1] = count;
}

void SpeckleFilter::join_row_above(int v) noexcept {
  const LinkBits bits = bits_of(v);
  const auto down = [&bits](int i) { return bits.down[i]; };
  int above = first_run_[static_cast<std::size_t>(v) - 1];
  int here = first_run_[static_cast<std::size_t>(v)];
  const int end_above = here;
  const int end_here = first_run_[static_cast<std::size_t>(v) + 1];
  while (above < end_above && here < end_here) {
    const Run& upper = runs_[static_cast<std::size_t>(above)];
    const Run& lower = runs_[static_cast<std::size_t>(here)];
    const int from = std::max(upper.first, lower.first);
    const int to = std::min(upper.last, lower.last);
    const bool upper_ends_first = upper.last <= lower.last;
    if (from < to && next_bit(down, from, to) < to) {
      join(above, here);
    }
    ++(upper_ends_first ? above : here);
  }
}

void SpeckleFilter::drop_small(Plane<std::int16_t>& disparity_64, int size_px) noexcept {
  for (int v = 0; v < height_; ++v) {
    find_runs(v);
    if (v > 0) {
      join_row_above(v);
    }
  }
  for (int v = 0; v < height_; ++v) {
    std::int16_t* const row = disparity_64.row(v);
    for (int run = first_run_[static_cast<std::size_t>(v)];
         run < first_run_[static_cast<std::size_t>(v) + 1];
         ++run) {
      const Run& here = runs_[static_cast<std::size_t>(run)];
      if (runs_[static_cast<std::size_t>(root_of(run))].size_px < size_px) {
        std::fill(row + here.first, row + here.last, std::int16_t{-1});
      }
    }
  }
}

}  // namespace skyhalo::sgm

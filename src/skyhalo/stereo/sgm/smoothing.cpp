#include "skyhalo/stereo/sgm/smoothing.hpp"

#include <cstdint>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "skyhalo/stereo/sgm/smoothing.cpp"
#include <hwy/foreach_target.h>
// They must come after what includes this file again for each target.
#include <hwy/highway.h>

#include "skyhalo/stereo/sgm/rounded_mean-inl.hpp"

HWY_BEFORE_NAMESPACE();

namespace skyhalo::sgm::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Bytes = hn::ScalableTag<std::uint8_t>;

void cross_rows(const Plane<std::uint8_t>& image, int first, int last, Plane<std::uint8_t>& cross) {
  const Bytes bytes;
  for (int v = first; v < last; ++v) {
    const std::uint8_t* const at = image.row(v);
    const std::uint8_t* const above = image.row(v - 1);
    const std::uint8_t* const below = image.row(v + 1);
    std::uint8_t* const to = cross.row(v);
    for (int u = 0; u < image.width(); u += static_cast<int>(hn::Lanes(bytes))) {
      const auto column = rounded_mean(hn::LoadU(bytes, above + u), hn::LoadU(bytes, below + u));
      const auto row = rounded_mean(hn::LoadU(bytes, at + u - 1), hn::LoadU(bytes, at + u + 1));
      const auto ring = rounded_mean(column, row);
      hn::StoreU(rounded_mean(hn::LoadU(bytes, at + u), ring), bytes, to + u);
    }
    cross.replicate_sides(v);
  }
}

/// avg(centre, avg(left, right)) of the vector at `at`.
template <class D>
HWY_INLINE hn::Vec<D> along_row(D bytes, const std::uint8_t* at) {
  const auto sides = rounded_mean(hn::LoadU(bytes, at - 1), hn::LoadU(bytes, at + 1));
  return rounded_mean(hn::LoadU(bytes, at), sides);
}

void box_rows(const Plane<std::uint8_t>& image, int first, int last, Plane<std::uint8_t>& box) {
  const Bytes bytes;
  for (int v = first; v < last; ++v) {
    const std::uint8_t* const at = image.row(v);
    const std::uint8_t* const above = image.row(v - 1);
    const std::uint8_t* const below = image.row(v + 1);
    std::uint8_t* const to = box.row(v);
    for (int u = 0; u < image.width(); u += static_cast<int>(hn::Lanes(bytes))) {
      const auto sides = rounded_mean(along_row(bytes, above + u), along_row(bytes, below + u));
      hn::StoreU(rounded_mean(along_row(bytes, at + u), sides), bytes, to + u);
    }
    box.replicate_sides(v);
  }
}

template <class V>
HWY_INLINE void sort_two(V& low, V& high) {
  const V smaller = hn::Min(low, high);
  high = hn::Max(low, high);
  low = smaller;
}

template <class V>
HWY_INLINE void sort_three(V& low, V& middle, V& high) {
  sort_two(low, middle);
  sort_two(middle, high);
  sort_two(low, middle);
}

template <class V>
HWY_INLINE V median_of_three(V a, V b, V c) {
  return hn::Max(hn::Min(a, b), hn::Min(hn::Max(a, b), c));
}

void median_rows(const Plane<std::uint8_t>& image, int first, int last, Plane<std::uint8_t>& out) {
  const Bytes bytes;
  for (int v = first; v < last; ++v) {
    const std::uint8_t* const above = image.row(v - 1);
    const std::uint8_t* const at = image.row(v);
    const std::uint8_t* const below = image.row(v + 1);
    std::uint8_t* const to = out.row(v);
    for (int u = 0; u < image.width(); u += static_cast<int>(hn::Lanes(bytes))) {
      auto low = hn::LoadU(bytes, above + u - 1);
      auto middle = hn::LoadU(bytes, at + u - 1);
      auto high = hn::LoadU(bytes, below + u - 1);
      sort_three(low, middle, high);
      auto low_next = hn::LoadU(bytes, above + u);
      auto middle_next = hn::LoadU(bytes, at + u);
      auto high_next = hn::LoadU(bytes, below + u);
      sort_three(low_next, middle_next, high_next);
      auto low_last = hn::LoadU(bytes, above + u + 1);
      auto middle_last = hn::LoadU(bytes, at + u + 1);
      auto high_last = hn::LoadU(bytes, below + u + 1);
      sort_three(low_last, middle_last, high_last);
      // The median is that of the largest low, the middle middle and the smallest high.
      const auto largest_low = hn::Max(hn::Max(low, low_next), low_last);
      const auto smallest_high = hn::Min(hn::Min(high, high_next), high_last);
      const auto middle_middle = median_of_three(middle, middle_next, middle_last);
      hn::StoreU(median_of_three(largest_low, middle_middle, smallest_high), bytes, to + u);
    }
    out.replicate_sides(v);
  }
}

}  // namespace skyhalo::sgm::HWY_NAMESPACE

HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace skyhalo::sgm {

HWY_EXPORT(cross_rows);
HWY_EXPORT(box_rows);
HWY_EXPORT(median_rows);

void smooth_cross(const Plane<std::uint8_t>& image,
                  int first,
                  int last,
                  Plane<std::uint8_t>& cross) {
  HWY_DYNAMIC_DISPATCH(cross_rows)(image, first, last, cross);
}

void smooth_box(const Plane<std::uint8_t>& image, int first, int last, Plane<std::uint8_t>& box) {
  HWY_DYNAMIC_DISPATCH(box_rows)(image, first, last, box);
}

void median_3x3(const Plane<std::uint8_t>& image,
                int first,
                int last,
                Plane<std::uint8_t>& median) {
  HWY_DYNAMIC_DISPATCH(median_rows)(image, first, last, median);
}

}  // namespace skyhalo::sgm
#endif

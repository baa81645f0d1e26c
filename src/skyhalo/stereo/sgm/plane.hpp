#pragma once

#include <algorithm>
#include <cstddef>

#include "skyhalo/stereo/sgm/aligned_buffer.hpp"

namespace skyhalo::sgm {

/// An image whose rows may be read beyond their ends: `kMargin` pixels to every side hold what
/// `replicate_sides` or `fill_margin` put there, and whole vectors may be written from any pixel.
template <class T>
class Plane {
 public:
  static constexpr int kMargin = 4;

  Plane() = default;

  Plane(int width, int height)
      : width_(width),
        height_(height),
        stride_(kLead + rounded_up(width, kLead) + kSlack),
        values_(static_cast<std::size_t>(stride_) *
                static_cast<std::size_t>(height + 2 * kMargin)) {}

  [[nodiscard]] int width() const noexcept { return width_; }

  [[nodiscard]] int height() const noexcept { return height_; }

  /// Row v in [-kMargin, height + kMargin), from column 0 on.
  [[nodiscard]] T* row(int v) noexcept { return values_.data() + offset(v); }

  [[nodiscard]] const T* row(int v) const noexcept { return values_.data() + offset(v); }

  /// Writes the row's first and last pixel into its margins, and what is the first or last row of
  /// all into the rows beyond.
  void replicate_sides(int v) noexcept {
    T* const to = row(v);
    std::fill(to - kMargin, to, to[0]);
    std::fill(to + width_, to + width_ + kMargin, to[width_ - 1]);
    for (int beyond = 1; beyond <= kMargin; ++beyond) {
      if (v == 0) {
        std::copy(to - kMargin, to + width_ + kMargin, row(-beyond) - kMargin);
      }
      if (v == height_ - 1) {
        std::copy(to - kMargin, to + width_ + kMargin, row(v + beyond) - kMargin);
      }
    }
  }

  /// Sets everything outside the image's own pixels.
  void fill_margin(T value) noexcept {
    for (int v = -kMargin; v < height_ + kMargin; ++v) {
      T* const to = row(v) - kLead;
      const bool outside = v < 0 || v >= height_;
      std::fill(to, to + (outside ? stride_ : kLead), value);
      std::fill(row(v) + width_, to + stride_, value);
    }
  }

  /// The margin beside row v, after whole vectors were written over it.
  void fill_right_margin(int v, T value) noexcept {
    std::fill(row(v) + width_, row(v) + width_ + kMargin, value);
  }

 private:
  static constexpr int kLead = 64;    // keeps column 0 aligned
  static constexpr int kSlack = 320;  // the margin and the widest vector

  static constexpr int rounded_up(int value, int step) noexcept {
    return (value + step - 1) / step * step;
  }

  [[nodiscard]] std::ptrdiff_t offset(int v) const noexcept {
    return static_cast<std::ptrdiff_t>(v + kMargin) * stride_ + kLead;
  }

  int width_ = 0;
  int height_ = 0;
  std::ptrdiff_t stride_ = 0;
  AlignedBuffer<T> values_;
};

}  // namespace skyhalo::sgm

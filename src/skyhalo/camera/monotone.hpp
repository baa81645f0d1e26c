#pragma once

#include <cmath>

namespace skyhalo {

/// A value and its derivative.
struct ValueAndSlope {
  double value = 0.0;
  double slope = 0.0;
};

/// Where a growing function, `f(x) -> ValueAndSlope`, takes the value `target` in [0, last]; the
/// nearer end when it takes it nowhere there. Newton's method, kept inside a shrinking bracket.
template <class Function>
[[nodiscard]] double solve_growing(const Function& f, double target, double last) noexcept {
  double low = 0.0;
  double high = last;
  double x = target > 0.0 && target < last ? target : 0.5 * last;
  for (int i = 0; i < 100 && low < high; ++i) {
    const ValueAndSlope at = f(x);
    const double excess = at.value - target;
    (excess > 0.0 ? high : low) = x;
    double next = x - excess / at.slope;
    if (!(next > low && next < high)) {
      next = 0.5 * (low + high);
    }
    if (std::abs(next - x) <= 1e-16 * last || next == x) {
      return next;
    }
    x = next;
  }
  return x;
}

/// The last x up to `last`, found in steps of `step` and then halved down to rounding, to which
/// `holds` is true from 0 on; 0 when it holds nowhere.
template <class Predicate>
[[nodiscard]] double holds_until(const Predicate& holds, double step, double last) noexcept {
  double good = 0.0;
  double bad = 0.0;
  for (int i = 1; bad == 0.0 && last > 0.0; ++i) {
    const double x = std::fmin(step * i, last);
    if (!holds(x)) {
      bad = x;
    } else if (x >= last) {
      return last;
    } else {
      good = x;
    }
  }
  for (int i = 0; i < 50; ++i) {
    const double middle = 0.5 * (good + bad);
    (holds(middle) ? good : bad) = middle;
  }
  return good;
}

}  // namespace skyhalo

#pragma once

#include <algorithm>
#include <cstddef>
#include <ctime>
#include <vector>

namespace skyhalo::bench {

/// CPU time of this process, all threads (ms).
inline double process_ms() {
  std::timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

/// The middle one; of an even number the upper. Not of none.
inline double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace skyhalo::bench

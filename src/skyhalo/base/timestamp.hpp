#pragma once

#include <chrono>

namespace skyhalo {

/// When the data was taken: nanoseconds since 1970-01-01 00:00 UTC. Time always comes with the
/// data.
using Timestamp = std::chrono::sys_time<std::chrono::nanoseconds>;

/// Seconds since 1970-01-01 00:00 UTC, good to about 0.2 us.
[[nodiscard]] inline double seconds_since_epoch(Timestamp stamp) noexcept {
  return std::chrono::duration<double>(stamp.time_since_epoch()).count();
}

}  // namespace skyhalo

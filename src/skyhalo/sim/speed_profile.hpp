#pragma once

#include <vector>

#include "skyhalo/sim/flight_path.hpp"
#include "skyhalo/sim/waypoint_flight.hpp"

namespace skyhalo {

/// The speeds (m/s) at the points of a path with which it is flown fastest from rest to rest: no
/// faster than the limit, and the acceleration along and across the path together no larger.
/// Between points the acceleration along the path is constant. At corners it is next to a stop.
[[nodiscard]] std::vector<double> fastest_speeds(const FlightPath& path,
                                                 const FlightLimits& limits);

/// The times (s) at the points of a path that is flown with these speeds (m/s, never twice 0 in a
/// row), from 0.
[[nodiscard]] std::vector<double> times_at(const FlightPath& path,
                                           const std::vector<double>& speeds_mps);

}  // namespace skyhalo

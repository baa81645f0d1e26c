#pragma once

#include <optional>

#include "skyhalo/sim/flight_plan.hpp"
#include "skyhalo/sim/scene.hpp"

namespace skyhalo {

/// The widest level circle (of some) about a place on the scene's route that comes no nearer than
/// `body_radius_m` to what stands still, flown at up to `speed_mps`; none where none is found, as
/// in a scene without a route. Throws `Error` (input) for settings that `fly_orbit` or
/// `first_collision` refuse.
[[nodiscard]] std::optional<OrbitSettings> clear_orbit(const Scene& scene,
                                                       double speed_mps,
                                                       double body_radius_m);

}  // namespace skyhalo

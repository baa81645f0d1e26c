#pragma once

#include <CLI/CLI.hpp>
#include <memory>
#include <string>
#include <vector>

#include "common_options.hpp"
#include "skyhalo/calibration/rig_description.hpp"
#include "skyhalo/sim/simulated_flight.hpp"

namespace skyhalo::app {

/// What is simulated, as it is asked for.
struct SimulationOptions {
  std::string scene = "forest";
  double difficulty = 0.5;
  double unit_m = 1.0;
  std::string up = "z";
  std::string trajectory = "route";
  double speed_mps = 4.0;
  double body_radius_m = 0.4;
  bool may_collide = false;
  std::uint64_t seed = 1;
  int samples = 4;
  int frames = 0;                   ///< 0: all of the flight
  double rate_hz = 0.0;             ///< 0: 5 per second, or what spreads `frames` over the flight
  int usual_frames = 0;             ///< `frames` where neither is asked for
  std::vector<double> ins_noise{};  ///< m, deg
  std::vector<double> ins_drift{};  ///< m, deg per square root of a second
  double ins_delay_s = 0.0;
  double laser_sigma_m = 0.02;
};

void add_simulation_options(CLI::App& command, SimulationOptions& options);

/// The scene of that name, or of that mesh file. Throws `Error` (input).
[[nodiscard]] Scene open_scene(const SimulationOptions& options);

/// The reference platform of the thesis.
[[nodiscard]] RigDescription reference_rig();

/// The cameras as if they gave images at the resolution that is matched: all smaller, nothing left
/// to shrink. `matching` holds for pairs that do not say and has its masks brought into the pairs.
[[nodiscard]] RigDescription at_matched_resolution(const RigDescription& rig,
                                                   MatchingConfig& matching);

/// The flight that is asked for, with its cameras. Throws `Error` (input) when it passes through
/// what stands in the scene, unless it may.
[[nodiscard]] std::unique_ptr<SimulatedFlight> make_flight(const SimulationOptions& options,
                                                           const CommonOptions& common,
                                                           Scene scene,
                                                           StereoRig rig);

}  // namespace skyhalo::app

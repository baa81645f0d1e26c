#pragma once

#include <CLI/CLI.hpp>

namespace skyhalo::app {

// Each adds one subcommand with its options; the work runs from the subcommand's callback.
void add_demo(CLI::App& program);
void add_run(CLI::App& program);
void add_evaluate(CLI::App& program);
void add_halo(CLI::App& program);
void add_disparity(CLI::App& program);
void add_config(CLI::App& program);
void add_sensor_model(CLI::App& program);
void add_rectify(CLI::App& program);
void add_rig(CLI::App& program);
void add_map(CLI::App& program);
void add_simulate(CLI::App& program);  // with the simulator, as is the demo

}  // namespace skyhalo::app

#include <CLI/CLI.hpp>
#include <exception>
#include <iostream>
#include <new>
#include <opencv2/core/utils/logger.hpp>
#include <string>

#include "commands.hpp"
#include "common_options.hpp"
#include "interrupt.hpp"
#include "skyhalo/base/error.hpp"
#include "skyhalo/base/version.hpp"

namespace {

// Exit codes of the command line's contract.
constexpr int kDone = 0;
constexpr int kFailed = 1;
constexpr int kWrongUsage = 2;
constexpr int kBadInput = 3;
constexpr int kInterrupted = 130;

int exit_code(skyhalo::ErrorKind kind) {
  switch (kind) {
    case skyhalo::ErrorKind::kInput:
      return kBadInput;
    case skyhalo::ErrorKind::kCancelled:
      return kInterrupted;
    case skyhalo::ErrorKind::kFailure:
      break;
  }
  return kFailed;
}

int report(const std::string& message, int code) {
  std::cerr << "skyhalo: " << message << "\n";
  return code;
}

#ifndef SKYHALO_HAS_SIM
// Says why, where "unknown command" would send the user to look for a typing mistake.
void add_missing(CLI::App& program, const std::string& name) {
  CLI::App* const command = program.add_subcommand(name, "not in this build");
  command->group("");
  command->set_help_flag();
  command->allow_extras();
  command->callback([name] {
    throw skyhalo::app::UsageError(name +
                                   " needs the simulator, which this build is without: configure "
                                   "it with -DSKYHALO_BUILD_SIM=ON");
  });
}
#endif

int run(int argc, char** argv) {
  CLI::App program(
      "skyhalo: obstacle detection and 3D mapping from stereo cameras for drones.\n"
      "Results go to files and stdout, progress and messages to stderr.\n"
      "Exit codes: 0 done, 1 failed while running, 2 wrong usage, 3 bad input.",
      "skyhalo");
  program.set_version_flag("--version", std::string("skyhalo ") + skyhalo::kVersion);
  program.require_subcommand(1);
#ifdef SKYHALO_HAS_SIM
  skyhalo::app::add_demo(program);
  skyhalo::app::add_simulate(program);
#else
  add_missing(program, "demo");
  add_missing(program, "simulate");
#endif
  skyhalo::app::add_run(program);
  skyhalo::app::add_evaluate(program);
  skyhalo::app::add_halo(program);
  skyhalo::app::add_disparity(program);
  skyhalo::app::add_config(program);
  skyhalo::app::add_sensor_model(program);
  skyhalo::app::add_rectify(program);
  skyhalo::app::add_rig(program);
  skyhalo::app::add_map(program);
  try {
    program.parse(argc, argv);
  } catch (const CLI::Success& success) {
    return program.exit(success);
  } catch (const CLI::ParseError& error) {
    program.exit(error);
    return kWrongUsage;
  }
  return kDone;
}

}  // namespace

int main(int argc, char** argv) {
  cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT);
  skyhalo::app::catch_interrupts();
  try {
    return run(argc, argv);
  } catch (const skyhalo::app::UsageError& error) {
    return report(error.what(), kWrongUsage);
  } catch (const skyhalo::Error& error) {
    return report(error.what(), exit_code(error.kind()));
  } catch (const std::bad_alloc&) {
    return report("not enough memory; choose smaller bounds or a larger voxel", kFailed);
  } catch (const std::exception& error) {
    return report(error.what(), kFailed);
  }
}

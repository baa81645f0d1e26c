#include <iostream>
#include <memory>

#include "commands.hpp"
#include "common_options.hpp"

namespace skyhalo::app {
namespace {

struct ConfigOptions {
  CommonOptions common;
  bool markdown = false;
};

}  // namespace

void add_config(CLI::App& program) {
  auto options = std::make_shared<ConfigOptions>();
  CLI::App* command = program.add_subcommand(
      "config",
      "print all settings as YAML, after --config and --set; redirect it to start a file");
  command->add_flag("--markdown", options->markdown, "print the documentation page instead");
  add_common_options(*command, options->common);
  command->callback([options] {
    const Config config = load_config(options->common);
    std::cout << (options->markdown ? to_markdown(config) : to_yaml(config));
    flush_stdout();
  });
}

}  // namespace skyhalo::app

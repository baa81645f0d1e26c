#include "common_options.hpp"

#include <tbb/global_control.h>

#include <iostream>
#include <opencv2/core/utility.hpp>
#include <optional>

#include "skyhalo/base/error.hpp"
#include "skyhalo/io/text_file.hpp"

namespace skyhalo::app {

void add_common_options(CLI::App& command, CommonOptions& options) {
  command
      .add_option("--config", options.config_file, "YAML file with settings (see: skyhalo config)")
      ->type_name("FILE");
  command
      .add_option("--set", options.assignments, "one setting, section.key=value; may be repeated")
      ->type_name("KEY=VALUE")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  command.add_option("--threads", options.threads, "threads to use (default: all cores)")
      ->type_name("N")
      ->check(CLI::Range(1, 1024));
  command.add_flag(
      "--json", options.json, "print the summary as one JSON line at the end of stdout");
  command.add_flag("--quiet", options.quiet, "print nothing but errors (and --json)");
}

Config load_config(const CommonOptions& options, const Config& defaults) {
  Config config = defaults;
  if (!options.config_file.empty()) {
    skyhalo::load_config(options.config_file, config);
  }
  for (const std::string& assignment : options.assignments) {
    set_value(assignment, config);
  }
  check(config);
  return config;
}

struct ThreadLimit::Control {
  explicit Control(std::size_t threads)
      : tbb(tbb::global_control::max_allowed_parallelism, threads) {}

  tbb::global_control tbb;
};

ThreadLimit::ThreadLimit(int threads) {
  if (threads > 0) {
    control_ = std::make_unique<Control>(static_cast<std::size_t>(threads));
    cv::setNumThreads(threads);
  }
}

ThreadLimit::~ThreadLimit() = default;

void print_result(const CommonOptions& options,
                  const std::string& text,
                  const nlohmann::json& summary) {
  if (!options.quiet) {
    std::cout << text;
  }
  if (options.json) {
    std::cout << summary.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) << "\n";
  }
  flush_stdout();
}

void flush_stdout() {
  std::cout.flush();
  if (!std::cout) {
    throw Error(ErrorKind::kFailure, "stdout: cannot be written");
  }
}

void print_note(const CommonOptions& options, const std::string& text) {
  if (!options.quiet) {
    std::cerr << "skyhalo: " << text << "\n";
  }
}

void print_warnings(const CommonOptions& options, const std::vector<std::string>& warnings) {
  for (const std::string& warning : warnings) {
    print_note(options, "warning: " + warning);
  }
}

FrameRange parse_frames(const std::string& text, int count) {
  FrameRange range{0, count - 1};
  if (text.empty()) {
    return range;
  }
  const auto bad = [&](const std::string& why) {
    return UsageError("--frames " + text + ": " + why);
  };
  const std::size_t colon = text.find(':');
  const std::string first = text.substr(0, colon);
  const std::string last = colon == std::string::npos ? first : text.substr(colon + 1);
  for (const auto& [word, value] : {std::pair(&first, &range.first), {&last, &range.last}}) {
    if (word->empty()) {
      continue;
    }
    const std::optional<int> number = parse_whole_number(*word);
    if (!number) {
      throw bad("expected FIRST:LAST, two whole numbers");
    }
    *value = *number;
  }
  if (range.first < 0 || range.last >= count || range.first > range.last) {
    throw bad("the recording has frames 0:" + std::to_string(count - 1));
  }
  return range;
}

}  // namespace skyhalo::app

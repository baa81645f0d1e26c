#pragma once

#include <CLI/CLI.hpp>
#include <memory>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "skyhalo/config/config.hpp"

namespace skyhalo::app {

/// The command line is wrong (exit code 2), in a way that the option parser could not see.
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Options that every command has.
struct CommonOptions {
  std::string config_file;
  std::vector<std::string> assignments;
  int threads = 0;
  bool json = false;
  bool quiet = false;
};

void add_common_options(CLI::App& command, CommonOptions& options);

/// The defaults, changed by `--config` and then by each `--set`.
Config load_config(const CommonOptions& options, const Config& defaults = {});

/// Limits the program to `--threads` threads for as long as the object lives.
class ThreadLimit {
 public:
  explicit ThreadLimit(int threads);
  ThreadLimit(const ThreadLimit&) = delete;
  ThreadLimit& operator=(const ThreadLimit&) = delete;
  ThreadLimit(ThreadLimit&&) = delete;
  ThreadLimit& operator=(ThreadLimit&&) = delete;
  ~ThreadLimit();

 private:
  struct Control;
  std::unique_ptr<Control> control_;
};

/// Prints results to stdout and notes to stderr as `--json` and `--quiet` ask for.
void print_result(const CommonOptions& options,
                  const std::string& text,
                  const nlohmann::json& summary);
void print_note(const CommonOptions& options, const std::string& text);

/// Prints each as a note that begins with "warning".
void print_warnings(const CommonOptions& options, const std::vector<std::string>& warnings);

/// Throws `Error` (failure) when what was printed did not arrive.
void flush_stdout();

/// Frames FIRST to LAST, both included.
struct FrameRange {
  int first = 0;
  int last = 0;
};

/// Reads `FIRST:LAST` (either may be missing) for a recording of `count` frames. Throws
/// `UsageError` when it is malformed or leaves the recording.
FrameRange parse_frames(const std::string& text, int count);

}  // namespace skyhalo::app

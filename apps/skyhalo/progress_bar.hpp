#pragma once

#include <chrono>
#include <string>

namespace skyhalo::app {

/// A progress bar on stderr, drawn only on a terminal and at most ten times a second.
class ProgressBar {
 public:
  ProgressBar(std::string label, int total, bool quiet);
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;
  ProgressBar(ProgressBar&&) = delete;
  ProgressBar& operator=(ProgressBar&&) = delete;

  /// Ends the line, so that what is printed next stands on its own.
  ~ProgressBar();

  /// One more step is done.
  void advance();

 private:
  void draw(std::chrono::steady_clock::time_point now);

  std::string label_;
  int total_;
  int done_ = 0;
  bool visible_;
  std::chrono::steady_clock::time_point start_;
  std::chrono::steady_clock::time_point drawn_;
};

}  // namespace skyhalo::app

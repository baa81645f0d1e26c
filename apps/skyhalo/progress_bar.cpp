#include "progress_bar.hpp"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <iostream>
#include <utility>

namespace skyhalo::app {

using Clock = std::chrono::steady_clock;

ProgressBar::ProgressBar(std::string label, int total, bool quiet)
    : label_(std::move(label)),
      total_(std::max(1, total)),
      visible_(!quiet && ::isatty(STDERR_FILENO) != 0),
      start_(Clock::now()) {
  draw(start_);
}

ProgressBar::~ProgressBar() {
  if (visible_) {
    draw(Clock::now());
    std::cerr << "\n";
  }
}

void ProgressBar::advance() {
  ++done_;
  const Clock::time_point now = Clock::now();
  if (now - drawn_ > std::chrono::milliseconds(100)) {
    draw(now);
  }
}

void ProgressBar::draw(Clock::time_point now) {
  if (!visible_) {
    return;
  }
  drawn_ = now;
  constexpr int kWidth = 30;
  const int filled = std::min(kWidth, kWidth * done_ / total_);
  const double elapsed_s = std::chrono::duration<double>(now - start_).count();
  const double left_s = done_ > 0 ? elapsed_s / done_ * (total_ - done_) : 0.0;
  std::array<char, 160> line{};
  std::snprintf(line.data(),
                line.size(),
                "\r%-14s [%s%s] %d/%d  %.0f s, %.0f s to go \x1b[K",
                label_.c_str(),
                std::string(static_cast<std::size_t>(filled), '#').c_str(),
                std::string(static_cast<std::size_t>(kWidth - filled), ' ').c_str(),
                done_,
                total_,
                elapsed_s,
                left_s);
  std::cerr << line.data() << std::flush;
}

}  // namespace skyhalo::app

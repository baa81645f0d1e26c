#include "interrupt.hpp"

#include <csignal>

#include "skyhalo/base/error.hpp"

namespace skyhalo::app {
namespace {

volatile std::sig_atomic_t stop_asked = 0;

/// The second time the signal does what it always does.
void ask_to_stop(int signal) {
  stop_asked = 1;
  std::signal(signal, SIG_DFL);
}

}  // namespace

void catch_interrupts() {
  std::signal(SIGINT, ask_to_stop);
  std::signal(SIGTERM, ask_to_stop);
  std::signal(SIGHUP, ask_to_stop);
}

void stop_if_interrupted() {
  if (stop_asked != 0) {
    throw Error(ErrorKind::kCancelled, "stopped; no result was written");
  }
}

}  // namespace skyhalo::app

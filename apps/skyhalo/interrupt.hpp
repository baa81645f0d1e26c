#pragma once

namespace skyhalo::app {

/// From now on Ctrl-C, SIGTERM and a closed terminal ask the work to stop at the next frame instead
/// of ending the program, so that unfinished results are cleaned up.
void catch_interrupts();

/// Throws `Error` (cancelled) when a stop was asked for.
void stop_if_interrupted();

}  // namespace skyhalo::app

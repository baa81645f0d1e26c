#pragma once

#include <functional>

namespace skyhalo {

/// Is told from time to time which share of a piece of work is done, in [0, 1]. What it throws ends
/// the work. May be empty.
using Progress = std::function<void(double share)>;

}  // namespace skyhalo

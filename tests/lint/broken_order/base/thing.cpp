// It would be put right.
// clang-format off
#include <vector>

#include "skyhalo/base/thing.hpp"

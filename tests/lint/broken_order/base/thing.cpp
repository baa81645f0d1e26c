#include <vector>

#include "skyhalo/base/thing.hpp"

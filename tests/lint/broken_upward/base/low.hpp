#pragma once

#include "skyhalo/geometry/high.hpp"

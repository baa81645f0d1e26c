#pragma once

#include "skyhalo/base/low.hpp"

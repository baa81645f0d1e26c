#pragma once

#include <string_view>

namespace skyhalo {

/// The text of `config/rigs/matrice100.yaml`, built into the program.
extern const std::string_view kReferenceRig;

}  // namespace skyhalo

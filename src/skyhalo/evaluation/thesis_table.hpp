#pragma once

#include <optional>
#include <string_view>

#include "skyhalo/evaluation/metrics.hpp"

namespace skyhalo {

/// The row that the thesis prints for a KITTI tracking sequence ("0000" to "0009") in its
/// table 8.1, for comparison; none for any other name.
[[nodiscard]] std::optional<Metrics> thesis_row(std::string_view sequence);

}  // namespace skyhalo

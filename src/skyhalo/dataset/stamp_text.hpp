#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "skyhalo/base/timestamp.hpp"

namespace skyhalo {

/// A stamp as whole nanoseconds since 1970; through a double it would be off by up to 128 ns.
/// Internal to this layer, as all of this header.
[[nodiscard]] std::string stamp_text(Timestamp stamp);

/// The stamp of such a text, which must not be below 0; none for any other.
[[nodiscard]] std::optional<Timestamp> parse_stamp(std::string_view text) noexcept;

}  // namespace skyhalo

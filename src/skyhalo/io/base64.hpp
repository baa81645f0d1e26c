#pragma once

#include <string>
#include <string_view>

namespace skyhalo {

/// Bytes as text that a page can hold (RFC 4648, section 4).
[[nodiscard]] std::string base64(std::string_view bytes);

}  // namespace skyhalo

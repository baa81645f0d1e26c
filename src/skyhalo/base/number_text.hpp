#pragma once

#include <string>

namespace skyhalo {

/// A number in the words of `printf`, for instance `%.3f`; what is longer than 63 characters is
/// cut.
[[nodiscard]] std::string number_text(const char* format, double value);

}  // namespace skyhalo

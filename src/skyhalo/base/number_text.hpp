#pragma once

#include <string>

namespace skyhalo {

/// A number in the words of `printf`, for instance `%.3f`; what is longer than 63 characters is
/// cut.
[[nodiscard]] std::string number_text(const char* format, double value);

/// The shortest text that reads back as the same number.
[[nodiscard]] std::string exact_number_text(double value);

}  // namespace skyhalo

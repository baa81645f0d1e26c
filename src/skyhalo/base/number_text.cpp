#include "skyhalo/base/number_text.hpp"

#include <algorithm>
#include <array>
#include <cstdio>

namespace skyhalo {

std::string number_text(const char* format, double value) {
  std::array<char, 64> text{};
  const int length = std::snprintf(text.data(), text.size(), format, value);
  return {text.data(), std::min(static_cast<std::size_t>(std::max(length, 0)), text.size() - 1)};
}

}  // namespace skyhalo

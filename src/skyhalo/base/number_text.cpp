#include "skyhalo/base/number_text.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdio>

namespace skyhalo {

std::string number_text(const char* format, double value) {
  std::array<char, 64> text{};
  const int length = std::snprintf(text.data(), text.size(), format, value);
  return {text.data(), std::min(static_cast<std::size_t>(std::max(length, 0)), text.size() - 1)};
}

std::string exact_number_text(double value) {
  std::array<char, 32> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value).ptr;
  return {text.data(), end};
}

}  // namespace skyhalo

#pragma once

#include <cstdint>

namespace skyhalo {

/// The greatest whole number not above a / b; b >= 1, a above the least of its type.
[[nodiscard]] constexpr std::int64_t floor_div(std::int64_t a, std::int64_t b) noexcept {
  return a >= 0 ? a / b : -((-a + b - 1) / b);
}

/// The least whole number not below a / b; b >= 1, a above the least of its type.
[[nodiscard]] constexpr std::int64_t ceil_div(std::int64_t a, std::int64_t b) noexcept {
  return -floor_div(-a, b);
}

}  // namespace skyhalo

#pragma once

#include <cstdint>
#include <initializer_list>

#include "skyhalo/sim/random_numbers.hpp"

namespace skyhalo {

/// Random bits that depend on all of the numbers and nothing else: what is simulated does not
/// depend on the order in which it is done.
[[nodiscard]] constexpr std::uint64_t random_bits(
    std::initializer_list<std::uint64_t> numbers) noexcept {
  std::uint64_t bits = 0;
  for (const std::uint64_t number : numbers) {
    bits = stirred(bits ^ number, 0);
  }
  return bits;
}

/// A number in [0, 1) of random bits.
[[nodiscard]] constexpr double uniform(std::uint64_t bits) noexcept {
  return static_cast<double>(bits >> 11U) * 0x1.0p-53;
}

/// A number of mean 0 and variance 1 of random bits, nearly normally distributed (the sum of four
/// uniform ones; never beyond 3.5).
[[nodiscard]] constexpr float gaussian(std::uint64_t bits) noexcept {
  constexpr float kScale = 1.7320508F / 65536.0F;  // four of variance 1/12 each
  const auto sum = static_cast<float>((bits & 0xFFFFU) + ((bits >> 16U) & 0xFFFFU) +
                                      ((bits >> 32U) & 0xFFFFU) + (bits >> 48U));
  return (sum - 131070.0F) * kScale;
}

}  // namespace skyhalo

#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <initializer_list>

namespace skyhalo {

/// Two numbers stirred into one, so that neighbours have nothing in common (the last steps of
/// splitmix64, Steele et al. 2014).
[[nodiscard]] constexpr std::uint64_t stirred(std::uint64_t a, std::uint64_t b) noexcept {
  std::uint64_t x = a + 0x9e3779b97f4a7c15U * (b + 1);
  x = (x ^ (x >> 30U)) * 0xbf58476d1ce4e5b9U;
  x = (x ^ (x >> 27U)) * 0x94d049bb133111ebU;
  return x ^ (x >> 31U);
}

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

/// A number of mean 0 and variance 1 of random bits, nearly normally distributed (the sum of four
/// uniform ones; never beyond 3.5).
[[nodiscard]] constexpr float gaussian(std::uint64_t bits) noexcept {
  constexpr float kScale = 1.7320508F / 65536.0F;  // four of variance 1/12 each
  const auto sum = static_cast<float>((bits & 0xFFFFU) + ((bits >> 16U) & 0xFFFFU) +
                                      ((bits >> 32U) & 0xFFFFU) + (bits >> 48U));
  return (sum - 131070.0F) * kScale;
}

/// Random numbers that are the same with every compiler and library, other than those of the
/// standard's distributions.
class RandomNumbers {
 public:
  explicit RandomNumbers(std::uint64_t seed) noexcept : seed_(seed) {}

  /// 64 random bits.
  std::uint64_t bits() noexcept { return stirred(seed_, count_++); }

  /// In 0...1, without 1.
  float uniform() noexcept { return static_cast<float>(bits() >> 40U) * 0x1p-24F; }

  /// In `from`...`to`.
  float uniform(float from, float to) noexcept { return from + (to - from) * uniform(); }

  /// One of 0, 1, ..., n - 1; n > 0.
  int below(int n) noexcept { return static_cast<int>(bits() % static_cast<std::uint64_t>(n)); }

  /// True in a share of the cases.
  bool chance(float share) noexcept { return uniform() < share; }

  /// About normal with mean 0 and standard deviation 1, never beyond 3.5.
  float normal() noexcept {
    float sum = 0.0F;
    for (int i = 0; i < 4; ++i) {
      sum += uniform(-1.0F, 1.0F);
    }
    return sum * 0.8660254F;
  }

  /// Each coordinate about normal.
  Eigen::Vector3f normal_vector() noexcept {
    const float x = normal();
    const float y = normal();
    return {x, y, normal()};
  }

 private:
  std::uint64_t seed_;
  std::uint64_t count_ = 0;
};

}  // namespace skyhalo

// Prints a digest of what the matcher finds in made-up pairs: the same on every processor.
#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "skyhalo/stereo/sgm/engine.hpp"

namespace skyhalo::sgm {
namespace {

/// Numbers that look random; the same everywhere, which those of <random> need not be.
class Numbers {
 public:
  explicit Numbers(std::uint64_t seed) noexcept : state_(seed) {}

  /// In [0, end).
  int below(int end) noexcept {
    state_ = state_ * 6364136223846793005U + 1442695040888963407U;
    return static_cast<int>((state_ >> 33U) % static_cast<std::uint64_t>(end));
  }

 private:
  std::uint64_t state_;
};

/// FNV-1a over the bits of every disparity; NaN counts as one value.
std::uint64_t digest_of(const std::vector<float>& disparity_px) {
  std::uint64_t digest = 14695981039346656037U;
  for (const float d : disparity_px) {
    const std::uint32_t bits = d == d ? std::bit_cast<std::uint32_t>(d) : 0xFFFFFFFFU;
    for (unsigned byte = 0; byte < 4; ++byte) {
      digest = (digest ^ ((bits >> (8 * byte)) & 0xFFU)) * 1099511628211U;
    }
  }
  return digest;
}

/// A texture whose right view is shifted by steps of disparity from band to band, with noise and a
/// blank patch.
void print_case(int number) {
  Numbers numbers(static_cast<std::uint64_t>(number));
  const int disparities = 16 * (1 + numbers.below(number % 5 == 0 ? 16 : 4));
  const EngineSize size{disparities + 1 + numbers.below(90), 1 + numbers.below(90), disparities};
  const auto pixels =
      static_cast<std::size_t>(size.width_px) * static_cast<std::size_t>(size.height_px);
  std::vector<std::uint8_t> left(pixels);
  std::vector<std::uint8_t> right(pixels);
  std::generate(
      left.begin(), left.end(), [&] { return static_cast<std::uint8_t>(numbers.below(256)); });
  const int band = 1 + numbers.below(20);
  for (int v = 0; v < size.height_px; ++v) {
    const int shift = v / band * 7 % disparities;
    for (int u = 0; u < size.width_px; ++u) {
      const auto at = static_cast<std::size_t>(v * size.width_px + u);
      const bool blank = v > size.height_px / 2 && u < size.width_px / 3;
      const int level = u + shift < size.width_px ? left[at + static_cast<std::size_t>(shift)] : 0;
      right[at] = static_cast<std::uint8_t>(blank ? 90 : std::min(255, level + numbers.below(3)));
    }
  }
  std::vector<float> disparity_px(pixels);
  SerialExecutor executor;
  Engine engine({}, size);
  engine.match({{left.data(), size.width_px}, {right.data(), size.width_px}, number % 2 == 1},
               {disparity_px.data(), size.width_px},
               executor);
  const auto found =
      std::count_if(disparity_px.begin(), disparity_px.end(), [](float d) { return d == d; });
  std::printf("%d: %dx%dx%d, %d found, %016llx\n",
              number,
              size.width_px,
              size.height_px,
              disparities,
              static_cast<int>(found),
              static_cast<unsigned long long>(digest_of(disparity_px)));
}

}  // namespace
}  // namespace skyhalo::sgm

int main() {
  std::fprintf(stderr, "vectors of %d bytes\n", skyhalo::sgm::vector_lanes());
  for (int number = 0; number < 40; ++number) {
    skyhalo::sgm::print_case(number);
  }
  return EXIT_SUCCESS;
}

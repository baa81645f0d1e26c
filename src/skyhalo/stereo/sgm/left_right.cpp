#include "skyhalo/stereo/sgm/left_right.hpp"

#include <cstdlib>

namespace skyhalo::sgm {

void check_left_right(const WinnerColumns& winners,
                      int width,
                      int tolerance_64,
                      std::int16_t* disparity_64) noexcept {
  for (int u = 0; u < width; ++u) {
    const int offset = (winners.offset[u] ^ 0x80) - 0x80;  // as a signed byte
    const int disparity = winners.disparity[u];
    // Winners beyond the other image have no offset, but their column must be one that exists.
    const int left_u = u + disparity < width ? u + disparity : width - 1;
    const int found = 64 * disparity + offset;
    const int difference = std::abs(64 * winners.left_disparity[left_u] - found);
    const bool good = (offset != -128) & (difference <= tolerance_64) & (winners.confident[u] != 0);
    disparity_64[u] = static_cast<std::int16_t>(good ? found : -1);
  }
}

}  // namespace skyhalo::sgm

#pragma once

#include <cstdint>

namespace skyhalo::sgm {

/// One row of winners of the right image and what is known of them.
struct WinnerColumns {
  const std::uint8_t* disparity;       ///< px
  const std::uint8_t* offset;          ///< 1/64 px as a signed byte, -128 for none
  const std::uint8_t* left_disparity;  ///< the winners of the left image's pixels
  const std::uint8_t* confident;       ///< 0 where nothing can be told
};

/// Puts a row's winners together, in 1/64 px: -1 where there is none, where the left image's winner
/// differs by more than `tolerance_64`, and where it is not confident.
/// (Hirschmueller 2008, section 2.3: consistency check.)
void check_left_right(const WinnerColumns& winners,
                      int width,
                      int tolerance_64,
                      std::int16_t* disparity_64) noexcept;

}  // namespace skyhalo::sgm

#pragma once

#include <array>
#include <span>
#include <string_view>
#include <vector>

#include "skyhalo/camera/lens.hpp"

namespace skyhalo {

/// The word of our rig files for a lens's model.
[[nodiscard]] std::string_view lens_word(const Lens& lens) noexcept;

/// The numbers of our rig files for a lens's distortion; trailing zeros that mean nothing are left
/// out.
[[nodiscard]] std::vector<double> distortion_numbers(const Lens& lens);

/// The lens of a rig file's words and numbers. Throws `Error` (input) naming `lens`,
/// `intrinsics_px` or `distortion`.
[[nodiscard]] Lens make_lens(std::string_view word,
                             const Intrinsics& intrinsics,
                             std::span<const double> distortion);

}  // namespace skyhalo

#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "skyhalo/calibration/rotation_input.hpp"
#include "skyhalo/camera/lens.hpp"

namespace skyhalo {

/// The lens models that calibration files name, each in its own words.
enum class LensKind { kRadialTangential, kKannalaBrandt, kDoubleSphere, kExtendedUnified };

/// The numbers of a lens as a file gives them, and how to complain about them. Internal to this
/// layer.
struct LensInput {
  LensKind kind = LensKind::kRadialTangential;
  Intrinsics intrinsics;
  /// Radial-tangential: k1 k2 p1 p2 [k3 [k4 k5 k6]]; Kannala-Brandt: k1 k2 k3 k4; double sphere: xi
  /// alpha; extended unified: alpha beta.
  std::vector<double> distortion;
  ErrorAt intrinsics_at;
  ErrorAt distortion_at;
};

/// The lens. Throws `intrinsics_at` or `distortion_at` for what the model does not allow, and for a
/// wrong count of coefficients. Of 12 or 14 radial-tangential ones (thin prism, tilted sensor) the
/// last must be 0.
[[nodiscard]] Lens lens_from(const LensInput& input);

/// The numbers of a camera matrix, row by row: fx 0 cx, 0 fy cy, 0 0 1. Throws `error_at` for any
/// other and for any other count.
[[nodiscard]] Intrinsics intrinsics_from(std::span<const double> matrix, const ErrorAt& error_at);

/// No distortion at all, for `LensInput::distortion` of the radial-tangential kind.
[[nodiscard]] std::vector<double> no_distortion();

}  // namespace skyhalo

#include "skyhalo/calibration/lens_input.hpp"

#include <algorithm>
#include <array>

namespace skyhalo {
namespace {

constexpr std::size_t kRadialTangentialMost = 8;

Error wrong_count(const LensInput& input, std::string_view expected) {
  return input.distortion_at("expected " + std::string(expected) + " numbers, found " +
                             std::to_string(input.distortion.size()));
}

RadialTangentialLens::Distortion radial_tangential(const LensInput& input) {
  const std::vector<double>& given = input.distortion;
  constexpr std::array<std::size_t, 5> kCounts = {4, 5, 8, 12, 14};
  if (std::find(kCounts.begin(), kCounts.end(), given.size()) == kCounts.end()) {
    throw wrong_count(input, "4, 5 or 8");
  }
  const std::size_t used = std::min(given.size(), kRadialTangentialMost);
  const auto rest = given.begin() + static_cast<std::ptrdiff_t>(used);
  if (std::any_of(rest, given.end(), [](double value) { return value != 0.0; })) {
    throw input.distortion_at(
        "the coefficients after the eighth (thin prism, tilted sensor) are not supported; "
        "expected 4, 5 or 8 numbers, or zeros after the eighth, found " +
        std::to_string(given.size()) + " numbers");
  }
  RadialTangentialLens::Distortion distortion{};
  std::copy(given.begin(), rest, distortion.begin());
  return distortion;
}

/// The coefficients, of which there must be exactly `count`.
const std::vector<double>& exactly(std::size_t count, const LensInput& input) {
  if (input.distortion.size() != count) {
    throw wrong_count(input, std::to_string(count));
  }
  return input.distortion;
}

/// The lens's own complaint `intrinsics_px: ...` or `distortion: ...` about the file's key.
Error translated(const LensInput& input, const std::string& complaint) {
  constexpr std::string_view kAboutDistortion = "distortion: ";
  constexpr std::string_view kAboutIntrinsics = "intrinsics_px: ";
  if (complaint.starts_with(kAboutDistortion)) {
    return input.distortion_at(complaint.substr(kAboutDistortion.size()));
  }
  const bool named = complaint.starts_with(kAboutIntrinsics);
  return input.intrinsics_at(named ? complaint.substr(kAboutIntrinsics.size()) : complaint);
}

template <class Model, class Shape>
Lens built(const LensInput& input, const Shape& shape) {
  try {
    return Model(input.intrinsics, shape);
  } catch (const Error& error) {
    throw translated(input, error.what());
  }
}

}  // namespace

Intrinsics intrinsics_from(std::span<const double> matrix, const ErrorAt& error_at) {
  if (matrix.size() != 9) {
    throw error_at("expected 9 numbers, found " + std::to_string(matrix.size()));
  }
  const bool zeros = matrix[1] == 0.0 && matrix[3] == 0.0 && matrix[6] == 0.0 && matrix[7] == 0.0;
  if (!zeros || matrix[8] != 1.0) {
    throw error_at("expected fx 0 cx, 0 fy cy, 0 0 1");
  }
  return {matrix[0], matrix[4], matrix[2], matrix[5]};
}

std::vector<double> no_distortion() {
  return std::vector<double>(kRadialTangentialMost, 0.0);
}

Lens lens_from(const LensInput& input) {
  using Sphere = DoubleSphereLens::Shape;
  using Unified = ExtendedUnifiedLens::Shape;
  switch (input.kind) {
    case LensKind::kRadialTangential:
      return built<RadialTangentialLens>(input, radial_tangential(input));
    case LensKind::kKannalaBrandt: {
      const std::vector<double>& k = exactly(4, input);
      return built<KannalaBrandtLens>(input, KannalaBrandtLens::Distortion{k[0], k[1], k[2], k[3]});
    }
    case LensKind::kDoubleSphere: {
      const std::vector<double>& shape = exactly(2, input);
      return built<DoubleSphereLens>(input, Sphere{.xi = shape[0], .alpha = shape[1]});
    }
    case LensKind::kExtendedUnified: {
      const std::vector<double>& shape = exactly(2, input);
      return built<ExtendedUnifiedLens>(input, Unified{.alpha = shape[0], .beta = shape[1]});
    }
  }
  throw input.distortion_at("unknown lens model");
}

}  // namespace skyhalo

#pragma once

#include <optional>
#include <variant>

#include "skyhalo/camera/ask.hpp"
#include "skyhalo/camera/double_sphere_lens.hpp"
#include "skyhalo/camera/extended_unified_lens.hpp"
#include "skyhalo/camera/kannala_brandt_lens.hpp"
#include "skyhalo/camera/radial_tangential_lens.hpp"

namespace skyhalo {

/// The lens of a raw camera, in any of the models that calibrations come in.
using Lens =
    std::variant<RadialTangentialLens, KannalaBrandtLens, DoubleSphereLens, ExtendedUnifiedLens>;

/// Pixel of a point (any scale, raw camera frame: x right, y down, z forward); none outside the
/// lens's domain and for a point that is not finite.
[[nodiscard]] inline std::optional<Eigen::Vector2d> project(const Lens& lens,
                                                            const Eigen::Vector3d& point) noexcept {
  return ask(lens, [&](const auto& model) { return model.project(point); });
}

/// Derivative of `project`, where it has a value.
[[nodiscard]] inline std::optional<LensJacobian> jacobian(const Lens& lens,
                                                          const Eigen::Vector3d& point) noexcept {
  return ask(lens, [&](const auto& model) { return model.jacobian(point); });
}

/// Unit vector of the ray that a pixel sees; none when it lies outside the domain.
[[nodiscard]] inline std::optional<Eigen::Vector3d> unproject(
    const Lens& lens, const Eigen::Vector2d& pixel_px) noexcept {
  return ask(lens, [&](const auto& model) { return model.unproject(pixel_px); });
}

/// The lens images rays up to this angle from its optical axis.
[[nodiscard]] inline double max_angle_rad(const Lens& lens) noexcept {
  return ask(lens, [](const auto& model) { return model.max_angle_rad(); });
}

/// Focal lengths and principal point of the lens.
[[nodiscard]] inline const Intrinsics& intrinsics(const Lens& lens) noexcept {
  return ask(lens, [](const auto& model) -> const Intrinsics& { return model.intrinsics(); });
}

}  // namespace skyhalo

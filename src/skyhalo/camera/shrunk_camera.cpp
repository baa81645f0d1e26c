#include "skyhalo/camera/shrunk_camera.hpp"

#include <cstdint>
#include <type_traits>
#include <utility>

#include "skyhalo/base/whole_division.hpp"

namespace skyhalo {
namespace {

Intrinsics shrunk(const Intrinsics& lens, int factor) {
  const auto centre = [&](double c_px) { return (c_px + 0.5) / factor - 0.5; };
  return {.fx_px = lens.fx_px / factor,
          .fy_px = lens.fy_px / factor,
          .cx_px = centre(lens.cx_px),
          .cy_px = centre(lens.cy_px)};
}

/// The same lens with other intrinsics.
template <class Model>
Lens with_intrinsics(const Model& lens, const Intrinsics& intrinsics) {
  if constexpr (requires { lens.distortion(); }) {
    return Model(intrinsics, lens.distortion());
  } else {
    return Model(intrinsics, lens.shape());
  }
}

}  // namespace

RawCamera downscaled(const RawCamera& camera, int factor) {
  return {camera.size_px / factor, ask(camera.lens, [&](const auto& lens) {
            return with_intrinsics(lens, shrunk(lens.intrinsics(), factor));
          })};
}

cv::Rect downscaled(const cv::Rect& rectangle_px, int factor) noexcept {
  // Ends may be beyond an int, their shrunk lengths are not: a rectangle of no pixel stays one.
  const auto shrunk = [factor](int from, int length) {
    const std::int64_t first = floor_div(from, factor);
    const std::int64_t end = ceil_div(std::int64_t{from} + length, factor);
    return std::pair(static_cast<int>(first), length > 0 ? static_cast<int>(end - first) : 0);
  };
  const auto [x, width] = shrunk(rectangle_px.x, rectangle_px.width);
  const auto [y, height] = shrunk(rectangle_px.y, rectangle_px.height);
  return {x, y, width, height};
}

}  // namespace skyhalo

#include "skyhalo/camera/shrunk_camera.hpp"

#include <type_traits>

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

}  // namespace skyhalo

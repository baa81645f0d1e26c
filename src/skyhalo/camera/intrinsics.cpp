#include "skyhalo/camera/intrinsics.hpp"

#include <cmath>

#include "skyhalo/base/error.hpp"

namespace skyhalo {

void check(const Intrinsics& intrinsics) {
  const bool focal_ok = intrinsics.fx_px > 0.0 && intrinsics.fy_px > 0.0 &&
                        std::isfinite(intrinsics.fx_px) && std::isfinite(intrinsics.fy_px);
  if (!focal_ok || !std::isfinite(intrinsics.cx_px) || !std::isfinite(intrinsics.cy_px)) {
    throw Error(ErrorKind::kInput,
                "intrinsics_px: expected finite numbers, focal lengths above 0 px");
  }
}

}  // namespace skyhalo

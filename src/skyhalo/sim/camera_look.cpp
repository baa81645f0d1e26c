#include "skyhalo/sim/camera_look.hpp"

#include <cmath>
#include <string>

#include "skyhalo/base/error.hpp"

namespace skyhalo {
namespace {

void expect(bool holds, const char* what) {
  if (!holds) {
    throw Error(ErrorKind::kInput, std::string("camera: ") + what);
  }
}

}  // namespace

void check(const CameraLook& look) {
  const int n = look.samples;
  expect(n == 1 || n == 4 || n == 9 || n == 16, "samples: expected 1, 4, 9 or 16");
  expect(look.exposure_s >= 0.0 && look.exposure_s <= 1.0, "exposure_s: expected 0...1");
  expect(look.gain > 0.0 && std::isfinite(look.gain), "gain: expected more than 0");
  expect(look.vignetting >= 0.0 && look.vignetting <= 1.0, "vignetting: expected 0...1");
  expect(look.blur_px >= 0.0 && look.blur_px <= 50.0, "blur_px: expected 0...50");
  expect(look.white_electrons >= 0.0 && look.white_electrons <= 1e9,
         "white_electrons: expected 0...1e9");
  expect(look.read_electrons >= 0.0 && look.read_electrons <= 1e6,
         "read_electrons: expected 0...1e6");
}

}  // namespace skyhalo

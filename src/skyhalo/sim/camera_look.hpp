#pragma once

namespace skyhalo {

/// What a camera does to the light, beside its lens.
struct CameraLook {
  int samples = 4;                  ///< rays per pixel: 1, 4, 9 or 16
  double exposure_s = 0.002;        ///< how long a row gathers light; its stamp is in the middle
  double gain = 1.0;                ///< brightness to white, > 0
  double vignetting = 0.25;         ///< 0...1: share of light lost in the corners
  double blur_px = 0.4;             ///< standard deviation of the lens's blur, >= 0
  double white_electrons = 6000.0;  ///< of a white pixel, which makes its photon noise; 0: no noise
  double read_electrons = 12.0;     ///< standard deviation of the read noise
};

/// Throws `Error` (input) naming what is outside its domain.
void check(const CameraLook& look);

}  // namespace skyhalo

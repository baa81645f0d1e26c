#pragma once

namespace skyhalo::testing {

/// A room about the origin, 20 m wide, its floor at z = 0, as an OBJ file.
inline constexpr const char* kRoom =
    "v -10 -10 0\nv 10 -10 0\nv 10 10 0\nv -10 10 0\n"
    "v -10 -10 6\nv 10 -10 6\nv 10 10 6\nv -10 10 6\n"
    "f 1 2 3\nf 1 3 4\nf 1 2 6\nf 1 6 5\nf 2 3 7\nf 2 7 6\nf 3 4 8\nf 3 8 7\nf 4 1 5\nf 4 5 8\n";

/// One rectified pair of small images.
inline constexpr const char* kSmallRig =
    "rig: small\npairs:\n  - name: front\n    rectified:\n      size_px: [160, 120]\n"
    "      model: pinhole\n      focal_px: 100\n      principal_point_px: [79.5, 59.5]\n"
    "      baseline_m: 0.2\n    T_body_camera: {position_m: [0.1, -0.1, 0]}\n"
    "    downscale: 1\n    rcrop_px: 16\n";

}  // namespace skyhalo::testing

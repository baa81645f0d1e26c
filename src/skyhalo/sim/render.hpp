#pragma once

#include <cstdint>
#include <functional>
#include <opencv2/core/mat.hpp>

#include "skyhalo/geometry/pose.hpp"
#include "skyhalo/sim/camera_look.hpp"
#include "skyhalo/sim/camera_rays.hpp"
#include "skyhalo/sim/scene_tracer.hpp"
#include "skyhalo/sim/surface_colour.hpp"

namespace skyhalo {

/// Where something is at a time (s). Must be callable by several threads.
using PoseAtTime = std::function<Pose(double t_s)>;

/// How one picture is taken.
struct CameraShot {
  double stamp_s = 0.0;         ///< middle of the exposure of the middle row
  double line_time_s = 0.0;     ///< rolling shutter, from row to row; 0: all at once
  PoseAtTime T_scene_camera;    ///< the raw camera's way
  std::uint64_t noise_key = 0;  ///< another number, another noise
};

/// From the first light of the first row to the last light of the last one.
[[nodiscard]] TimeSpan exposed_span(int rows,
                                    const CameraShot& shot,
                                    const CameraLook& look) noexcept;

/// The picture of a camera: 8-bit BGR, black where the lens sees nothing. Rays are spread over each
/// pixel and over the time of its exposure; each row has the camera's pose at its own time. Then
/// come blur, vignetting, gain, photon and read noise. The same shot gives the same bits at any
/// number of threads. The moment's span must hold `exposed_span`.
[[nodiscard]] cv::Mat3b render(const SceneMoment& moment,
                               const SurfaceColour& colours,
                               const CameraRays& rays,
                               const CameraShot& shot,
                               const CameraLook& look);

}  // namespace skyhalo

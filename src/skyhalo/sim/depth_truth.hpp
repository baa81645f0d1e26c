#pragma once

#include <opencv2/core/mat.hpp>

#include "skyhalo/camera/pair_model.hpp"
#include "skyhalo/sim/render.hpp"
#include "skyhalo/sim/scene_tracer.hpp"

namespace skyhalo {

/// What the rectified right camera of a pair looks at, exactly: images of the pair's model, aligned
/// with the right one.
struct DepthTruth {
  cv::Mat1f range_m;       ///< along each pixel's ray; infinity where it meets nothing
  cv::Mat1f disparity_px;  ///< NaN where the pixel has no ray or meets nothing; see `both`
  cv::Mat1b both;          ///< 255 where the left camera sees the same point, too
};

/// The truth of a pair at one moment. `T_scene_camera` places the rectified right camera.
[[nodiscard]] DepthTruth depth_truth(const SceneMoment& moment,
                                     const PairModel& pair,
                                     const cv::Size& size_px,
                                     const Pose& T_scene_camera);

}  // namespace skyhalo

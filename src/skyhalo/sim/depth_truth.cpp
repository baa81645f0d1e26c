#include "skyhalo/sim/depth_truth.hpp"

#include <cmath>
#include <limits>
#include <vector>

#include "skyhalo/base/for_each_index.hpp"
#include "skyhalo/sim/pair_ray.hpp"

namespace skyhalo {
namespace {

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();

/// One row of the truth.
class TruthRow {
 public:
  TruthRow(const SceneMoment& moment, const PairModel& pair, const Pose& T_scene_camera)
      : moment_(moment),
        pair_(pair),
        T_scene_camera_(T_scene_camera),
        left_m_(T_scene_camera * Eigen::Vector3d(-baseline_m(pair), 0.0, 0.0)) {}

  void fill(int row, DepthTruth& truth) {
    const auto cols = static_cast<std::size_t>(truth.range_m.cols);
    rays_.resize(cols);
    hits_.resize(cols);
    for (std::size_t col = 0; col < cols; ++col) {
      const Eigen::Vector3d direction =
          ray_or_zero(pair_, {static_cast<double>(col), static_cast<double>(row)});
      rays_[col] = {T_scene_camera_.translation().cast<float>(),
                    (T_scene_camera_.linear() * direction).cast<float>(),
                    0.5F};
    }
    moment_.trace(rays_, hits_);
    for (std::size_t col = 0; col < cols; ++col) {
      enter(row, static_cast<int>(col), truth);
    }
    look_from_the_left(row, truth);
  }

 private:
  void enter(int row, int col, DepthTruth& truth) {
    const SceneHit& hit = hits_[static_cast<std::size_t>(col)];
    SceneRay& ray = rays_[static_cast<std::size_t>(col)];
    truth.range_m(row, col) = hit.range_m;
    truth.disparity_px(row, col) = kNone;
    truth.both(row, col) = 0;
    if (hit.object == SceneHit::kNothing) {
      ray.direction.setZero();
      return;
    }
    const Eigen::Vector3d point_m = static_cast<double>(hit.range_m) * ray_of(pair_, col, row);
    const double disparity_px = project(pair_, point_m).z();
    truth.disparity_px(row, col) = static_cast<float>(disparity_px);
    const double left_u_px = col + disparity_px;
    if (!(left_u_px >= 0.0 && left_u_px <= truth.range_m.cols - 1.0)) {  // beside the left image
      ray.direction.setZero();
      return;
    }
    const Eigen::Vector3d way_m = T_scene_camera_ * point_m - left_m_;
    ray = {left_m_.cast<float>(), (way_m / way_m.norm()).cast<float>(), 0.5F};
    ranges_from_left_m_.resize(rays_.size());
    ranges_from_left_m_[static_cast<std::size_t>(col)] = static_cast<float>(way_m.norm());
  }

  void look_from_the_left(int row, DepthTruth& truth) {
    constexpr float kTolerance = 1e-3F;  // share of the range: of rounding and slanted surfaces
    moment_.trace(rays_, hits_);
    for (std::size_t col = 0; col < rays_.size(); ++col) {
      if (!rays_[col].direction.isZero(0.0F)) {
        const float range_m = ranges_from_left_m_[col];
        const bool seen = hits_[col].range_m > range_m * (1.0F - kTolerance);
        truth.both(row, static_cast<int>(col)) = seen ? 255 : 0;
      }
    }
  }

  const SceneMoment& moment_;
  const PairModel& pair_;
  Pose T_scene_camera_;
  Eigen::Vector3d left_m_;  // the left camera, scene
  std::vector<SceneRay> rays_;
  std::vector<SceneHit> hits_;
  std::vector<float> ranges_from_left_m_;
};

}  // namespace

DepthTruth depth_truth(const SceneMoment& moment,
                       const PairModel& pair,
                       const cv::Size& size_px,
                       const Pose& T_scene_camera) {
  DepthTruth truth{cv::Mat1f(size_px), cv::Mat1f(size_px), cv::Mat1b(size_px)};
  for_each_index(static_cast<std::size_t>(size_px.height), [&](std::size_t row) {
    TruthRow(moment, pair, T_scene_camera).fill(static_cast<int>(row), truth);
  });
  return truth;
}

}  // namespace skyhalo

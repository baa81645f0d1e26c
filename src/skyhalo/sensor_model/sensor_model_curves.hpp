#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "skyhalo/camera/pair_model.hpp"
#include "skyhalo/sensor_model/inverse_sensor_model.hpp"

namespace skyhalo {

/// The inverse sensor model at one distance along the ray.
struct ModelSample {
  double m_m = 0.0;  ///< distance of the map cell
  double p = 0.0;    ///< probability that it is occupied
};

/// The inverse sensor model of one measurement (thesis eq. 6.4), sampled.
struct ModelCurve {
  double z_m = 0.0;                    ///< the measurement
  double delta_z_m = 0.0;              ///< its uncertainty (eq. 6.9; 6.10 with 6.11)
  double peak_probability = 0.0;       ///< at m = z: p_unknown + a (eq. 6.5)
  std::vector<ModelSample> samples{};  ///< m rises strictly, dense about z, and z is among them
};

/// The curves of the measurements (m, each above 0, finite) in their order. All end at the same m:
/// where the last of them has fallen to p_unknown, and at least a tenth behind the farthest.
[[nodiscard]] std::vector<ModelCurve> model_curves(const PairModel& pair,
                                                   const SensorModelConfig& config,
                                                   std::span<const double> z_m);

/// The range (m) from which a single measurement no longer lifts its cell to
/// `occupied_probability`: where the peak, p_unknown + a, falls to it. Infinite when p_unknown is
/// that high already; 0 when not even the nearest measurement does.
[[nodiscard]] double occupied_until_m(const PairModel& pair,
                                      const SensorModelConfig& config,
                                      double occupied_probability);

/// How uncertain the point is that a pixel of the central row sees (thesis eq. 4.2, 4.7).
struct UncertaintySample {
  double u_px = 0.0;     ///< column of the right image
  double d_px = 0.0;     ///< disparity
  double range_m = 0.0;  ///< distance of the point from the right camera
  Eigen::Vector3d delta_m = Eigen::Vector3d::Zero();  ///< per axis of `cam`

  /// Along the ray: a wrong disparity moves the point nowhere else.
  [[nodiscard]] double along_ray_m() const noexcept { return delta_m.norm(); }
};

/// The points that column u of the central row (v = v0) sees at the ranges (m, above 0), when the
/// disparity is wrong by `delta_d_px`. Empty for a column without a ray: |alpha| >= pi/2.
[[nodiscard]] std::vector<UncertaintySample> column_uncertainty(const PairModel& pair,
                                                                double u_px,
                                                                std::span<const double> ranges_m,
                                                                double delta_d_px);

}  // namespace skyhalo

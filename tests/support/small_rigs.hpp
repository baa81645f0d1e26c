#pragma once

#include <cmath>
#include <string>
#include <utility>

#include "skyhalo/calibration/rig_description.hpp"
#include "skyhalo/geometry/angle.hpp"

namespace skyhalo::testing {

/// A raw pair of 15 cm that looks ahead, its images matched as they are. The lens shows `hfov_rad`
/// across.
inline PairDescription raw_pair(const std::string& name,
                                const RawCamera& camera,
                                const VirtualPairWish& wish) {
  PairDescription pair{
      .name = name,
      .images = RawPairDescription{
          {camera, camera, make_pose(Eigen::Matrix3d::Identity(), {-0.15, 0.0, 0.0})}, wish}};
  pair.T_body_camera.linear() << 0.0, 0.0, 1.0, -1.0, 0.0, 0.0, 0.0, -1.0, 0.0;
  pair.downscale = 1;
  pair.rcrop_px = 64;
  return pair;
}

/// 640 x 360 pixels, 91 degrees across.
inline PairDescription pinhole_pair() {
  const double f_px = 320.0 / std::tan(rad_from_deg(45.5));
  return raw_pair("pinhole",
                  {{640, 360}, RadialTangentialLens({f_px, f_px, 319.5, 179.5}, {})},
                  {.model = PairModelKind::kPinhole,
                   .hfov_rad = rad_from_deg(91.0),
                   .size_px = cv::Size(640, 360)});
}

/// 640 x 360 pixels, 175 degrees across, warped to the spherical model.
inline PairDescription fisheye_pair() {
  const double f_px = 320.0 / rad_from_deg(87.5);
  return raw_pair("fisheye",
                  {{640, 360}, KannalaBrandtLens({f_px, f_px, 319.5, 179.5}, {})},
                  {.model = PairModelKind::kSpherical,
                   .hfov_rad = rad_from_deg(170.0),
                   .vfov_rad = rad_from_deg(95.0),
                   .size_px = cv::Size(640, 360)});
}

/// A rig of these pairs.
inline RigDescription rig_of(std::vector<PairDescription> pairs) {
  return {.name = "small", .T_body_imu = Pose::Identity(), .pairs = std::move(pairs)};
}

}  // namespace skyhalo::testing

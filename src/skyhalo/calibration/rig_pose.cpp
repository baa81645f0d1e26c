#include "skyhalo/calibration/rig_pose.hpp"

#include "skyhalo/calibration/yaml_geometry.hpp"
#include "skyhalo/geometry/angle.hpp"

namespace skyhalo {
namespace {

double angle_rad(const YamlValue& value, std::string_view key) {
  const std::optional<YamlValue> angle_deg = value.find(key);
  return angle_deg ? rad_from_deg(angle_deg->number()) : 0.0;
}

/// Throws for a place that is no vehicle's.
Pose checked(const Pose& T, const YamlValue& value) {
  constexpr double kFarthestM = 1000.0;
  if (!(T.translation().cwiseAbs().maxCoeff() <= kFarthestM)) {
    throw value.error("expected a place within 1000 m");
  }
  return T;
}

}  // namespace

Pose read_placement(const YamlValue& value,
                    const Eigen::Matrix3d& R_outer_inner,
                    std::vector<std::string>& warnings) {
  if (!value.is_map() || value.find("data")) {
    return checked(read_pose(value, warnings), value);
  }
  value.refuse_other_keys({"position_m", "yaw_deg", "pitch_deg", "roll_deg"});
  const std::vector<double> t_m = value.at("position_m").numbers(3);
  const Eigen::Matrix3d R =
      (Eigen::AngleAxisd(angle_rad(value, "yaw_deg"), Eigen::Vector3d::UnitZ()) *
       Eigen::AngleAxisd(angle_rad(value, "pitch_deg"), Eigen::Vector3d::UnitY()) *
       Eigen::AngleAxisd(angle_rad(value, "roll_deg"), Eigen::Vector3d::UnitX()))
          .toRotationMatrix();
  return checked(make_pose(R * R_outer_inner, {t_m[0], t_m[1], t_m[2]}), value);
}

}  // namespace skyhalo

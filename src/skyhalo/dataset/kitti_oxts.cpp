#include "skyhalo/dataset/kitti_oxts.hpp"

#include <array>
#include <cmath>
#include <string>

#include "skyhalo/base/error.hpp"
#include "skyhalo/geometry/angle.hpp"
#include "skyhalo/io/text_file.hpp"

namespace skyhalo {

InsReading read_oxts(const std::filesystem::path& file) {
  constexpr std::size_t kCount = 30;
  const std::vector<std::string> lines = read_lines(file);
  const std::vector<std::string_view> words =
      lines.empty() ? std::vector<std::string_view>() : split_words(lines.front());
  if (words.size() != kCount) {
    throw input_error(file, 1, "expected 30 numbers, found " + std::to_string(words.size()));
  }
  std::array<double, kCount> values{};
  for (std::size_t i = 0; i < kCount; ++i) {
    const std::optional<double> value = parse_number(words[i]);
    if (!value) {
      throw input_error(file,
                        1,
                        "value " + std::to_string(i + 1) + ": expected a finite number, found '" +
                            std::string(words[i]) + "'");
    }
    values.at(i) = *value;
  }
  if (std::abs(values[0]) >= 90.0) {
    throw input_error(file, 1, "value 1: expected a latitude in (-90, 90) degrees");
  }
  return {values[0], values[1], values[2], values[3], values[4], values[5]};
}

Pose T_enu_body(const InsReading& reading, double first_latitude_deg) {
  constexpr double kEarthRadiusM = 6378137.0;
  const double scale = std::cos(rad_from_deg(first_latitude_deg));
  const double east_m = scale * kEarthRadiusM * rad_from_deg(reading.longitude_deg);
  const double north_m =
      scale * kEarthRadiusM * std::log(std::tan(0.5 * rad_from_deg(90.0 + reading.latitude_deg)));
  const Eigen::Matrix3d R = (Eigen::AngleAxisd(reading.yaw_rad, Eigen::Vector3d::UnitZ()) *
                             Eigen::AngleAxisd(reading.pitch_rad, Eigen::Vector3d::UnitY()) *
                             Eigen::AngleAxisd(reading.roll_rad, Eigen::Vector3d::UnitX()))
                                .toRotationMatrix();
  return make_pose(R, {east_m, north_m, reading.altitude_m});
}

}  // namespace skyhalo

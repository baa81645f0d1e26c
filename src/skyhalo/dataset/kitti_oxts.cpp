#include "skyhalo/dataset/kitti_oxts.hpp"

#include <array>
#include <cmath>
#include <string>

#include "skyhalo/base/error.hpp"
#include "skyhalo/geometry/angle.hpp"
#include "skyhalo/io/text_file.hpp"

namespace skyhalo {
namespace {

constexpr double kEarthRadiusM = 6378137.0;

/// The reading of one line, of which the file has this number.
InsReading parse_oxts(const std::filesystem::path& file, int number, std::string_view line) {
  constexpr std::size_t kCount = 30;
  const std::vector<std::string_view> words = split_words(line);
  if (words.size() != kCount) {
    throw input_error(file, number, "expected 30 numbers, found " + std::to_string(words.size()));
  }
  std::array<double, kCount> values{};
  for (std::size_t i = 0; i < kCount; ++i) {
    const std::optional<double> value = parse_number(words[i]);
    if (!value) {
      throw input_error(file,
                        number,
                        "value " + std::to_string(i + 1) + ": expected a finite number, found '" +
                            std::string(words[i]) + "'");
    }
    values.at(i) = *value;
  }
  if (std::abs(values[0]) >= 90.0) {
    throw input_error(file, number, "value 1: expected a latitude in (-90, 90) degrees");
  }
  return {values[0], values[1], values[2], values[3], values[4], values[5]};
}

}  // namespace

InsReading read_oxts(const std::filesystem::path& file) {
  const std::vector<std::string> lines = read_lines(file);
  return parse_oxts(file, 1, lines.empty() ? std::string_view() : lines.front());
}

std::vector<InsReading> read_oxts_table(const std::filesystem::path& file) {
  std::vector<std::string> lines = read_lines(file);
  while (!lines.empty() && split_words(lines.back()).empty()) {
    lines.pop_back();
  }
  if (lines.empty()) {
    throw input_error(file, "holds no line; expected one of 30 numbers per frame");
  }
  std::vector<InsReading> readings;
  readings.reserve(lines.size());
  for (const std::string& line : lines) {
    readings.push_back(parse_oxts(file, static_cast<int>(readings.size()) + 1, line));
  }
  return readings;
}

Pose T_enu_body(const InsReading& reading, double first_latitude_deg) {
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

InsReading ins_reading(const Pose& T_enu_body, double first_latitude_deg) {
  const double scale = std::cos(rad_from_deg(first_latitude_deg));
  const Eigen::Vector3d scaled = T_enu_body.translation() / (scale * kEarthRadiusM);
  const Eigen::Matrix3d& R = T_enu_body.linear();
  const double across = std::hypot(R(0, 0), R(1, 0));
  const bool upright = across < 1e-9;
  return {.latitude_deg = 2.0 * deg_from_rad(std::atan(std::exp(scaled.y()))) - 90.0,
          .longitude_deg = deg_from_rad(scaled.x()),
          .altitude_m = T_enu_body.translation().z(),
          .roll_rad = upright ? 0.0 : std::atan2(R(2, 1), R(2, 2)),
          .pitch_rad = std::atan2(-R(2, 0), across),
          .yaw_rad = upright ? std::atan2(-R(0, 1), R(1, 1)) : std::atan2(R(1, 0), R(0, 0))};
}

std::vector<Pose> poses_of(std::span<const InsReading> readings) {
  std::vector<Pose> poses;
  Pose T_map_enu = Pose::Identity();
  for (const InsReading& reading : readings) {
    const double first_latitude_deg = readings.front().latitude_deg;
    if (poses.empty()) {
      T_map_enu = T_enu_body(reading, first_latitude_deg).inverse();
    }
    poses.push_back(T_map_enu * T_enu_body(reading, first_latitude_deg));
  }
  return poses;
}

}  // namespace skyhalo

#include "skyhalo/sim/trajectory_text.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "skyhalo/base/error.hpp"
#include "skyhalo/base/number_text.hpp"
#include "skyhalo/geometry/angle.hpp"
#include "skyhalo/sim/knot_curve.hpp"
#include "skyhalo/sim/number_table.hpp"
#include "skyhalo/sim/setting_range.hpp"
#include "skyhalo/sim/timed_flight.hpp"

namespace skyhalo {
namespace {

constexpr std::size_t kTumColumns = 8;
constexpr double kLargestNumber = 1e6;
constexpr double kShortestStepSeconds = 1e-6;
constexpr double kShortestQuaternion = 1e-6;

/// Where a CSV has its columns.
struct Columns {
  std::optional<std::size_t> time;
  std::array<std::optional<std::size_t>, 3> position;
  std::array<std::optional<std::size_t>, 3> angle;  ///< roll, pitch, yaw
};

std::optional<std::size_t> column(const NumberTable& table, std::string_view name) {
  const auto found = std::find(table.columns.begin(), table.columns.end(), name);
  return found == table.columns.end()
             ? std::nullopt
             : std::optional(static_cast<std::size_t>(found - table.columns.begin()));
}

Columns find_columns(const std::filesystem::path& file, const NumberTable& table) {
  const Columns columns = {
      .time = column(table, "t_s"),
      .position = {column(table, "x_m"), column(table, "y_m"), column(table, "z_m")},
      .angle = {column(table, "roll_deg"), column(table, "pitch_deg"), column(table, "yaw_deg")}};
  for (const auto& place : columns.position) {
    if (!place) {
      throw input_error(file, table.header_line, "the header needs x_m, y_m and z_m");
    }
  }
  const bool has_angle = std::any_of(columns.angle.begin(),
                                     columns.angle.end(),
                                     [](const auto& place) { return place.has_value(); });
  if (has_angle && !columns.time) {
    throw input_error(file,
                      table.header_line,
                      "angles need t_s: waypoints without times are flown with the attitude of "
                      "the motion");
  }
  return columns;
}

/// The numbers of a row's columns, 0 for those that are not there.
Eigen::Vector3d vector_of(const std::filesystem::path& file,
                          const NumberRow& row,
                          const std::array<std::optional<std::size_t>, 3>& columns) {
  Eigen::Vector3d values = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < columns.size(); ++i) {
    if (columns[i]) {
      values[static_cast<Eigen::Index>(i)] = row.values[*columns[i]];
    }
  }
  if (values.cwiseAbs().maxCoeff() > kLargestNumber) {
    throw input_error(file,
                      row.line,
                      "a position or an angle is " +
                          number_text("%g", values.cwiseAbs().maxCoeff()) +
                          ", expected at most 1000000");
  }
  return values;
}

/// The times of a column (s), from 0.
std::vector<double> times_of(const std::filesystem::path& file,
                             const NumberTable& table,
                             std::size_t column_index) {
  std::vector<double> times_s;
  for (const NumberRow& row : table.rows) {
    const double t_s = row.values[column_index] - table.rows.front().values[column_index];
    if (!std::isfinite(t_s) || (!times_s.empty() && t_s - times_s.back() < kShortestStepSeconds)) {
      throw input_error(file,
                        row.line,
                        "time " + number_text("%.9g", row.values[column_index]) +
                            " s is not after the one of the row before; times must increase, by a "
                            "microsecond or more");
    }
    times_s.push_back(t_s);
  }
  return times_s;
}

Eigen::Quaterniond quaternion_of(const std::filesystem::path& file, const NumberRow& row) {
  const Eigen::Quaterniond q(row.values[7], row.values[4], row.values[5], row.values[6]);
  if (!(q.norm() >= kShortestQuaternion && q.norm() <= kLargestNumber)) {
    throw input_error(
        file,
        row.line,
        "the quaternion's length is " + number_text("%g", q.norm()) + ", expected about 1");
  }
  return q.normalized();
}

/// Runs an action and puts the file before the message of an error.
template <typename Action>
Trajectory naming_file(const std::filesystem::path& file, Action&& action) {
  try {
    return action();
  } catch (const Error& error) {
    throw input_error(file, error.what());
  }
}

Trajectory tum_trajectory(const std::filesystem::path& file, const NumberTable& table) {
  const std::vector<double> times_s = times_of(file, table, 0);
  std::vector<Eigen::Vector3d> positions_m;
  std::vector<MotionSample> samples;
  for (const NumberRow& row : table.rows) {
    positions_m.push_back(vector_of(file, row, {1, 2, 3}));
    MotionSample sample;
    sample.T_map_body = make_pose(quaternion_of(file, row).toRotationMatrix(), positions_m.back());
    sample.t_s = times_s[samples.size()];
    samples.push_back(sample);
  }
  return naming_file(file, [&] {
    check_duration(times_s.back());
    const KnotCurve curve(times_s, positions_m);
    for (std::size_t i = 0; i < samples.size(); ++i) {
      samples[i].velocity_mps = curve.slopes()[i];
    }
    return Trajectory(std::move(samples));
  });
}

Trajectory timed_trajectory(const std::filesystem::path& file,
                            const NumberTable& table,
                            const Columns& columns,
                            const WaypointOptions& options) {
  TimedKnots knots;
  knots.times_s = times_of(file, table, *columns.time);
  for (const NumberRow& row : table.rows) {
    const Eigen::Vector3d angles_deg = vector_of(file, row, columns.angle);
    knots.positions_m.push_back(vector_of(file, row, columns.position));
    knots.angles_rad.emplace_back(
        angles_deg.unaryExpr([](double angle_deg) { return rad_from_deg(angle_deg); }));
  }
  knots.has_tilt = columns.angle[0] || columns.angle[1];
  knots.has_yaw = columns.angle[2].has_value();
  return naming_file(file, [&] { return fly_timed(knots, options.limits.yaw_rate_radps); });
}

Trajectory waypoint_trajectory(const std::filesystem::path& file,
                               const NumberTable& table,
                               const Columns& columns,
                               const WaypointOptions& options) {
  std::vector<Eigen::Vector3d> waypoints_m;
  for (const NumberRow& row : table.rows) {
    waypoints_m.push_back(vector_of(file, row, columns.position));
  }
  return naming_file(file,
                     [&] { return fly_waypoints(waypoints_m, options.limits, options.is_closed); });
}

}  // namespace

Trajectory read_trajectory(const std::filesystem::path& file, const WaypointOptions& options) {
  check_limits(options.limits);
  const NumberTable table =
      read_number_table(file,
                        {.names = {"t_s", "x_m", "y_m", "z_m", "yaw_deg", "roll_deg", "pitch_deg"},
                         .columns = kTumColumns});
  const bool has_header = !table.columns.empty();
  const Columns columns = has_header ? find_columns(file, table) : Columns{};
  if (table.rows.size() < 2) {
    throw input_error(
        file, "has " + std::to_string(table.rows.size()) + " rows of numbers, expected 2 or more");
  }
  if (!has_header) {
    return tum_trajectory(file, table);
  }
  return columns.time ? timed_trajectory(file, table, columns, options)
                      : waypoint_trajectory(file, table, columns, options);
}

}  // namespace skyhalo

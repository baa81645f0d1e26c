#include "skyhalo/sim/flight_plan.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "skyhalo/base/error.hpp"
#include "skyhalo/sim/random_numbers.hpp"
#include "skyhalo/sim/sampled_motion.hpp"
#include "skyhalo/sim/setting_range.hpp"
#include "skyhalo/sim/thrust_attitude.hpp"

namespace skyhalo {
namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;
constexpr double kGreatestAccelerationMps2 = 9.5;

constexpr std::array<std::pair<FlightKind, std::string_view>, 4> kKinds = {{
    {FlightKind::kWaypoints, "route"},
    {FlightKind::kHover, "hover"},
    {FlightKind::kOrbit, "orbit"},
    {FlightKind::kAggressive, "aggressive"},
}};

/// A sum of three slow sines that never leaves -1 to 1.
class Oscillation {
 public:
  explicit Oscillation(RandomNumbers& random) {
    for (std::size_t i = 0; i < kBands.size(); ++i) {
      rates_radps_[i] =
          kTurn *
          std::lerp(kBands[i].first, kBands[i].second, static_cast<double>(random.uniform()));
      phases_rad_[i] = kTurn * static_cast<double>(random.uniform());
    }
  }

  [[nodiscard]] double value(double t_s) const noexcept {
    double sum = 0.0;
    for (std::size_t i = 0; i < kBands.size(); ++i) {
      sum += kShares[i] * std::sin(rates_radps_[i] * t_s + phases_rad_[i]);
    }
    return sum;
  }

  [[nodiscard]] double slope(double t_s) const noexcept {
    double sum = 0.0;
    for (std::size_t i = 0; i < kBands.size(); ++i) {
      sum += kShares[i] * rates_radps_[i] * std::cos(rates_radps_[i] * t_s + phases_rad_[i]);
    }
    return sum;
  }

 private:
  static constexpr std::array<std::pair<double, double>, 3> kBands = {
      {{0.05, 0.15}, {0.15, 0.3}, {0.3, 0.6}}};  // Hz
  static constexpr std::array<double, 3> kShares = {0.5, 0.3, 0.2};

  std::array<double, 3> rates_radps_{};
  std::array<double, 3> phases_rad_{};
};

struct AxisOscillations {
  Oscillation x;
  Oscillation y;
  Oscillation z;

  explicit AxisOscillations(RandomNumbers& random) : x(random), y(random), z(random) {}

  [[nodiscard]] Eigen::Vector3d value(double t_s) const {
    return {x.value(t_s), y.value(t_s), z.value(t_s)};
  }

  [[nodiscard]] Eigen::Vector3d slope(double t_s) const {
    return {x.slope(t_s), y.slope(t_s), z.slope(t_s)};
  }
};

/// Samples, and with it the step, that end exactly at a duration.
std::size_t samples_for(double duration_s) {
  return static_cast<std::size_t>(std::max(1.0, std::ceil(duration_s / kMotionStepSeconds))) + 1;
}

void check_position(const Eigen::Vector3d& position_m) {
  for (const double coordinate_m : position_m) {
    check_setting(coordinate_m, {.name = "a coordinate (m)", .least = -1e6, .most = 1e6});
  }
}

}  // namespace

FlightLimits aggressive_limits() noexcept {
  return {.speed_mps = 12.0, .acceleration_mps2 = 9.0, .yaw_rate_radps = 3.0};
}

std::optional<FlightKind> flight_kind(std::string_view name) noexcept {
  for (const auto& [kind, known] : kKinds) {
    if (known == name) {
      return kind;
    }
  }
  return std::nullopt;
}

Trajectory fly_hover(const HoverSettings& settings) {
  check_position(settings.position_m);
  check_setting(settings.yaw_rad, {.name = "yaw_rad", .least = -1e3, .most = 1e3});
  check_setting(settings.wander_m, {.name = "wander_m", .least = 0.0, .most = 1.0});
  check_setting(settings.sway_rad, {.name = "sway_rad", .least = 0.0, .most = 0.5});
  check_setting(settings.duration_s,
                {.name = "duration_s", .least = 0.1, .most = kLongestMotionSeconds});
  RandomNumbers random(settings.seed);
  const AxisOscillations wander(random);
  const AxisOscillations sway(random);
  const double wander_m = settings.wander_m / std::numbers::sqrt3;
  const double tilt_rad = settings.sway_rad / std::numbers::sqrt2;
  std::vector<MotionSample> samples(samples_for(settings.duration_s));
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const double t_s =
        settings.duration_s * static_cast<double>(i) / static_cast<double>(samples.size() - 1);
    const Eigen::Vector3d angles = sway.value(t_s);
    const Eigen::AngleAxisd yaw(settings.yaw_rad + settings.sway_rad * angles.z(),
                                Eigen::Vector3d::UnitZ());
    const Eigen::AngleAxisd pitch(tilt_rad * angles.y(), Eigen::Vector3d::UnitY());
    const Eigen::AngleAxisd roll(tilt_rad * angles.x(), Eigen::Vector3d::UnitX());
    samples[i].T_map_body = make_pose((yaw * pitch * roll).toRotationMatrix(),
                                      settings.position_m + wander_m * wander.value(t_s));
    samples[i].velocity_mps = wander_m * wander.slope(t_s);
    samples[i].t_s = t_s;
  }
  return Trajectory(std::move(samples));
}

Trajectory fly_orbit(const OrbitSettings& settings) {
  check_position(settings.centre_m);
  check_setting(settings.radius_m, {.name = "radius_m", .least = 0.1, .most = 10'000.0});
  check_setting(settings.speed_mps, {.name = "speed_mps", .least = 0.05, .most = 50.0});
  check_setting(settings.turns, {.name = "turns", .least = 0.001, .most = 1e6});
  check_setting(
      settings.speed_mps * settings.speed_mps / settings.radius_m,
      {.name = "speed_mps^2 / radius_m", .least = 0.0, .most = kGreatestAccelerationMps2});
  const double sign = settings.is_clockwise ? -1.0 : 1.0;
  const double duration_s = kTurn * settings.turns * settings.radius_m / settings.speed_mps;
  check_duration(duration_s);
  const std::size_t count = samples_for(duration_s);
  SampledMotion motion;
  motion.step_s = duration_s / static_cast<double>(count - 1);
  std::vector<double> yaws;
  for (std::size_t i = 0; i < count; ++i) {
    const double angle =
        sign * kTurn * settings.turns * static_cast<double>(i) / static_cast<double>(count - 1);
    const Eigen::Vector3d out(std::cos(angle), std::sin(angle), 0.0);
    const Eigen::Vector3d along(-sign * out.y(), sign * out.x(), 0.0);
    motion.positions_m.emplace_back(settings.centre_m + settings.radius_m * out);
    motion.velocities_mps.emplace_back(settings.speed_mps * along);
    motion.accelerations_mps2.emplace_back(-settings.speed_mps * settings.speed_mps /
                                           settings.radius_m * out);
    yaws.push_back(settings.yaw == OrbitYaw::kAlongMotion ? angle + sign * kTurn / 4.0
                                                          : angle + kTurn / 2.0);
  }
  return banked_trajectory(motion, yaws);
}

Trajectory fly(const FlightPlan& plan) {
  switch (plan.kind) {
    case FlightKind::kHover:
      return fly_hover(plan.hover);
    case FlightKind::kOrbit:
      return fly_orbit(plan.orbit);
    case FlightKind::kAggressive:
      return fly_waypoints(plan.waypoints_m, aggressive_limits(), plan.is_closed);
    case FlightKind::kWaypoints:
      break;
  }
  return fly_waypoints(plan.waypoints_m, plan.limits, plan.is_closed);
}

}  // namespace skyhalo

#include "skyhalo/safety/velocity_limiter.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>

#include "skyhalo/base/error.hpp"
#include "skyhalo/geometry/pose.hpp"
#include "skyhalo/sphere/ball_way.hpp"

namespace skyhalo {
namespace {

/// Three walls at right angles, braked for at once, take the whole limit.
constexpr double kBrakeShare = 1.0 / std::numbers::sqrt3;

/// Limits may be exceeded by this, so that one may glide along a wall.
constexpr float kToleranceMps = 1e-3F;

constexpr int kNoCell = -1;

/// How many cells can push a velocity aside together.
constexpr std::size_t kMaxWalls = 12;

/// A velocity that exceeds a limit by so much does nothing but brake.
constexpr float kUrgentMps = 0.3F;

void require(bool holds, const char* key, const char* expected) {
  if (!holds) {
    throw Error(ErrorKind::kInput, "safety." + std::string(key) + ": expected " + expected);
  }
}

bool positive(double value) noexcept {
  return value > 0.0 && std::isfinite(value);
}

bool not_negative(double value) noexcept {
  return value >= 0.0 && std::isfinite(value);
}

/// The half-space that one cell allows: velocities `v . normal <= speed`.
struct Wall {
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();
  float speed_mps = 0.0F;
  float push_mps = 0.0F;  // how much of the normal is taken off the desired velocity
  int cell = kNoCell;
};

/// The velocity nearest to the desired one that all walls allow: Hildreth's method, one wall after
/// the other until none changes.
Eigen::Vector3f pushed_off(const Eigen::Vector3f& desired_mps, std::span<Wall> walls) noexcept {
  constexpr int kMaxRounds = 60;
  Eigen::Vector3f velocity_mps = desired_mps;
  for (const Wall& wall : walls) {
    velocity_mps -= wall.push_mps * wall.normal;
  }
  float change_mps = 1.0F;
  for (int round = 0; round < kMaxRounds && change_mps > 1e-5F; ++round) {
    change_mps = 0.0F;
    for (Wall& wall : walls) {
      const float excess_mps = velocity_mps.dot(wall.normal) - wall.speed_mps;
      const float push_mps = std::max(0.0F, wall.push_mps + excess_mps);
      velocity_mps -= (push_mps - wall.push_mps) * wall.normal;
      change_mps = std::max(change_mps, std::abs(push_mps - wall.push_mps));
      wall.push_mps = push_mps;
    }
  }
  return velocity_mps;
}

/// No vehicle is faster; squares of more leave single precision.
constexpr double kMaxSpeedMps = 1e4;

bool is_sound(const Motion& motion) noexcept {
  return motion.desired_mps.norm() <= kMaxSpeedMps && motion.velocity_mps.norm() <= kMaxSpeedMps &&
         motion.R_map_body.allFinite() && is_rotation(motion.R_map_body, 1e-3);
}

}  // namespace

void check(const SafetyConfig& config) {
  require(positive(config.radius_m), "radius_m", "a length above 0 m");
  require(not_negative(config.margin_m), "margin_m", "a length >= 0 m");
  require(positive(config.brake_mps2), "brake_mps2", "an acceleration above 0 m/s^2");
  require(
      positive(config.brake_vertical_mps2), "brake_vertical_mps2", "an acceleration above 0 m/s^2");
  require(not_negative(config.delay_s), "delay_s", "a time >= 0 s");
  require(not_negative(config.unseen_speed_mps), "unseen_speed_mps", "a speed >= 0 m/s");
  require(config.look_angle_rad >= 0.0 && config.look_angle_rad <= 0.5 * std::numbers::pi + 1e-9,
          "look_angle_deg",
          "an angle in 0...90 deg");
}

VelocityLimiter::VelocityLimiter(const SafetyConfig& config, const Halo& halo)
    : config_((check(config), config)), geometry_(halo.geometry()) {
  const auto count = static_cast<std::size_t>(geometry_.cell_count());
  const std::size_t padded = (count + kCellPadding - 1) / kCellPadding * kCellPadding;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    direction_[axis].resize(padded);
    for (std::size_t i = 0; i < count; ++i) {
      direction_[axis][i] = halo.directions()[i][static_cast<int>(axis)];
    }
  }
  for (PerCell* const numbers :
       {&depths_m_, &free_to_m_, &thing_speeds_mps_, &unseen_speeds_mps_, &both_speeds_mps_}) {
    numbers->resize(padded);
  }
}

VelocityLimit VelocityLimiter::limit(const Halo& halo, const Motion& motion) noexcept {
  if (!is_sound(motion) || halo.geometry().cell_count() != geometry_.cell_count()) {
    return {.reason = LimitReason::kInvalid};
  }
  const Eigen::Matrix3f R_body_map = motion.R_map_body.transpose().cast<float>();
  const Eigen::Vector3f up_body = R_body_map.col(2);
  const Eigen::Vector3f present_mps = R_body_map * motion.velocity_mps.cast<float>();
  const Eigen::Vector3f desired_mps = R_body_map * motion.desired_mps.cast<float>();
  if (desired_mps.norm() < kToleranceMps) {
    return {.velocity_mps = motion.desired_mps};
  }
  find_limits(halo, braking(up_body));

  VelocityLimit result;
  const auto blame = [&](int cell) {
    const auto at = static_cast<std::size_t>(cell);
    result.reason = thing_speeds_mps_[at] <= unseen_speeds_mps_[at] ? LimitReason::kObstacle
                                                                    : LimitReason::kUnseen;
    result.cell = GridCell{cell / geometry_.cols, cell % geometry_.cols};
  };
  Allowed allowed{desired_mps, kNoCell};
  if (config_.avoidance == Avoidance::kSlide) {
    allowed = allowed_nearest_to(desired_mps);
  }
  const CellValue excess = most_exceeded(directions(), speeds_mps(), present_mps);
  Eigen::Vector3f velocity_mps = allowed.velocity_mps;
  if (excess.value > kToleranceMps) {
    const float urgency = std::min(1.0F, excess.value / kUrgentMps);
    velocity_mps = braked_first(present_mps, velocity_mps, urgency);
  }
  const auto shorten = [&](const float* speeds, float least_mps) {
    const CellValue share = allowed_share(directions(), speeds, velocity_mps, least_mps);
    if (share.cell != kNoCell) {
      velocity_mps *= share.value;
      allowed.cell = share.cell;
    }
  };
  shorten(speeds_mps(), kToleranceMps);
  shorten(unseen_speeds_mps_.data(), least_look_mps(velocity_mps));
  if (turns_through_unseen(present_mps, velocity_mps)) {
    return {.reason = LimitReason::kTurn};
  }
  if (allowed.cell != kNoCell) {
    blame(allowed.cell);
  } else if ((velocity_mps - desired_mps).norm() > kToleranceMps) {
    blame(excess.cell);
  } else {
    return {.velocity_mps = motion.desired_mps};
  }
  const double length_mps = velocity_mps.cast<double>().norm();
  const double shortened = std::min(1.0, motion.desired_mps.norm() / std::max(length_mps, 1e-9));
  result.velocity_mps = shortened * (motion.R_map_body * velocity_mps.cast<double>());
  return result;
}

Braking VelocityLimiter::braking(const Eigen::Vector3f& up_body) const noexcept {
  const float least_unseen_mps = config_.unseen == UnseenPolicy::kBlock ? 0.0F
                                 : config_.unseen == UnseenPolicy::kSlow
                                     ? static_cast<float>(config_.unseen_speed_mps)
                                     : std::numeric_limits<float>::infinity();
  return {.up_body = up_body,
          .horizontal_mps2 = static_cast<float>(kBrakeShare * config_.brake_mps2),
          .vertical_mps2 = static_cast<float>(kBrakeShare * config_.brake_vertical_mps2),
          .delay_s = static_cast<float>(config_.delay_s),
          .keep_m = static_cast<float>(config_.radius_m + config_.margin_m),
          .cell_radius_rad = static_cast<float>(cell_radius_rad(geometry_)),
          .unseen_speed_mps = least_unseen_mps};
}

void VelocityLimiter::find_limits(const Halo& halo, const Braking& braking) noexcept {
  std::copy(halo.depths_m().begin(), halo.depths_m().end(), depths_m_.begin());
  std::copy(halo.free_to_m().begin(), halo.free_to_m().end(), free_to_m_.begin());
  find_speed_limits(directions(),
                    {depths_m_.data(), free_to_m_.data()},
                    braking,
                    {thing_speeds_mps_.data(), unseen_speeds_mps_.data()});
  const auto count = static_cast<std::ptrdiff_t>(geometry_.cell_count());
  for (PerCell* const speeds : {&thing_speeds_mps_, &unseen_speeds_mps_}) {
    std::fill(speeds->begin() + count, speeds->end(), std::numeric_limits<float>::infinity());
  }
  if (asks_all_round()) {
    std::transform(thing_speeds_mps_.begin(),
                   thing_speeds_mps_.end(),
                   unseen_speeds_mps_.begin(),
                   both_speeds_mps_.begin(),
                   [](float a, float b) { return std::min(a, b); });
  }
}

const float* VelocityLimiter::speeds_mps() const noexcept {
  return asks_all_round() ? both_speeds_mps_.data() : thing_speeds_mps_.data();
}

CellDirections VelocityLimiter::directions() const noexcept {
  return {direction_[0].data(), direction_[1].data(), direction_[2].data(), geometry_.cell_count()};
}

bool VelocityLimiter::asks_all_round() const noexcept {
  return config_.look_angle_rad >= 0.5 * std::numbers::pi - 1e-6;
}

VelocityLimiter::Allowed VelocityLimiter::allowed_nearest_to(
    const Eigen::Vector3f& wanted_mps) const noexcept {
  std::array<Wall, kMaxWalls> active;
  std::size_t count = 0;
  Eigen::Vector3f velocity_mps = wanted_mps;
  while (count < kMaxWalls) {
    const CellValue most = most_exceeded(directions(), speeds_mps(), velocity_mps);
    if (most.value <= 0.5F * kToleranceMps) {
      break;
    }
    const auto at = static_cast<std::size_t>(most.cell);
    active[count++] = {.normal = {direction_[0][at], direction_[1][at], direction_[2][at]},
                       .speed_mps = speeds_mps()[at],
                       .cell = most.cell};
    velocity_mps = pushed_off(wanted_mps, std::span(active).first(count));
  }
  const auto end = active.begin() + static_cast<std::ptrdiff_t>(count);
  const auto most = std::max_element(
      active.begin(), end, [](const Wall& a, const Wall& b) { return a.push_mps < b.push_mps; });
  return {velocity_mps, count > 0 ? most->cell : kNoCell};
}

Eigen::Vector3f VelocityLimiter::braked_first(const Eigen::Vector3f& present_mps,
                                              const Eigen::Vector3f& wanted_mps,
                                              float urgency) const noexcept {
  if (config_.avoidance == Avoidance::kStop) {
    const float turn = (present_mps.normalized() - wanted_mps.normalized()).norm();
    return (1.0F - urgency * std::min(1.0F, turn)) * wanted_mps;
  }
  const Eigen::Vector3f braked_mps = allowed_nearest_to(present_mps).velocity_mps;
  return wanted_mps + urgency * (braked_mps - wanted_mps);
}

float VelocityLimiter::least_look_mps(const Eigen::Vector3f& velocity_mps) const noexcept {
  const double angle_rad =
      std::min(config_.look_angle_rad + cell_radius_rad(geometry_), 0.5 * std::numbers::pi);
  return std::max(kToleranceMps, velocity_mps.norm() * static_cast<float>(std::cos(angle_rad)));
}

bool VelocityLimiter::turns_through_unseen(const Eigen::Vector3f& from_mps,
                                           const Eigen::Vector3f& to_mps) const noexcept {
  if (asks_all_round() || config_.unseen == UnseenPolicy::kAllow) {
    return false;  // what is allowed has no dents: all between two allowed velocities is, too
  }
  const float speed_mps = std::min(from_mps.norm(), to_mps.norm());
  for (const float share : {0.25F, 0.5F, 0.75F}) {
    const Eigen::Vector3f between_mps = from_mps + share * (to_mps - from_mps);
    const float length_mps = between_mps.norm();
    if (length_mps < kToleranceMps || speed_mps < kToleranceMps) {
      continue;
    }
    const Eigen::Vector3f tried_mps = std::min(1.0F, speed_mps / length_mps) * between_mps;
    const CellValue allowed = allowed_share(
        directions(), unseen_speeds_mps_.data(), tried_mps, least_look_mps(tried_mps));
    if (allowed.value < 0.5F) {
      return true;
    }
  }
  return false;
}

}  // namespace skyhalo

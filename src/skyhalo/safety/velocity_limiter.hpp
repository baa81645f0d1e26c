#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <numbers>
#include <optional>
#include <vector>

#include "skyhalo/safety/speed_limits.hpp"
#include "skyhalo/sphere/halo.hpp"

namespace skyhalo {

/// What to do where nothing was seen.
enum class UnseenPolicy : std::uint8_t {
  kBlock,  ///< as if there were something
  kSlow,   ///< come nearer at `unseen_speed_mps` at most
  kAllow,  ///< as if it were free
};

/// What to do about things in the way.
enum class Avoidance : std::uint8_t {
  kSlide,  ///< the allowed velocity that is nearest to the desired one: along a wall
  kStop,   ///< keep the direction, slower
};

/// What the vehicle can do, and what is wanted of it.
struct SafetyConfig {
  double radius_m = 0.5;    ///< of a ball about the body origin that holds the vehicle, > 0
  double margin_m = 0.2;    ///< kept besides the radius, >= 0
  double brake_mps2 = 3.0;  ///< braking limit of the horizontal velocity, > 0
  double brake_vertical_mps2 = 2.0;  ///< of the vertical one, > 0
  double delay_s = 0.3;              ///< from the images until a command takes effect, >= 0
  UnseenPolicy unseen = UnseenPolicy::kBlock;
  double unseen_speed_mps = 0.5;  ///< for `kSlow`, >= 0
  /// About the direction of travel: what is unseen farther aside does not hinder. A quarter turn
  /// asks for everything that the vehicle comes nearer to, which takes cameras all round.
  double look_angle_rad = std::numbers::pi / 6.0;
  Avoidance avoidance = Avoidance::kSlide;
};

/// Throws `Error` (input) naming the key of section `safety` that is outside its domain.
void check(const SafetyConfig& config);

/// The vehicle's motion; velocities in the map frame (m/s).
struct Motion {
  Eigen::Vector3d desired_mps = Eigen::Vector3d::Zero();   ///< what is commanded
  Eigen::Vector3d velocity_mps = Eigen::Vector3d::Zero();  ///< the present one
  Eigen::Matrix3d R_map_body = Eigen::Matrix3d::Identity();
};

/// Why a velocity is not the desired one.
enum class LimitReason : std::uint8_t {
  kNone,      ///< it is
  kObstacle,  ///< something was seen there
  kUnseen,    ///< nothing was seen there
  kTurn,      ///< the turn from the present velocity would pass through what is unseen: stop first
  kInvalid,   ///< the motion is not finite, or faster than 10 km/s: stop
};

/// A velocity that still can stop in time.
struct VelocityLimit {
  Eigen::Vector3d velocity_mps = Eigen::Vector3d::Zero();  ///< map frame, never longer than desired
  LimitReason reason = LimitReason::kNone;
  std::optional<GridCell> cell = {};  ///< the halo's cell that limits most, where one does
};

/// Limits velocities by what a halo knows, and by nothing else: it remembers nothing. For each
/// thing the speed of approach is at most what `delay_s` and then braking can bring to a halt
/// before the vehicle's ball, margin included, touches it. As the vehicle may have to brake for
/// three walls at right angles at once, each gets its share of the braking limit; and while the
/// present velocity exceeds a limit, braking goes before turning. A thing may be anywhere in its
/// cell. Owns its memory; not for use by two threads at once.
class VelocityLimiter {
 public:
  /// For halos of this geometry. Throws `Error` (input) when the config is outside its domain.
  VelocityLimiter(const SafetyConfig& config, const Halo& halo);

  /// The velocity to command. Does not allocate.
  [[nodiscard]] VelocityLimit limit(const Halo& halo, const Motion& motion) noexcept;

 private:
  /// A velocity within the limits.
  struct Allowed {
    Eigen::Vector3f velocity_mps;
    int cell;  // that pushes most; -1 for none
  };

  [[nodiscard]] Braking braking(const Eigen::Vector3f& up_body) const noexcept;
  void find_limits(const Halo& halo, const Braking& braking) noexcept;
  [[nodiscard]] CellDirections directions() const noexcept;
  [[nodiscard]] bool asks_all_round() const noexcept;
  /// What a velocity is pushed off: things, and the unseen where all is asked for.
  [[nodiscard]] const float* speeds_mps() const noexcept;
  [[nodiscard]] Allowed allowed_nearest_to(const Eigen::Vector3f& wanted_mps) const noexcept;
  [[nodiscard]] Eigen::Vector3f braked_first(const Eigen::Vector3f& present_mps,
                                             const Eigen::Vector3f& wanted_mps,
                                             float urgency) const noexcept;
  [[nodiscard]] float least_look_mps(const Eigen::Vector3f& velocity_mps) const noexcept;
  [[nodiscard]] bool turns_through_unseen(const Eigen::Vector3f& from_mps,
                                          const Eigen::Vector3f& to_mps) const noexcept;

  /// An entry per cell, and padding.
  using PerCell = std::vector<float>;

  SafetyConfig config_;
  GridGeometry geometry_;
  std::array<PerCell, 3> direction_;  // x, y, z, body; zero in the padding
  PerCell depths_m_;
  PerCell free_to_m_;
  PerCell thing_speeds_mps_;   // towards the cell at most, for what was seen in it
  PerCell unseen_speeds_mps_;  // and for what was not
  PerCell both_speeds_mps_;    // the smaller of the two, where all is asked for
};

}  // namespace skyhalo

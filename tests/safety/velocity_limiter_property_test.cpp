// Flights through random worlds. A violation names the seed of its world; with it in the
// environment variable SKYHALO_FIRST_SEED the world is flown again, as the first one.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <deque>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <numbers>
#include <optional>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "skyhalo/geometry/angle.hpp"
#include "skyhalo/safety/velocity_limiter.hpp"
#include "support/ball_world.hpp"
#include "support/sanitised.hpp"

namespace skyhalo {
namespace {

using testing::BallWorld;
using testing::HaloCaster;
using testing::random_direction;
using testing::Thing;
using testing::uniform;
using testing::View;
using testing::Wall;

constexpr double kStepS = 0.005;
constexpr int kStepsPerFrame = 20;
constexpr double kPeriodS = kStepsPerFrame * kStepS;
constexpr int kFrames = 150;
constexpr double kMaxSpeedMps = 6.0;

/// A kind of flight; what is not said here is random.
struct Kind {
  View view = {};
  UnseenPolicy unseen = UnseenPolicy::kBlock;
  double look_angle_rad = SafetyConfig{}.look_angle_rad;
  int without_texture = 0;       ///< so many things at most
  bool wide = false;             ///< nothing but some walls that lean
  bool brakes_straight = false;  ///< see `Drone`
};

/// Follows the latest command within its braking limits. Each of the horizontal and the vertical
/// velocity goes there on its own; or else both so that they arrive together.
struct Drone {
  Eigen::Vector3d p_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d v_mps = Eigen::Vector3d::Zero();
  bool brakes_straight = false;

  void move(const SafetyConfig& limits, const Eigen::Vector3d& command_mps) {
    const Eigen::Vector3d wanted = command_mps - v_mps;
    double across = std::min(1.0, limits.brake_mps2 * kStepS / wanted.head<2>().norm());
    double up = std::min(1.0, limits.brake_vertical_mps2 * kStepS / std::abs(wanted.z()));
    if (brakes_straight) {
      across = up = std::min(across, up);
    }
    const Eigen::Vector3d before = v_mps;
    v_mps.head<2>() += across * wanted.head<2>();
    v_mps.z() += up * wanted.z();
    p_m += 0.5 * kStepS * (before + v_mps);
  }
};

/// Turns with a rate that changes now and then, and rolls and pitches meanwhile; or holds still.
class Attitude {
 public:
  explicit Attitude(std::mt19937& random) : random_(random) {
    holds_ = uniform(random, 0.0, 1.0) < 0.25;
    yaw_rad_ = uniform(random, -std::numbers::pi, std::numbers::pi);
    for (std::size_t i = 0; i < 2; ++i) {
      swing_rad_[i] = uniform(random, 0.0, rad_from_deg(20.0));
      swing_hz_[i] = uniform(random, 0.05, 0.5);
    }
  }

  Eigen::Matrix3d at(double time_s) {
    if (!holds_ && time_s >= next_s_) {
      rate_rad_s_ = uniform(random_, 0.0, 1.0) < 0.4 ? 0.0 : uniform(random_, -1.5, 1.5);
      next_s_ = time_s + uniform(random_, 0.5, 4.0);
    }
    yaw_rad_ += holds_ ? 0.0 : rate_rad_s_ * kPeriodS;
    const double t = holds_ ? 1.0 : time_s;
    const double pitch_rad = swing_rad_[0] * std::sin(2.0 * std::numbers::pi * swing_hz_[0] * t);
    const double roll_rad = swing_rad_[1] * std::sin(2.0 * std::numbers::pi * swing_hz_[1] * t);
    return (Eigen::AngleAxisd(yaw_rad_, Eigen::Vector3d::UnitZ()) *
            Eigen::AngleAxisd(pitch_rad, Eigen::Vector3d::UnitY()) *
            Eigen::AngleAxisd(roll_rad, Eigen::Vector3d::UnitX()))
        .toRotationMatrix();
  }

 private:
  std::mt19937& random_;
  bool holds_ = false;
  double yaw_rad_ = 0.0;
  double rate_rad_s_ = 0.0;
  double next_s_ = 0.0;
  std::array<double, 2> swing_rad_{};
  std::array<double, 2> swing_hz_{};
};

/// A careless pilot, who follows the nose at least so often.
class Pilot {
 public:
  Pilot(std::mt19937& random, double nose_share) : random_(random), nose_share_(nose_share) {}

  Eigen::Vector3d desired_mps(double time_s,
                              const Drone& drone,
                              const Eigen::Matrix3d& R_map_body,
                              const BallWorld& world) {
    if (time_s >= next_s_) {
      whim_ = uniform(random_, 0.0, 1.0) < nose_share_
                  ? 4
                  : static_cast<int>(uniform(random_, 0.0, 8.0));
      speed_mps_ = uniform(random_, 0.3, kMaxSpeedMps);
      way_ = random_direction(random_);
      turn_s_ = uniform(random_, 0.1, 2.0);
      next_s_ = time_s + uniform(random_, 0.5, 3.0);
    }
    const std::vector<Eigen::Vector3d> near = to_nearest(drone.p_m, world);
    const Eigen::Vector3d along = way_ - way_.dot(near[0]) * near[0];
    const double sign = std::fmod(time_s, 2.0 * turn_s_) < turn_s_ ? 1.0 : -1.0;
    switch (whim_) {
      case 0:  // straight at the nearest thing
        return speed_mps_ * near[0];
      case 1:  // along it, a little too near
        return speed_mps_ * (0.2 * near[0] + along).normalized();
      case 2:  // into a corner
        return speed_mps_ * (near[0] + near[1] + near[2] + 0.01 * way_).normalized();
      case 3:  // back and forth
        return sign * speed_mps_ * way_;
      case 4:  // where the nose points
        return speed_mps_ * (R_map_body.col(0) + 0.2 * way_).normalized();
      case 5:  // level
        return speed_mps_ * Eigen::Vector3d(way_.x(), way_.y(), 0.0);
      case 6:  // in zigzag at the nearest thing
        return speed_mps_ * (0.7 * near[0] + sign * along.normalized()).normalized();
      default:
        return speed_mps_ * way_;
    }
  }

 private:
  /// Unit vectors to the nearest things, three of them at least.
  static std::vector<Eigen::Vector3d> to_nearest(const Eigen::Vector3d& p_m,
                                                 const BallWorld& world) {
    std::vector<Eigen::Vector3d> to;
    for (const Thing& thing : world) {
      to.emplace_back(nearest_point(thing, p_m) - p_m);
    }
    while (to.size() < 3) {
      to.emplace_back(10.0 * Eigen::Vector3d::Unit(static_cast<int>(to.size())));
    }
    std::partial_sort(to.begin(), to.begin() + 3, to.end(), [](const auto& a, const auto& b) {
      return a.squaredNorm() < b.squaredNorm();
    });
    std::for_each(to.begin(), to.begin() + 3, [](Eigen::Vector3d& v) { v.normalize(); });
    return to;
  }

  std::mt19937& random_;
  double nose_share_;
  int whim_ = 0;
  double speed_mps_ = 0.0;
  double next_s_ = 0.0;
  double turn_s_ = 1.0;
  Eigen::Vector3d way_ = Eigen::Vector3d::UnitX();
};

/// Vehicle, world and what the cameras saw of it last.
struct Flight {
  SafetyConfig config;
  View view;
  BallWorld world;
  Drone drone;
  Eigen::Matrix3d R_map_body = Eigen::Matrix3d::Identity();
  Eigen::Vector3d desired_mps = Eigen::Vector3d::Zero();
  VelocityLimit limit = {};
  const HaloCaster* eyes = nullptr;
  int step = 0;

  [[nodiscard]] double time_s() const { return step * kStepS; }

  [[nodiscard]] const Halo& halo() const { return eyes->halo(); }

  [[nodiscard]] double half_diagonal_rad() const {
    return halo().geometry().theta_step_rad / std::numbers::sqrt2;
  }

  /// In any direction: the header's share for each of three walls.
  [[nodiscard]] double share_mps2() const {
    return std::min(config.brake_mps2, config.brake_vertical_mps2) / std::numbers::sqrt3;
  }

  /// How much faster it can get by commands that are on their way.
  [[nodiscard]] double still_coming_mps() const {
    return (config.delay_s - kPeriodS) * std::hypot(config.brake_mps2, config.brake_vertical_mps2);
  }
};

/// What a flight must keep to, asked at each frame (after the limiter) and at each step; says what
/// is wrong, or nothing.
struct Rule {
  virtual ~Rule() = default;
  Rule() = default;
  Rule(const Rule&) = delete;
  Rule& operator=(const Rule&) = delete;
  Rule(Rule&&) = delete;
  Rule& operator=(Rule&&) = delete;

  virtual std::string at_frame(const Flight& /*flight*/) { return {}; }

  virtual std::string at_step(const Flight& /*flight*/) { return {}; }
};

/// The answer is finite, not longer than the desired velocity and, for `kStop`, along it.
struct AnswersInItsLimits : Rule {
  std::string at_frame(const Flight& flight) override {
    const Eigen::Vector3d& answer = flight.limit.velocity_mps;
    const Eigen::Vector3d& desired = flight.desired_mps;
    if (!answer.allFinite()) {
      return "the answer is not finite";
    }
    if (answer.norm() > desired.norm() * (1.0 + 1e-6)) {
      return "the answer is longer than the desired velocity";
    }
    if ((flight.limit.reason == LimitReason::kNone) != (answer == desired)) {
      return "the answer is the desired velocity, or gives a reason why not: not so";
    }
    const bool along = answer.cross(desired).norm() < 1e-5 * desired.squaredNorm() + 1e-9 &&
                       answer.dot(desired) >= 0.0;
    return flight.config.avoidance == Avoidance::kStop && !along ? "kStop: not along the desired"
                                                                 : "";
  }
};

struct KeepsClear : Rule {
  bool of_all = false;  ///< of what has no texture, too

  std::string at_step(const Flight& flight) override {
    for (std::size_t i = 0; i < flight.world.size(); ++i) {
      const double clear_m = distance_m(flight.world[i], flight.drone.p_m);
      if ((of_all || flight.world[i].textured) && clear_m < flight.config.radius_m) {
        std::ostringstream what;
        what << "thing " << i << " is " << flight.config.radius_m - clear_m << " m inside";
        return what.str();
      }
    }
    return {};
  }
};

/// The centre stays where some halo found it free.
struct StaysInSeenSpace : Rule {
  struct Sighting {
    Eigen::Vector3d p_m;
    Eigen::Matrix3d R_map_body;
    std::vector<float> free_to_m;
  };

  std::vector<Sighting> sightings;

  std::string at_frame(const Flight& flight) override {
    const auto free_to_m = flight.halo().free_to_m();
    sightings.push_back(
        {flight.drone.p_m, flight.R_map_body, {free_to_m.begin(), free_to_m.end()}});
    return {};
  }

  std::string at_step(const Flight& flight) override {
    const Eigen::Vector3d& p_m = flight.drone.p_m;
    const auto found_free = [&](const Sighting& sighting) {
      const SphericalPoint at =
          to_spherical(sighting.R_map_body.transpose() * (p_m - sighting.p_m));
      const GridGeometry& grid = flight.halo().geometry();
      const std::optional<GridCell> cell = grid.cell_of(at.theta_rad, at.phi_rad);
      return cell &&
             sighting.free_to_m[static_cast<std::size_t>(grid.offset_of(*cell))] >= at.rho_m - 1e-4;
    };
    const bool seen = p_m.norm() <= flight.config.radius_m ||
                      std::any_of(sightings.rbegin(), sightings.rend(), found_free);
    return seen ? "" : "in space that was not seen to be free";
  }
};

/// Comes nowhere nearer than its radius to a point that stayed in view since there was time to
/// stop.
struct KeepsClearOfTheView : Rule {
  std::map<std::array<int, 3>, Eigen::Vector3d> points_m;  // one for each 0.2 m
  std::vector<Eigen::Vector3d> near_m;                     // those it can come to in a frame

  static double braking_m(const Flight& flight, double speed_mps) {
    return speed_mps * flight.config.delay_s + speed_mps * speed_mps / (2.0 * flight.share_mps2());
  }

  static bool is_in_sight(const Flight& flight, const Eigen::Vector3d& point_m) {
    const SphericalPoint at =
        to_spherical(flight.R_map_body.transpose() * (point_m - flight.drone.p_m));
    const auto cell = flight.halo().geometry().cell_of(at.theta_rad, at.phi_rad);
    const auto depth_m = cell ? flight.halo().depth_m(*cell) : std::nullopt;
    return depth_m && *depth_m > 0.9 * at.rho_m - 0.1;
  }

  std::string at_frame(const Flight& flight) override {
    std::erase_if(points_m, [&](const auto& at) { return !is_in_sight(flight, at.second); });
    for (const Eigen::Vector3d& point_m : flight.eyes->points_map_m()) {
      const Eigen::Vector3d to_m = point_m - flight.drone.p_m;
      const double room_m = to_m.norm() * (1.0 - flight.half_diagonal_rad()) -
                            flight.config.radius_m - flight.config.margin_m;
      const double approach_mps = flight.drone.v_mps.dot(to_m.normalized());
      if (room_m < 5.0 &&
          braking_m(flight, std::max(0.0, approach_mps) + flight.still_coming_mps()) < room_m) {
        const Eigen::Array3i at = (5.0 * point_m).array().floor().cast<int>();
        points_m.try_emplace({at.x(), at.y(), at.z()}, point_m);
      }
    }
    near_m.clear();
    for (const auto& [at, point_m] : points_m) {
      if ((point_m - flight.drone.p_m).norm() < flight.config.radius_m + 1.5) {
        near_m.push_back(point_m);
      }
    }
    return {};
  }

  std::string at_step(const Flight& flight) override {
    for (const Eigen::Vector3d& point_m : near_m) {
      const double clear_m = (point_m - flight.drone.p_m).norm();
      if (clear_m < flight.config.radius_m) {
        std::ostringstream what;
        what << "a point in view is " << flight.config.radius_m - clear_m << " m inside";
        return what.str();
      }
    }
    return {};
  }
};

/// Approaches what is unseen, as far aside as it looks, no faster than `unseen_speed_mps`; after
/// the time it takes to brake.
struct ApproachesTheUnseenSlowly : Rule {
  struct Watched {
    Eigen::Vector3d direction;  // map
    Eigen::Vector3d cell;       // middle of its cell, map
    bool unseen = false;
    double from_s = -1.0;  // when it has to be slow; negative: it is not ahead
  };

  std::vector<Watched> watched;

  ApproachesTheUnseenSlowly() {
    constexpr int kCount = 400;
    for (int i = 0; i < kCount; ++i) {
      watched.push_back(
          {.direction = direction(std::acos(1.0 - (2.0 * i + 1.0) / kCount), 2.399963229728653 * i),
           .cell = Eigen::Vector3d::Zero()});
    }
  }

  std::string at_frame(const Flight& flight) override {
    const GridGeometry& grid = flight.halo().geometry();
    for (Watched& at : watched) {
      const SphericalPoint body = to_spherical(flight.R_map_body.transpose() * at.direction);
      const GridCell cell = grid.cell_of(body.theta_rad, body.phi_rad).value();
      at.unseen = flight.halo().sight(cell) == Sight::kUnseen;
      at.cell = flight.R_map_body * grid.center_direction(cell);
    }
    return at_each_unseen(flight.limit.velocity_mps, flight, [&](Watched&, double approach_mps) {
      return approach_mps > flight.config.unseen_speed_mps + 1e-3;
    });
  }

  std::string at_step(const Flight& flight) override {
    return at_each_unseen(flight.drone.v_mps, flight, [&](Watched& at, double approach_mps) {
      if (at.from_s < 0.0) {
        const double excess_mps = std::max(
            0.0, approach_mps + flight.still_coming_mps() - flight.config.unseen_speed_mps);
        at.from_s =
            flight.time_s() + flight.config.delay_s + kPeriodS + excess_mps / flight.share_mps2();
      }
      // Two slow velocities at right angles are on the way from one to the other.
      const double between = flight.drone.brakes_straight ? 1.0 : std::numbers::sqrt2;
      return flight.time_s() > at.from_s &&
             approach_mps > 1.05 * between * flight.config.unseen_speed_mps + 0.02;
    });
  }

 private:
  template <class IsTooFast>
  std::string at_each_unseen(const Eigen::Vector3d& v_mps,
                             const Flight& flight,
                             const IsTooFast& is_too_fast) {
    const double cosine = std::cos(flight.config.look_angle_rad - 0.01);
    for (Watched& at : watched) {
      const double approach_mps = v_mps.dot(at.cell);
      if (!at.unseen || approach_mps < cosine * v_mps.norm()) {
        at.from_s = -1.0;
      } else if (is_too_fast(at, approach_mps)) {
        std::ostringstream what;
        what << approach_mps << " m/s towards what is unseen, not "
             << flight.config.unseen_speed_mps;
        return what.str();
      }
    }
    return {};
  }
};

using Rules = std::vector<std::unique_ptr<Rule>>;

template <class... Some>
Rules rules() {
  Rules all;
  (all.push_back(std::make_unique<Some>()), ...);
  all.push_back(std::make_unique<AnswersInItsLimits>());
  return all;
}

SafetyConfig random_config(std::mt19937& random, const Kind& kind) {
  return {.radius_m = uniform(random, 0.3, 0.8),
          .margin_m = uniform(random, 0.1, 0.3),
          .brake_mps2 = uniform(random, 2.0, 5.0),
          .brake_vertical_mps2 = uniform(random, 1.0, 3.0),
          .delay_s = kPeriodS * std::floor(uniform(random, 1.0, 5.0)),
          .unseen = kind.unseen,
          .unseen_speed_mps = uniform(random, 0.2, 0.8),
          .look_angle_rad = kind.look_angle_rad,
          .avoidance = uniform(random, 0.0, 1.0) < 0.7 ? Avoidance::kSlide : Avoidance::kStop};
}

HaloCaster random_eyes(std::mt19937& random, const View& view) {
  const double step = uniform(random, 0.0, 1.0);
  if (step < 0.15) {
    return {rad_from_deg(2.0), 2, view};
  }
  return step < 0.5 ? HaloCaster{rad_from_deg(4.0), 4, view}
                    : HaloCaster{rad_from_deg(5.0), 4, view};
}

/// A world with some things that have no texture.
BallWorld random_world(std::mt19937& random, const SafetyConfig& config, const Kind& kind) {
  const double free_m = config.radius_m + config.margin_m + uniform(random, 0.1, 1.5);
  BallWorld world =
      kind.wide ? testing::random_walls(random, 6) : testing::random_ball_world(random, free_m);
  for (int i = 0; i < kind.without_texture; ++i) {
    world[static_cast<std::size_t>(uniform(random, 0.0, static_cast<double>(world.size())))]
        .textured = false;
  }
  return world;
}

/// What a flight came to: what was wrong, or nothing, and how far it flew.
struct Outcome {
  std::string wrong;
  double flown_m = 0.0;
  double nearest_m = 1e9;  ///< clearance to things with texture, of the vehicle's ball
};

/// Commands are sent at once and take effect so that with the period `delay_s` goes by.
Outcome fly(const Kind& kind, unsigned seed, const Rules& rules) {
  std::mt19937 random(seed);
  Flight flight;
  flight.config = random_config(random, kind);
  flight.view = kind.view;
  flight.world = random_world(random, flight.config, kind);
  flight.drone.brakes_straight = kind.brakes_straight;
  HaloCaster eyes = random_eyes(random, kind.view);
  flight.eyes = &eyes;
  Attitude attitude(random);
  Pilot pilot(random, kind.view.phi_max_rad < std::numbers::pi ? 0.6 : 0.0);
  VelocityLimiter limiter(flight.config, eyes.halo());
  const auto latency =
      static_cast<std::size_t>(std::lround((flight.config.delay_s - kPeriodS) / kStepS));
  std::deque<Eigen::Vector3d> on_the_way(latency, Eigen::Vector3d::Zero());
  Outcome outcome;
  const auto keeps = [&](std::string (Rule::*asked)(const Flight&)) {
    for (const auto& rule : rules) {
      if (const std::string wrong = ((*rule).*asked)(flight); !wrong.empty()) {
        std::ostringstream what;
        what << "seed " << seed << ", " << flight.time_s() << " s, at "
             << flight.drone.p_m.transpose() << " with " << flight.drone.v_mps.transpose()
             << " m/s, desired " << flight.desired_mps.transpose() << ", allowed "
             << flight.limit.velocity_mps.transpose() << ": " << wrong;
        outcome.wrong = what.str();
        return false;
      }
    }
    return true;
  };
  for (; flight.step < kFrames * kStepsPerFrame; ++flight.step) {
    if (flight.step % kStepsPerFrame == 0) {
      flight.R_map_body = attitude.at(flight.time_s());
      const Halo& halo = eyes.look(flight.world, flight.R_map_body, flight.drone.p_m);
      flight.desired_mps =
          pilot.desired_mps(flight.time_s(), flight.drone, flight.R_map_body, flight.world);
      flight.limit =
          limiter.limit(halo, {flight.desired_mps, flight.drone.v_mps, flight.R_map_body});
      if (!keeps(&Rule::at_frame)) {
        return outcome;
      }
    }
    on_the_way.push_back(flight.limit.velocity_mps);
    const Eigen::Vector3d before_m = flight.drone.p_m;
    flight.drone.move(flight.config, on_the_way.front());
    on_the_way.pop_front();
    outcome.flown_m += (flight.drone.p_m - before_m).norm();
    for (const Thing& thing : flight.world) {
      if (thing.textured) {
        outcome.nearest_m = std::min(outcome.nearest_m,
                                     distance_m(thing, flight.drone.p_m) - flight.config.radius_m);
      }
    }
    if (!keeps(&Rule::at_step)) {
      return outcome;
    }
  }
  return outcome;
}

unsigned first_seed() {
  const char* const chosen = std::getenv("SKYHALO_FIRST_SEED");
  return chosen == nullptr ? 1U : static_cast<unsigned>(std::strtoul(chosen, nullptr, 10));
}

/// Flies so many worlds: ones in which it hardly moves, or comes nowhere near a thing where it
/// should, tell nothing.
void fly_worlds(const Kind& kind,
                unsigned worlds,
                const std::function<Rules()>& make_rules,
                double comes_as_near_as_m = std::numeric_limits<double>::infinity()) {
  Outcome sum;
  // Under a sanitiser a sixteenth: no memory of one world is another's.
  const unsigned flown =
      static_cast<unsigned>(testing::rounds(testing::rounds(static_cast<int>(worlds))));
  for (unsigned i = 0; i < flown; ++i) {
    const Outcome outcome = fly(kind, first_seed() + i, make_rules());
    EXPECT_EQ(outcome.wrong, "");
    sum.flown_m += outcome.flown_m;
    sum.nearest_m = std::min(sum.nearest_m, outcome.nearest_m);
  }
  if (flown == worlds) {
    EXPECT_GT(sum.flown_m, 1.5 * worlds);
    EXPECT_LT(sum.nearest_m, comes_as_near_as_m);
  }
}

TEST(VelocityLimiterProperty, KeepsClearOfWhatItSees) {
  for (const auto unseen : {UnseenPolicy::kBlock, UnseenPolicy::kSlow, UnseenPolicy::kAllow}) {
    fly_worlds({.unseen = unseen}, 8, rules<KeepsClear>, 0.5);
  }
}

/// Wide worlds let it fly fast; turning needs the brakes, too.
TEST(VelocityLimiterProperty, KeepsClearOfWallsThatLean) {
  for (const bool straight : {false, true}) {
    const Kind kind = {.unseen = UnseenPolicy::kAllow, .wide = true, .brakes_straight = straight};
    fly_worlds(kind, 15, rules<KeepsClear>, 0.5);
  }
}

/// Worlds where limiters failed that heeded the commands only, not the way from one to the next.
TEST(VelocityLimiterProperty, KeepsClearWhereTurningTakesTheBrakes) {
  if (testing::kSanitised) {
    GTEST_SKIP() << "takes minutes under a sanitiser, and others run the same code there";
  }
  for (const bool straight : {false, true}) {
    for (const unsigned seed : {556U, 879U, 1000U}) {
      const Kind kind = {.unseen = UnseenPolicy::kAllow, .wide = true, .brakes_straight = straight};
      EXPECT_EQ(fly(kind, seed, rules<KeepsClear>()).wrong, "");
    }
    for (const unsigned seed : {36U, 250U}) {
      const Kind kind = {.unseen = UnseenPolicy::kAllow, .brakes_straight = straight};
      EXPECT_EQ(fly(kind, seed, rules<KeepsClear>()).wrong, "");
    }
  }
}

TEST(VelocityLimiterProperty, KeepsClearOfWhatHasNoTextureIfAskedToLookAllRound) {
  fly_worlds({.look_angle_rad = 0.5 * std::numbers::pi, .without_texture = 3}, 12, [] {
    Rules all = rules<KeepsClear>();
    static_cast<KeepsClear&>(*all.front()).of_all = true;
    return all;
  });
}

TEST(VelocityLimiterProperty, EntersOnlySeenSpace) {
  for (const View& view : {testing::all_round(), testing::four_pairs(), testing::front_only()}) {
    fly_worlds(
        {.view = view, .without_texture = 3}, 10, rules<StaysInSeenSpace, KeepsClearOfTheView>);
  }
}

TEST(VelocityLimiterProperty, ApproachesTheUnseenSlowly) {
  for (const View& view : {testing::all_round(), testing::four_pairs(), testing::front_only()}) {
    for (const bool straight : {false, true}) {
      fly_worlds({.view = view,
                  .unseen = UnseenPolicy::kSlow,
                  .without_texture = 3,
                  .brakes_straight = straight},
                 5,
                 rules<ApproachesTheUnseenSlowly>);
    }
  }
}

using Wish = std::function<Eigen::Vector3d(double time_s)>;

/// What came of a flight of 15 s in a world of these things: the drone at its end and how near its
/// ball came to them. 2 degrees, level, nose ahead; asks `watch` at each frame.
struct Tour {
  Drone drone;
  double nearest_m = 1e9;
};

Tour flown(const BallWorld& world,
           const SafetyConfig& config,
           const Wish& desired_mps,
           const std::function<void(const Drone&, const VelocityLimit&)>& watch = {}) {
  HaloCaster eyes(rad_from_deg(2.0), 2, testing::all_round());
  VelocityLimiter limiter(config, eyes.halo());
  Tour tour;
  Drone& drone = tour.drone;
  std::deque<Eigen::Vector3d> on_the_way(
      static_cast<std::size_t>(std::lround((config.delay_s - kPeriodS) / kStepS)),
      Eigen::Vector3d::Zero());
  for (int frame = 0; frame < kFrames; ++frame) {
    const Halo& halo = eyes.look(world, Eigen::Matrix3d::Identity(), drone.p_m);
    const VelocityLimit limit = limiter.limit(
        halo, {.desired_mps = desired_mps(frame * kPeriodS), .velocity_mps = drone.v_mps});
    if (watch) {
      watch(drone, limit);
    }
    for (int step = 0; step < kStepsPerFrame; ++step) {
      on_the_way.push_back(limit.velocity_mps);
      drone.move(config, on_the_way.front());
      on_the_way.pop_front();
      for (const Thing& thing : world) {
        tour.nearest_m = std::min(tour.nearest_m, distance_m(thing, drone.p_m) - config.radius_m);
      }
    }
  }
  return tour;
}

Wish always(const Eigen::Vector3d& desired_mps) {
  return [desired_mps](double) { return desired_mps; };
}

/// The brakes are needed for turning back, too.
TEST(VelocityLimiterProperty, KeepsClearOfAWallWhileItTurnsBackAlongIt) {
  const BallWorld world = {{Wall{Eigen::Vector3d::UnitX(), 8.0}}};
  for (int turn = 5; turn < 60; turn += testing::kSanitised ? 20 : 5) {
    const Tour tour = flown(world, {}, [&](double time_s) {
      return Eigen::Vector3d(4.0, time_s < 0.1 * turn ? 4.0 : -4.0, 0.0);
    });
    EXPECT_GE(tour.nearest_m, 0.0) << "turns back after " << 0.1 * turn << " s";
  }
}

TEST(VelocityLimiterProperty, KeepsClearOfTheWallsOfASharpCorner) {
  for (const double half_angle_deg : {10.0, 20.0, 30.0, 45.0, 60.0}) {
    const double sine = std::sin(rad_from_deg(half_angle_deg));
    const double cosine = std::cos(rad_from_deg(half_angle_deg));
    // The corner is 12 m ahead.
    const BallWorld world = {{Wall{Eigen::Vector3d(sine, cosine, 0.0), 12.0 * sine}},
                             {Wall{Eigen::Vector3d(sine, -cosine, 0.0), 12.0 * sine}}};
    for (const Eigen::Vector3d& desired :
         {Eigen::Vector3d(6.0, 0.0, 0.0), Eigen::Vector3d(6.0, 0.5, 0.0)}) {
      if (testing::kSanitised && desired.y() == 0.0) {
        continue;
      }
      EXPECT_GE(flown(world, {}, always(desired)).nearest_m, 0.0) << half_angle_deg;
    }
  }
}

TEST(VelocityLimiterProperty, LeavesFlightsInEmptySpaceAlone) {
  std::mt19937 random(first_seed());
  for (const auto unseen : {UnseenPolicy::kBlock, UnseenPolicy::kSlow, UnseenPolicy::kAllow}) {
    HaloCaster eyes(rad_from_deg(4.0), 1, testing::all_round());
    const Halo& halo = eyes.look({}, Eigen::Matrix3d::Identity(), Eigen::Vector3d::Zero());
    VelocityLimiter limiter({.unseen = unseen, .look_angle_rad = 0.5 * std::numbers::pi}, halo);
    for (int i = 0; i < 1000; ++i) {
      const Motion motion{
          .desired_mps = uniform(random, 0.0, kMaxSpeedMps) * random_direction(random),
          .velocity_mps = uniform(random, 0.0, kMaxSpeedMps) * random_direction(random),
          .R_map_body =
              Eigen::Quaterniond::FromTwoVectors(random_direction(random), random_direction(random))
                  .toRotationMatrix()};
      const VelocityLimit limit = limiter.limit(halo, motion);
      ASSERT_EQ(limit.reason, LimitReason::kNone);
      ASSERT_EQ(limit.velocity_mps, motion.desired_mps);
    }
  }
}

TEST(VelocityLimiterProperty, IsNotTimidTowardsAWall) {
  const BallWorld world = {{Wall{Eigen::Vector3d::UnitX(), 20.0}}};
  for (const Avoidance avoidance : {Avoidance::kSlide, Avoidance::kStop}) {
    const SafetyConfig config = {.avoidance = avoidance};
    double least = 1.0;
    double most = 0.0;
    const auto watch = [&](const Drone& drone, const VelocityLimit& limit) {
      const double gap_m = 20.0 - drone.p_m.x() - config.radius_m;
      const double delayed_mps = config.brake_mps2 * config.delay_s;
      // Stops exactly there: v delay + v^2 / (2 a) = gap.
      const double exact_mps =
          std::sqrt(delayed_mps * delayed_mps + 2.0 * config.brake_mps2 * gap_m) - delayed_mps;
      most = std::max(most, limit.velocity_mps.x() / exact_mps);
      least = gap_m > 2.0 ? std::min(least, limit.velocity_mps.x() / exact_mps) : least;
    };
    const Tour tour = flown(world, config, always({12.0, 0.0, 0.0}), watch);
    EXPECT_GT(least, 0.6);
    EXPECT_LE(most, 1.0);
    EXPECT_GE(tour.nearest_m, 0.0);
    EXPECT_LT(tour.nearest_m, config.margin_m + 0.5);
    EXPECT_LT(tour.drone.v_mps.x(), 0.05);
  }
}

/// What lies ahead at the wall is a thing like any other, although the way leads past it: at speed
/// the limiter keeps a larger distance, but not a lower speed.
TEST(VelocityLimiterProperty, FliesAlongAWall) {
  for (const double wall_m : {1.0, 1.5, 2.0, 4.0}) {
    const Tour tour =
        flown({{Wall{Eigen::Vector3d::UnitY(), wall_m}}}, {}, always({3.0, 0.0, 0.0}));
    EXPECT_GT(tour.drone.v_mps.x(), 0.95 * 3.0) << wall_m;
    EXPECT_LT(tour.drone.p_m.y(), 0.01) << wall_m;
    EXPECT_LT(wall_m - tour.drone.p_m.y(), std::max(2.1, wall_m + 0.01)) << wall_m;
  }
}

/// Pressed against a wall it slows down, for the same reason.
TEST(VelocityLimiterProperty, GlidesAlongAWall) {
  for (const auto& normal : {Eigen::Vector3d::UnitY(), Eigen::Vector3d::UnitZ()}) {
    const Tour tour =
        flown({{Wall{normal, 3.0}}}, {}, always(Eigen::Vector3d(2.0, 0.0, 0.0) + normal));
    EXPECT_GT(tour.drone.v_mps.x(), 0.6 * 2.0) << normal.transpose();
    EXPECT_GE(tour.nearest_m, 0.0);
  }
}

}  // namespace
}  // namespace skyhalo

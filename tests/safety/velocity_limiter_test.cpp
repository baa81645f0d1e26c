#include "skyhalo/safety/velocity_limiter.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

#include "skyhalo/base/error.hpp"
#include "skyhalo/geometry/angle.hpp"
#include "support/counted_new.hpp"
#include "support/expect_error.hpp"

namespace skyhalo {
namespace {

using ::testing::HasSubstr;
using testing::message_of;

constexpr double kPi = std::numbers::pi;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();
constexpr float kNone = std::numeric_limits<float>::quiet_NaN();

/// 2 degrees: half a cell's diagonal is sqrt(2) / 2 * 0.034907 = 0.024683 rad.
constexpr double kStepDeg = 2.0;

// Middles of cells are a degree beside the axes.
constexpr GridCell kAhead{45, 90};
constexpr GridCell kLeft{45, 135};
constexpr GridCell kAbove{0, 90};
constexpr GridCell kBelow{89, 90};

using Sees = std::function<void(GridCell, const SphericalPoint&, Halo&)>;

/// The directions of a cell's middle decide what is in it.
Halo halo_of(const Sees& sees) {
  Halo halo(rad_from_deg(kStepDeg));
  const GridGeometry& grid = halo.geometry();
  for (int i = 0; i < grid.cell_count(); ++i) {
    const GridCell cell{i / grid.cols, i % grid.cols};
    sees(cell, to_spherical(grid.center_direction(cell)), halo);
  }
  return halo;
}

Halo free_halo() {
  return halo_of([](GridCell cell, const auto&, Halo& halo) { halo.set(cell, kNone, 200.0F); });
}

/// Free all round but for one thing.
Halo halo_with(GridCell cell, float depth_m) {
  Halo halo = free_halo();
  halo.set(cell, depth_m, depth_m);
  return halo;
}

Halo unseen_halo() {
  return Halo(rad_from_deg(kStepDeg));
}

Eigen::Vector3d towards(GridCell cell) {
  return whole_sphere(rad_from_deg(kStepDeg)).center_direction(cell);
}

VelocityLimit limit(const SafetyConfig& config, const Halo& halo, const Motion& motion) {
  return VelocityLimiter(config, halo).limit(halo, motion);
}

VelocityLimit limit(const Halo& halo, const Eigen::Vector3d& desired_mps) {
  return limit({}, halo, {.desired_mps = desired_mps});
}

std::string refusal(const SafetyConfig& config) {
  return message_of([&] { check(config); });
}

TEST(VelocityLimiterTest, LeavesADesiredVelocityThroughFreeSpaceAlone) {
  for (const Avoidance avoidance : {Avoidance::kSlide, Avoidance::kStop}) {
    const VelocityLimit answer =
        limit({.avoidance = avoidance}, free_halo(), {.desired_mps = {3.0, -4.0, 1.0}});
    EXPECT_EQ(answer.velocity_mps, Eigen::Vector3d(3.0, -4.0, 1.0));
    EXPECT_EQ(answer.reason, LimitReason::kNone);
    EXPECT_EQ(answer.cell, std::nullopt);
  }
}

TEST(VelocityLimiterTest, CanStopInTimeBeforeOneThing) {
  // One of three walls brakes with 3 / sqrt(3) = 1.7321 m/s2. The thing is taken nearer by 0.024683
  // of 10 m, 0.2468 m, and by radius and margin, 0.7 m: 9.0532 m are left.
  // v 0.3 + v^2 / (2 1.7321) = 9.0532: v = -0.51962 + sqrt(0.27 + 31.3615) = 5.1046.
  // From 3 m: 2.2260 m are left, v = -0.51962 + sqrt(0.27 + 7.7109) = 2.3054.
  for (const Avoidance avoidance : {Avoidance::kSlide, Avoidance::kStop}) {
    for (const auto& [depth_m, speed_mps] : {std::pair{10.0F, 5.1046}, std::pair{3.0F, 2.3054}}) {
      const VelocityLimit answer = limit({.avoidance = avoidance},
                                         halo_with(kAhead, depth_m),
                                         {.desired_mps = 8.0 * towards(kAhead)});
      EXPECT_NEAR(answer.velocity_mps.norm(), speed_mps, 0.02 * speed_mps);
      EXPECT_NEAR(answer.velocity_mps.dot(towards(kAhead)), answer.velocity_mps.norm(), 1e-3);
      EXPECT_EQ(answer.reason, LimitReason::kObstacle);
      EXPECT_EQ(answer.cell, kAhead);
    }
  }
}

TEST(VelocityLimiterTest, KnowsTheVehicle) {
  // radius 1 m, margin 0.5 m, 6 / sqrt(3) = 3.4641 m/s2, delay 0.1 s; 10 - 0.2468 - 1.5 = 8.2532:
  // v = -0.34641 + sqrt(0.12 + 57.1798) = 7.2232.
  const SafetyConfig config = {.radius_m = 1.0, .margin_m = 0.5, .brake_mps2 = 6.0, .delay_s = 0.1};
  const VelocityLimit answer =
      limit(config, halo_with(kAhead, 10.0F), {.desired_mps = 9.0 * towards(kAhead)});
  EXPECT_NEAR(answer.velocity_mps.norm(), 7.2232, 0.02 * 7.2232);
}

TEST(VelocityLimiterTest, WithoutDelayAndMarginThereIsOnlyBraking) {
  // 10 - 0.2468 - 0.5 = 9.2532: v = sqrt(2 1.7321 9.2532) = 5.6616.
  const VelocityLimit answer = limit({.margin_m = 0.0, .delay_s = 0.0},
                                     halo_with(kAhead, 10.0F),
                                     {.desired_mps = 9.0 * towards(kAhead)});
  EXPECT_NEAR(answer.velocity_mps.norm(), 5.6616, 0.02 * 5.6616);
}

TEST(VelocityLimiterTest, BrakesVerticallyForWhatIsAboveAndBelow) {
  // 2 / sqrt(3) = 1.1547 m/s2: v = -0.34641 + sqrt(0.12 + 20.9075) = 4.2392.
  for (const GridCell cell : {kAbove, kBelow}) {
    const VelocityLimit answer = limit(halo_with(cell, 10.0F), 8.0 * towards(cell));
    EXPECT_NEAR(answer.velocity_mps.norm(), 4.2392, 0.02 * 4.2392);
    EXPECT_EQ(answer.cell, cell);
  }
}

TEST(VelocityLimiterTest, AboveIsAboveInTheMap) {
  // Rolled onto its right side: the body's left is up in the map, its top is to the right.
  const Eigen::Matrix3d R_map_body =
      Eigen::AngleAxisd(kPi / 2.0, Eigen::Vector3d::UnitX()).toRotationMatrix();
  const auto towards_map = [&](GridCell cell) -> Eigen::Vector3d {
    return R_map_body * towards(cell);
  };
  EXPECT_GT(towards_map(kLeft).z(), 0.99);
  const VelocityLimit left =
      limit({},
            halo_with(kLeft, 10.0F),
            {.desired_mps = 8.0 * towards_map(kLeft), .R_map_body = R_map_body});
  EXPECT_NEAR(left.velocity_mps.norm(), 4.2392, 0.02 * 4.2392);
  EXPECT_NEAR(left.velocity_mps.dot(towards_map(kLeft)), left.velocity_mps.norm(), 1e-3);
  EXPECT_EQ(left.cell, kLeft);
  const VelocityLimit top =
      limit({},
            halo_with(kAbove, 10.0F),
            {.desired_mps = 8.0 * towards_map(kAbove), .R_map_body = R_map_body});
  EXPECT_NEAR(top.velocity_mps.norm(), 5.1046, 0.02 * 5.1046);
}

TEST(VelocityLimiterTest, VelocitiesAreOfTheMap) {
  // The nose points to the map's left: what is ahead hinders flying to the left, and only that.
  const Eigen::Matrix3d R_map_body =
      Eigen::AngleAxisd(kPi / 2.0, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  const Halo halo = halo_with(kAhead, 3.0F);
  const VelocityLimit ahead =
      limit({}, halo, {.desired_mps = {4.0, 0.0, 0.0}, .R_map_body = R_map_body});
  EXPECT_EQ(ahead.velocity_mps, Eigen::Vector3d(4.0, 0.0, 0.0));
  const VelocityLimit left = limit({.avoidance = Avoidance::kStop},
                                   halo,
                                   {.desired_mps = {0.0, 4.0, 0.0}, .R_map_body = R_map_body});
  EXPECT_NEAR(left.velocity_mps.y(), 2.3054, 0.02 * 2.3054);
  EXPECT_EQ(left.cell, kAhead);
}

TEST(VelocityLimiterTest, SlidesWithWhatDoesNotApproachOrStops) {
  // A thing that touches: the desired velocity loses its part towards it, or all.
  const Halo halo = halo_with(kAhead, 0.7F);
  const Eigen::Vector3d across(0.0, 0.0, 1.0);
  const Eigen::Vector3d aside = towards(kAhead).cross(across).normalized();
  const Motion motion = {.desired_mps = 2.0 * towards(kAhead) + 1.5 * aside};
  const VelocityLimit slides = limit({.avoidance = Avoidance::kSlide}, halo, motion);
  EXPECT_LT((slides.velocity_mps - 1.5 * aside).norm(), 0.01);
  EXPECT_EQ(slides.reason, LimitReason::kObstacle);
  EXPECT_EQ(slides.cell, kAhead);
  const VelocityLimit stops = limit({.avoidance = Avoidance::kStop}, halo, motion);
  EXPECT_LT(stops.velocity_mps.norm(), 1e-6);
  EXPECT_EQ(stops.reason, LimitReason::kObstacle);
  EXPECT_EQ(stops.cell, kAhead);
}

TEST(VelocityLimiterTest, StopsInACornerWithThreeWalls) {
  Halo halo = halo_with({45, 135}, 0.5F);
  halo.set({45, 90}, 0.5F, 0.5F);
  halo.set(kAbove, 0.5F, 0.5F);
  const VelocityLimit answer = limit(halo, {2.0, 2.0, 2.0});
  EXPECT_LT(answer.velocity_mps.dot(towards({45, 135})), 0.01);
  EXPECT_LT(answer.velocity_mps.dot(towards({45, 90})), 0.01);
  EXPECT_LT(answer.velocity_mps.dot(towards(kAbove)), 0.01);
  EXPECT_LT(answer.velocity_mps.norm(), 0.1);
  EXPECT_EQ(answer.reason, LimitReason::kObstacle);
}

TEST(VelocityLimiterTest, WhatIsTooNearMayBeLeftButNotApproached) {
  const Halo halo = halo_with(kAhead, 0.3F);
  for (const Avoidance avoidance : {Avoidance::kSlide, Avoidance::kStop}) {
    const SafetyConfig config = {.avoidance = avoidance};
    const Eigen::Vector3d away = -2.0 * towards(kAhead);
    const VelocityLimit leaves = limit(config, halo, {.desired_mps = away});
    EXPECT_EQ(leaves.velocity_mps, away);
    EXPECT_EQ(leaves.reason, LimitReason::kNone);
    const VelocityLimit nearer = limit(config, halo, {.desired_mps = -away});
    EXPECT_LT(nearer.velocity_mps.norm(), 1e-4);
    EXPECT_EQ(nearer.reason, LimitReason::kObstacle);
    EXPECT_EQ(nearer.cell, kAhead);
  }
}

TEST(VelocityLimiterTest, BlocksWhatIsUnseen) {
  for (const Avoidance avoidance : {Avoidance::kSlide, Avoidance::kStop}) {
    const VelocityLimit answer = limit({.unseen = UnseenPolicy::kBlock, .avoidance = avoidance},
                                       unseen_halo(),
                                       {.desired_mps = {2.0, 0.0, 0.0}});
    EXPECT_LT(answer.velocity_mps.norm(), 1e-6);
    EXPECT_EQ(answer.reason, LimitReason::kUnseen);
    EXPECT_TRUE(answer.cell.has_value());
  }
}

TEST(VelocityLimiterTest, ApproachesWhatIsUnseenSlowly) {
  for (const Avoidance avoidance : {Avoidance::kSlide, Avoidance::kStop}) {
    const SafetyConfig config = {
        .unseen = UnseenPolicy::kSlow, .unseen_speed_mps = 0.5, .avoidance = avoidance};
    const VelocityLimit answer = limit(config, unseen_halo(), {.desired_mps = {2.0, 0.0, 0.0}});
    EXPECT_NEAR(answer.velocity_mps.x(), 0.5, 0.01);
    EXPECT_LT(answer.velocity_mps.tail<2>().norm(), 0.05);
    EXPECT_EQ(answer.reason, LimitReason::kUnseen);
    EXPECT_TRUE(answer.cell.has_value());
    const VelocityLimit slow = limit(config, unseen_halo(), {.desired_mps = {0.4, 0.0, 0.0}});
    EXPECT_EQ(slow.velocity_mps, Eigen::Vector3d(0.4, 0.0, 0.0));
    EXPECT_EQ(slow.reason, LimitReason::kNone);
  }
}

TEST(VelocityLimiterTest, MayFlyIntoWhatIsUnseenIfAllowed) {
  const VelocityLimit answer =
      limit({.unseen = UnseenPolicy::kAllow}, unseen_halo(), {.desired_mps = {2.0, 0.0, 0.0}});
  EXPECT_EQ(answer.velocity_mps, Eigen::Vector3d(2.0, 0.0, 0.0));
  EXPECT_EQ(answer.reason, LimitReason::kNone);
  EXPECT_EQ(answer.cell, std::nullopt);
}

TEST(VelocityLimiterTest, WhatWasSeenFreeEndsInTheUnseen) {
  // Seen up to 10 m, and nothing there: as for a thing at 10 m, only that nothing was seen.
  const Halo halo =
      halo_of([](GridCell cell, const auto&, Halo& all) { all.set(cell, kNone, 10.0F); });
  const Eigen::Vector3d desired = 8.0 * towards(kAhead);
  const VelocityLimit block = limit(halo, desired);
  EXPECT_NEAR(block.velocity_mps.norm(), 5.1046, 0.02 * 5.1046);
  EXPECT_EQ(block.reason, LimitReason::kUnseen);
  const VelocityLimit allow =
      limit({.unseen = UnseenPolicy::kAllow}, halo, {.desired_mps = desired});
  EXPECT_EQ(allow.velocity_mps, desired);
}

TEST(VelocityLimiterTest, SeesThingsWhateverIsUnseen) {
  for (const auto unseen : {UnseenPolicy::kSlow, UnseenPolicy::kAllow}) {
    Halo halo = unseen_halo();
    halo.set(kAhead, 0.6F, 0.0F);
    const VelocityLimit answer = limit({.unseen = unseen, .avoidance = Avoidance::kStop},
                                       halo,
                                       {.desired_mps = 2.0 * towards(kAhead)});
    EXPECT_LT(answer.velocity_mps.norm(), 1e-4);
    EXPECT_EQ(answer.reason, LimitReason::kObstacle);
    EXPECT_EQ(answer.cell, kAhead);
  }
}

TEST(VelocityLimiterTest, LooksNoFartherAsideThanAsked) {
  // Seen ahead, 35 degrees to each side; nothing beyond.
  const Halo halo = halo_of([](GridCell cell, const SphericalPoint& at, Halo& all) {
    if (towards(cell).x() > std::cos(rad_from_deg(35.0)) && at.rho_m > 0.0) {
      all.set(cell, kNone, 200.0F);
    }
  });
  const Motion motion = {.desired_mps = {2.0, 0.0, 0.0}};
  const VelocityLimit narrow = limit({.look_angle_rad = rad_from_deg(30.0)}, halo, motion);
  EXPECT_EQ(narrow.velocity_mps, motion.desired_mps);
  EXPECT_EQ(narrow.reason, LimitReason::kNone);
  const VelocityLimit wide = limit({.look_angle_rad = rad_from_deg(45.0)}, halo, motion);
  EXPECT_LT(wide.velocity_mps.norm(), 1e-4);
  EXPECT_EQ(wide.reason, LimitReason::kUnseen);
  ASSERT_TRUE(wide.cell.has_value());
  EXPECT_EQ(halo.sight(*wide.cell), Sight::kUnseen);
  EXPECT_GT(towards(*wide.cell).x(), std::cos(rad_from_deg(47.0)));
}

TEST(VelocityLimiterTest, StopsBeforeItTurnsThroughTheUnseen) {
  // Seen ahead and to the left, 35 degrees to each side; nothing between them.
  const Halo halo = halo_of([](GridCell cell, const auto&, Halo& all) {
    const Eigen::Vector3d middle = towards(cell);
    if (std::max(middle.x(), middle.y()) > std::cos(rad_from_deg(35.0))) {
      all.set(cell, kNone, 200.0F);
    }
  });
  const Eigen::Vector3d left(0.0, 3.0, 0.0);
  SafetyConfig config;
  const VelocityLimit turning =
      limit(config, halo, {.desired_mps = left, .velocity_mps = {3.0, 0.0, 0.0}});
  EXPECT_LT(turning.velocity_mps.norm(), 1e-6);
  EXPECT_EQ(turning.reason, LimitReason::kTurn);
  const VelocityLimit standing = limit(config, halo, {.desired_mps = left});
  EXPECT_EQ(standing.velocity_mps, left);
  EXPECT_EQ(standing.reason, LimitReason::kNone);
  const VelocityLimit going_there =
      limit(config, halo, {.desired_mps = left, .velocity_mps = {0.0, 2.0, 0.0}});
  EXPECT_EQ(going_there.velocity_mps, left);
  config.unseen = UnseenPolicy::kAllow;
  const VelocityLimit allowed =
      limit(config, halo, {.desired_mps = left, .velocity_mps = {3.0, 0.0, 0.0}});
  EXPECT_EQ(allowed.velocity_mps, left);
}

TEST(VelocityLimiterTest, StopsWhenTheMotionIsNotFinite) {
  for (const double wrong : {kNan, kInf, -kInf, 2e19, 1e39}) {
    std::vector<Motion> motions(3, Motion{.desired_mps = {1.0, 1.0, 0.0}});
    motions[0].desired_mps.y() = wrong;
    motions[1].velocity_mps.z() = wrong;
    motions[2].R_map_body(1, 0) = wrong;
    for (const Motion& motion : motions) {
      for (const auto unseen : {UnseenPolicy::kBlock, UnseenPolicy::kAllow}) {
        const VelocityLimit answer = limit({.unseen = unseen}, free_halo(), motion);
        EXPECT_EQ(answer.velocity_mps, Eigen::Vector3d::Zero());
        EXPECT_EQ(answer.reason, LimitReason::kInvalid);
        EXPECT_EQ(answer.cell, std::nullopt);
      }
    }
  }
}

TEST(VelocityLimiterTest, NoVelocityNeedsNoLimit) {
  for (const Halo& halo : {unseen_halo(), free_halo(), halo_with(kAhead, 0.1F)}) {
    const VelocityLimit answer = limit({}, halo, {.velocity_mps = {2.0, 1.0, 0.0}});
    EXPECT_EQ(answer.velocity_mps, Eigen::Vector3d::Zero());
    EXPECT_EQ(answer.reason, LimitReason::kNone);
    EXPECT_EQ(answer.cell, std::nullopt);
  }
}

TEST(VelocityLimiterTest, RemembersNothingAndDoesNotAllocate) {
  const Halo wall = halo_with(kAhead, 3.0F);
  const Halo nothing = unseen_halo();
  const Motion motion = {.desired_mps = 8.0 * towards(kAhead), .velocity_mps = {1.0, 1.0, 0.0}};
  VelocityLimiter limiter({}, wall);
  const VelocityLimit first = limiter.limit(wall, motion);
  const long before = allocation_count;
  (void)limiter.limit(nothing, motion);
  (void)limiter.limit(wall, {.desired_mps = {kNan, 0.0, 0.0}});
  const VelocityLimit again = limiter.limit(wall, motion);
  EXPECT_EQ(allocation_count - before, 0);
  EXPECT_EQ(again.velocity_mps, first.velocity_mps);
  EXPECT_EQ(again.reason, first.reason);
  EXPECT_EQ(again.cell, first.cell);
}

TEST(VelocityLimiterTest, RefusesConfigsOutsideTheirDomain) {
  for (const double wrong : {0.0, -1.0, kNan}) {
    EXPECT_THAT(refusal({.radius_m = wrong}), HasSubstr("safety.radius_m"));
    EXPECT_THAT(refusal({.brake_mps2 = wrong}), HasSubstr("safety.brake_mps2"));
    EXPECT_THAT(refusal({.brake_vertical_mps2 = wrong}), HasSubstr("safety.brake_vertical_mps2"));
  }
  for (const double wrong : {-0.1, kNan}) {
    EXPECT_THAT(refusal({.margin_m = wrong}), HasSubstr("safety.margin_m"));
    EXPECT_THAT(refusal({.delay_s = wrong}), HasSubstr("safety.delay_s"));
    EXPECT_THAT(refusal({.unseen_speed_mps = wrong}), HasSubstr("safety.unseen_speed_mps"));
    EXPECT_THAT(refusal({.look_angle_rad = wrong}), HasSubstr("safety.look_angle"));
  }
  EXPECT_THAT(refusal({.look_angle_rad = 4.0}), HasSubstr("safety.look_angle"));
  EXPECT_THROW(VelocityLimiter({.radius_m = -1.0}, unseen_halo()), Error);
}

TEST(VelocityLimiterTest, AcceptsTheEdgesOfTheDomains) {
  EXPECT_NO_THROW(check({}));
  EXPECT_NO_THROW(check({.margin_m = 0.0, .delay_s = 0.0, .unseen_speed_mps = 0.0}));
  EXPECT_NO_THROW(check({.look_angle_rad = 0.5 * kPi}));
}

}  // namespace
}  // namespace skyhalo

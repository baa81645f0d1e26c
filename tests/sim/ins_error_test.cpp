#include "skyhalo/sim/ins_error.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "support/expect_error.hpp"

namespace skyhalo {
namespace {

using Eigen::Vector3d;

/// A body that flies a curve and turns all the time.
Pose curve(double t_s) {
  const Eigen::AngleAxisd turn(0.4 * t_s, Vector3d(0.2, 0.1, 1.0).normalized());
  return make_pose(turn.toRotationMatrix(), {5.0 * t_s, t_s * t_s, 10.0 - 0.3 * t_s});
}

/// A body that rests in the origin.
Pose rest(double) {
  return Pose::Identity();
}

Vector3d rotation_vector(const Eigen::Matrix3d& R) {
  const Eigen::AngleAxisd turn(R);
  return turn.angle() * turn.axis();
}

/// The mean square of each component.
Vector3d mean_square(const std::vector<Vector3d>& values) {
  Vector3d sum = Vector3d::Zero();
  for (const Vector3d& value : values) {
    sum += value.cwiseAbs2();
  }
  return sum / static_cast<double>(values.size());
}

void expect_components_near(const Vector3d& found, double expected, double tolerance) {
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(found[axis], expected, tolerance) << "axis " << axis;
  }
}

TEST(InsErrorTest, WithoutErrorsThePoseIsExact) {
  const InsError ins({}, 10.0);
  for (const double t_s : {0.0, 0.013, 3.7, 10.0}) {
    const Pose T_map_body = ins.measured(curve, t_s, 7);
    EXPECT_TRUE(T_map_body.isApprox(curve(t_s), 1e-12)) << t_s;
  }
}

TEST(InsErrorTest, ADelayGivesThePoseOfThen) {
  InsErrorConfig config;
  config.delay_s = 0.25;
  const InsError ins(config, 10.0);
  for (const double t_s : {0.25, 1.0, 9.9}) {
    EXPECT_TRUE(ins.measured(curve, t_s, 7).isApprox(curve(t_s - 0.25), 1e-12)) << t_s;
  }
}

TEST(InsErrorProperty, PositionNoiseIsNewWithEachPose) {
  InsErrorConfig config;
  config.position_sigma_m = 0.3;
  const InsError ins(config, 10.0);
  std::vector<Vector3d> errors_m;
  Vector3d sum_m = Vector3d::Zero();
  for (std::uint64_t key = 0; key < 5000; ++key) {
    const Pose T_map_body = ins.measured(curve, 4.0, key);
    EXPECT_TRUE(T_map_body.linear().isApprox(curve(4.0).linear(), 1e-9));
    errors_m.push_back(T_map_body.translation() - curve(4.0).translation());
    sum_m += errors_m.back();
  }
  expect_components_near(mean_square(errors_m).cwiseSqrt(), 0.3, 0.015);
  expect_components_near(sum_m / 5000.0, 0.0, 0.02);
  double product_m2 = 0.0;
  for (std::size_t i = 1; i < errors_m.size(); ++i) {
    product_m2 += errors_m[i].x() * errors_m[i - 1].x() + errors_m[i].x() * errors_m[i].y();
  }
  EXPECT_NEAR(product_m2 / 5000.0, 0.0, 0.01);
}

TEST(InsErrorProperty, AttitudeNoiseIsNewWithEachPose) {
  InsErrorConfig config;
  config.attitude_sigma_rad = 0.01;
  const InsError ins(config, 10.0);
  std::vector<Vector3d> errors_rad;
  for (std::uint64_t key = 0; key < 5000; ++key) {
    const Pose T_map_body = ins.measured(curve, 4.0, key);
    EXPECT_TRUE(is_rotation(T_map_body.linear(), 1e-9));
    EXPECT_TRUE(T_map_body.translation().isApprox(curve(4.0).translation(), 1e-9));
    errors_rad.push_back(rotation_vector(curve(4.0).linear().transpose() * T_map_body.linear()));
  }
  expect_components_near(mean_square(errors_rad).cwiseSqrt(), 0.01, 0.0005);
}

/// Errors of a body at rest at some times, one list per time, over many seeds.
template <class ErrorOf>
std::vector<std::vector<Vector3d>> drifts(InsErrorConfig config,
                                          const std::vector<double>& times_s,
                                          const ErrorOf& error_of) {
  std::vector<std::vector<Vector3d>> errors(times_s.size());
  for (std::uint64_t seed = 0; seed < 1500; ++seed) {
    config.seed = seed;
    const InsError ins(config, 9.0);
    for (std::size_t i = 0; i < times_s.size(); ++i) {
      errors[i].push_back(error_of(ins.measured(rest, times_s[i], 0)));
    }
  }
  return errors;
}

TEST(InsErrorProperty, PositionDriftGrowsLikeTheRootOfTime) {
  InsErrorConfig config;
  config.position_drift_m_per_sqrt_s = 0.2;
  const auto errors_m = drifts(config, {0.0, 1.0, 4.0, 9.0}, [](const Pose& T) {
    EXPECT_TRUE(T.linear().isApprox(Eigen::Matrix3d::Identity(), 1e-12));
    return Vector3d(T.translation());
  });
  expect_components_near(mean_square(errors_m[0]), 0.0, 1e-12);
  expect_components_near(mean_square(errors_m[1]).cwiseSqrt(), 0.2, 0.02);
  expect_components_near(mean_square(errors_m[2]).cwiseSqrt(), 0.4, 0.04);
  expect_components_near(mean_square(errors_m[3]).cwiseSqrt(), 0.6, 0.06);
  // Steps one after the other have nothing to do with each other.
  std::vector<Vector3d> later_m = errors_m[3];
  Vector3d product_m2 = Vector3d::Zero();
  for (std::size_t i = 0; i < later_m.size(); ++i) {
    later_m[i] -= errors_m[2][i];
    product_m2 += later_m[i].cwiseProduct(errors_m[2][i]);
  }
  expect_components_near(mean_square(later_m).cwiseSqrt(), 0.2 * std::sqrt(5.0), 0.045);
  expect_components_near(product_m2 / 1500.0, 0.0, 0.02);
}

TEST(InsErrorProperty, HeadingDriftGrowsLikeTheRootOfTime) {
  InsErrorConfig config;
  config.yaw_drift_rad_per_sqrt_s = 0.01;
  const auto errors_rad = drifts(config, {0.0, 1.0, 9.0}, [](const Pose& T) {
    EXPECT_LT(T.translation().norm(), 1e-12);
    return rotation_vector(T.linear());
  });
  const auto deviation_of = [&](std::size_t i) -> Vector3d {
    return mean_square(errors_rad[i]).cwiseSqrt();
  };
  EXPECT_LT(deviation_of(0).norm(), 1e-12);
  EXPECT_NEAR(deviation_of(1).z(), 0.01, 0.001);
  EXPECT_NEAR(deviation_of(2).z(), 0.03, 0.003);
  EXPECT_LT(deviation_of(2).head<2>().norm(), 1e-9);
}

TEST(InsErrorProperty, DriftHasNoJumps) {
  InsErrorConfig config;
  config.position_drift_m_per_sqrt_s = 0.1;
  config.yaw_drift_rad_per_sqrt_s = 0.01;
  const InsError ins(config, 10.0);
  Pose before = ins.measured(rest, 0.0, 0);
  for (int i = 1; i <= 5000; ++i) {
    const Pose now = ins.measured(rest, 0.002 * i, 0);
    // 6 standard deviations of 10 ms.
    EXPECT_LT((now.translation() - before.translation()).norm(), 6.0 * 0.1 * 0.1 * std::sqrt(3.0));
    EXPECT_LT(rotation_vector(before.linear().transpose() * now.linear()).norm(), 6.0 * 0.01 * 0.1);
    before = now;
  }
}

TEST(InsErrorProperty, TheSameKeyMakesTheSamePose) {
  InsErrorConfig config;
  config.position_sigma_m = 0.1;
  config.attitude_sigma_rad = 0.01;
  config.position_drift_m_per_sqrt_s = 0.1;
  config.yaw_drift_rad_per_sqrt_s = 0.01;
  config.delay_s = 0.02;
  const auto matrix_of = [&](std::uint64_t seed, std::uint64_t key) -> Eigen::Matrix4d {
    config.seed = seed;
    return InsError(config, 10.0).measured(curve, 4.0, key).matrix();
  };
  EXPECT_EQ(matrix_of(1, 2), matrix_of(1, 2));
  EXPECT_NE(matrix_of(1, 2), matrix_of(1, 3));
  EXPECT_NE(matrix_of(1, 2), matrix_of(2, 2));
}

TEST(InsErrorTest, WhatCannotBeIsRefused) {
  using ::testing::HasSubstr;
  const auto complaint = [](const auto& spoil) {
    InsErrorConfig config;
    spoil(config);
    return testing::message_of([&] { check(config); });
  };
  EXPECT_NO_THROW(check(InsErrorConfig()));
  EXPECT_THAT(complaint([](auto& c) { c.position_sigma_m = -1.0; }), HasSubstr("position_sigma_m"));
  EXPECT_THAT(complaint([](auto& c) { c.attitude_sigma_rad = std::nan(""); }),
              HasSubstr("attitude_sigma_"));
  EXPECT_THAT(complaint([](auto& c) { c.position_drift_m_per_sqrt_s = -0.1; }),
              HasSubstr("position_drift_m"));
  EXPECT_THAT(complaint([](auto& c) { c.yaw_drift_rad_per_sqrt_s = -0.1; }),
              HasSubstr("yaw_drift_"));
  EXPECT_THAT(complaint([](auto& c) { c.delay_s = 11.0; }), HasSubstr("delay_s"));
  EXPECT_THAT(complaint([](auto& c) { c.delay_s = -0.1; }), HasSubstr("delay_s"));
}

}  // namespace
}  // namespace skyhalo

// Grids of random pairs of both models, anywhere beside the body origin, against the naive version.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <opencv2/core.hpp>
#include <random>
#include <vector>

#include "reference/naive_halo.hpp"
#include "skyhalo/geometry/angle.hpp"
#include "skyhalo/sphere/accumulate.hpp"
#include "support/cell_border.hpp"
#include "support/instruction_set.hpp"

namespace skyhalo {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInf = std::numeric_limits<float>::infinity();
const cv::Size kSize(61, 43);  // no multiple of a vector

struct Scene {
  PairGeometry pair;
  GridGeometry grid;
  DepthRule depth;
  SeenRule seen;
  cv::Mat1f disparity;
};

double between(std::mt19937& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

PairModel random_model(std::mt19937& random, bool spherical) {
  const double u0 = between(random, 0.0, kSize.width);
  const double v0 = between(random, 0.0, kSize.height);
  if (spherical) {
    return SphericalPair{.delta_theta_u_rad = rad_from_deg(between(random, 0.5, 2.9)),
                         .delta_theta_v_rad = rad_from_deg(between(random, 0.5, 4.0)),
                         .principal_u_px = u0,
                         .principal_v_px = v0,
                         .baseline_m = between(random, 0.05, 0.6)};
  }
  return PinholePair{.focal_px = between(random, 15.0, 80.0),
                     .principal_u_px = u0,
                     .principal_v_px = v0,
                     .baseline_m = between(random, 0.05, 0.6),
                     .disparity_offset_px = between(random, 0.0, 1.0) < 0.3 ? 2.5 : 0.0};
}

/// A turn by any angle about any axis: views over the poles and behind are as likely as others.
Pose random_mounting(std::mt19937& random) {
  std::normal_distribution<double> normal(0.0, 1.0);
  const Eigen::Quaterniond q(normal(random), normal(random), normal(random), normal(random));
  const Eigen::Vector3d place(normal(random), normal(random), normal(random));
  return make_pose(q.normalized().toRotationMatrix(),
                   between(random, 0.0, 0.5) * place.normalized());
}

/// The whole sphere, a whole circle that begins anywhere, or a part that may cross the half-plane
/// behind.
GridGeometry random_grid(std::mt19937& random, double step_deg) {
  const auto steps = [&](double low, double high) {
    return step_deg * std::floor(between(random, low, high) / step_deg);
  };
  GridBounds bounds{
      0.0, std::numbers::pi, -std::numbers::pi, std::numbers::pi, rad_from_deg(step_deg)};
  const double kind = between(random, 0.0, 3.0);
  if (kind < 2.0) {
    const double first = steps(-180.0, 179.0);
    bounds.phi_min_rad = rad_from_deg(first);
    bounds.phi_max_rad = rad_from_deg(first + (kind < 1.0 ? 360.0 : steps(180.0, 340.0)));
  }
  if (kind < 1.5) {
    bounds.theta_min_rad = rad_from_deg(steps(0.0, 60.0));
  }
  return make_grid_geometry(bounds);
}

/// Surfaces in patches, so that cells hold several points of one surface, with noise, holes, and
/// what is no disparity.
cv::Mat1f random_disparity(std::mt19937& random, const Scene& scene) {
  const double scale = std::holds_alternative<SphericalPair>(scene.pair.model) ? 12.0 : 20.0;
  cv::Mat1f patches(6, 8);
  for (float& value : patches) {
    value = static_cast<float>(scale * std::pow(between(random, 0.1, 1.0), 2.0));
  }
  cv::Mat1f disparity(kSize);
  for (int v = 0; v < kSize.height; ++v) {
    for (int u = 0; u < kSize.width; ++u) {
      const double kind = between(random, 0.0, 1.0);
      const float surface =
          patches(v * patches.rows / kSize.height, u * patches.cols / kSize.width);
      disparity(v, u) = kind < 0.15   ? kNan
                        : kind < 0.16 ? kInf
                        : kind < 0.17 ? -3.0F
                        : kind < 0.19 ? 0.0F
                        : kind < 0.22 ? static_cast<float>(between(random, 0.0, 3.0 * scale))
                                      : surface * static_cast<float>(between(random, 0.98, 1.02));
    }
  }
  return disparity;
}

reference::NaivePairView view_of(const Scene& scene) {
  reference::NaivePairView view;
  if (const auto* spherical = std::get_if<SphericalPair>(&scene.pair.model)) {
    view = {.spherical = true,
            .delta_theta_u_rad = spherical->delta_theta_u_rad,
            .delta_theta_v_rad = spherical->delta_theta_v_rad,
            .u0_px = spherical->principal_u_px,
            .v0_px = spherical->principal_v_px,
            .B_m = spherical->baseline_m};
  } else {
    const auto& pinhole = std::get<PinholePair>(scene.pair.model);
    view = {.f_px = pinhole.focal_px,
            .offset_px = pinhole.disparity_offset_px,
            .u0_px = pinhole.principal_u_px,
            .v0_px = pinhole.principal_v_px,
            .B_m = pinhole.baseline_m};
  }
  for (std::size_t i = 0; i < 3; ++i) {
    const auto at = static_cast<int>(i);
    for (std::size_t k = 0; k < 3; ++k) {
      view.R_body_camera[i][k] = scene.pair.T_body_camera.linear()(at, static_cast<int>(k));
    }
    view.t_body_camera_m[i] = scene.pair.T_body_camera.translation()[at];
  }
  view.min_range_m = scene.pair.min_range_m;
  view.max_range_m = scene.pair.max_range_m;
  return view;
}

reference::NaiveHaloDepthSettings settings_of(const DepthRule& rule) {
  const auto kind = rule.kind == DepthRuleKind::kThesis ? reference::NaiveHaloRule::kMeanMinusSigma
                    : rule.kind == DepthRuleKind::kMean ? reference::NaiveHaloRule::kMean
                    : rule.kind == DepthRuleKind::kNearest ? reference::NaiveHaloRule::kNearest
                                                           : reference::NaiveHaloRule::kQuantile;
  return {kind,
          rule.sigma_factor,
          rule.sigma_threshold_m,
          rule.nearest_count,
          rule.quantile,
          rule.min_range_m};
}

/// True where a range lies on a limit or on the border of two classes of the quantile's.
bool is_near_limit(double range_m, double limit_m) {
  return std::abs(range_m / limit_m - 1.0) < 1e-5;
}

bool is_near_class(double range_m) {
  int exponent = 0;
  const double sixteenths = 32.0 * std::frexp(range_m, &exponent);
  return std::abs(sixteenths - std::round(sixteenths)) < 1e-4;
}

/// Takes pixels out where the last bits may decide about their cell or class.
void take_out_ties(Scene& scene) {
  const reference::NaivePairView view = view_of(scene);
  for (int v = 0; v < kSize.height; ++v) {
    for (int u = 0; u < kSize.width; ++u) {
      const auto reading = reference::naive_halo_reading(view, u, v, scene.disparity(v, u));
      const Eigen::Vector3d p(
          reading.point_body_m[0], reading.point_body_m[1], reading.point_body_m[2]);
      const bool point = reading.state == reference::NaiveHaloState::kPoint;
      if (is_near_limit(reading.range_m, scene.pair.min_range_m) ||
          is_near_limit(reading.range_m, scene.pair.max_range_m) ||
          (point &&
           (testing::is_near_border(p, scene.grid.theta_step_rad) || is_near_class(p.norm())))) {
        scene.disparity(v, u) = kNan;
      }
    }
  }
}

Scene random_scene(std::mt19937& random, bool spherical, DepthRuleKind kind) {
  const double step_deg = between(random, 0.0, 1.0) < 0.5 ? 10.0 : 7.5;
  Scene scene{.pair = {.model = random_model(random, spherical),
                       .T_body_camera = random_mounting(random),
                       .min_range_m = between(random, 0.0, 0.6),
                       .max_range_m = between(random, 3.0, 25.0)},
              .grid = random_grid(random, step_deg),
              .depth = {.kind = kind,
                        .sigma_threshold_m = 0.5,
                        .sigma_factor = 3.0,
                        .nearest_count = 1 + static_cast<int>(between(random, 0.0, 7.99)),
                        .quantile = between(random, 0.0, 0.5),
                        .min_range_m = between(random, 0.0, 0.5)},
              .seen = {.near_m = between(random, 0.55, 1.5),
                       .min_share = between(random, 0.3, 0.9),
                       .window_rad = rad_from_deg(step_deg * between(random, 0.0, 2.4))},
              .disparity = {}};
  scene.disparity = random_disparity(random, scene);
  take_out_ties(scene);
  return scene;
}

reference::NaiveHaloPair naive_of(const Scene& scene) {
  const GridGeometry& grid = scene.grid;
  return reference::naive_halo_pair(
      {grid.theta_min_rad,
       grid.theta_min_rad + grid.rows * grid.theta_step_rad,
       grid.phi_min_rad,
       grid.phi_min_rad + grid.cols * grid.phi_step_rad,
       grid.theta_step_rad},
      view_of(scene),
      {kSize.width, kSize.height, {scene.disparity.begin(), scene.disparity.end()}},
      settings_of(scene.depth),
      {scene.seen.near_m, scene.seen.min_share, scene.seen.window_rad});
}

struct Compared {
  int points = 0;
  int depths = 0;
  int free_cells = 0;
  int walks = 0;
};

/// The same points in each cell, and the same depth.
void compare_points(const SphericalGrid& grid,
                    GridCell at,
                    const std::vector<double>& ranges_m,
                    double naive_depth_m,
                    Compared& compared) {
  const auto cell = grid.statistics(at);
  ASSERT_EQ(cell ? cell->count : 0, static_cast<int>(ranges_m.size()));
  compared.points += static_cast<int>(ranges_m.size());
  const std::optional<double> depth_m = grid.depth_m(at);
  ASSERT_EQ(depth_m.has_value(), !std::isnan(naive_depth_m));
  const bool on_threshold = cell && std::abs(cell->sigma_m - grid.rule().sigma_threshold_m) < 1e-4;
  if (depth_m && !on_threshold) {
    EXPECT_NEAR(*depth_m, naive_depth_m, 1e-5 * naive_depth_m);
    ++compared.depths;
  }
}

void compare(const Scene& scene, Compared& compared) {
  const reference::NaiveHaloPair naive = naive_of(scene);
  SphericalGrid grid(scene.grid, scene.depth);
  Accumulator accumulator(scene.pair, kSize, scene.grid, scene.depth, scene.seen);
  (void)accumulator.accumulate(scene.disparity, grid);
  for (int i = 0; i < scene.grid.cell_count(); ++i) {
    const GridCell at{i / scene.grid.cols, i % scene.grid.cols};
    const auto cell = static_cast<std::size_t>(i);
    SCOPED_TRACE(::testing::Message() << "cell " << at.row << ", " << at.col);
    compare_points(grid, at, naive.ranges_m[cell], naive.depth_m[cell], compared);
    EXPECT_EQ(grid.looks(at).valid, naive.seen.valid[cell]);
    EXPECT_EQ(grid.looks(at).invalid, naive.seen.invalid[cell]);
    const auto& walk = naive.walks[cell];
    if (walk.corner_margin_rad > 1e-4 && walk.start_margin_rad > 1e-4) {
      EXPECT_NEAR(grid.free_to_m()[cell], naive.free_to_m[cell], 2e-5 * naive.free_to_m[cell]);
      compared.free_cells += naive.free_to_m[cell] > 0.0 ? 1 : 0;
      ++compared.walks;
    }
  }
}

class NaiveGridReference : public ::testing::TestWithParam<std::tuple<bool, DepthRuleKind>> {};

TEST_P(NaiveGridReference, AgreesWithTheNaiveGrid) {
  const auto [spherical, kind] = GetParam();
  std::mt19937 random(spherical ? 81 : 82);
  Compared compared;
  for (const std::int64_t target : testing::InstructionSet::all()) {
    const testing::InstructionSet in_use(target);
    for (int round = 0; round < 4 && !HasFailure(); ++round) {
      SCOPED_TRACE(::testing::Message() << "instruction set " << target << ", round " << round);
      compare(random_scene(random, spherical, kind), compared);
    }
  }
  EXPECT_GT(compared.points, 5000);
  EXPECT_GT(compared.depths, 500);
  EXPECT_GT(compared.free_cells, 100);
  EXPECT_GT(compared.walks, 2000);
}

INSTANTIATE_TEST_SUITE_P(BothModelsAllRules,
                         NaiveGridReference,
                         ::testing::Combine(::testing::Bool(),
                                            ::testing::Values(DepthRuleKind::kThesis,
                                                              DepthRuleKind::kMean,
                                                              DepthRuleKind::kNearest,
                                                              DepthRuleKind::kQuantile)));

}  // namespace
}  // namespace skyhalo

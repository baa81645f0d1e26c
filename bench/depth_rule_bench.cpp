// How far the depth rules are off in cells whose truth is known: prints the table of docs/halo.md.
// Each row is a scene in a cell of 2 degrees seen by a pinhole pair (f 314 px, B 0.15 or 0.54 m)
// with a quarter of a pixel of noise; a share of the disparities is anything. Medians over many
// cells, and the 95th percentiles of the error to either side, in per cent of the range.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "skyhalo/geometry/angle.hpp"
#include "skyhalo/geometry/spherical.hpp"
#include "skyhalo/sphere/spherical_grid.hpp"

namespace {

using skyhalo::DepthRule;
using skyhalo::DepthRuleKind;

constexpr double kFocal_px = 314.0;
constexpr double kNoise_px = 0.25;

struct NamedRule {
  std::string name;
  DepthRule rule;
};

std::vector<NamedRule> rules() {
  return {{"thesis", {.kind = DepthRuleKind::kThesis}},
          {"thesis, factor 0", {.kind = DepthRuleKind::kThesis, .sigma_factor = 0.0}},
          {"mean", {.kind = DepthRuleKind::kMean}},
          {"nearest, 1", {.kind = DepthRuleKind::kNearest, .nearest_count = 1}},
          {"nearest, 3", {.kind = DepthRuleKind::kNearest, .nearest_count = 3}},
          {"nearest, 5", {.kind = DepthRuleKind::kNearest, .nearest_count = 5}},
          {"nearest, 8", {.kind = DepthRuleKind::kNearest, .nearest_count = 8}},
          {"quantile, 0.1", {.kind = DepthRuleKind::kQuantile, .quantile = 0.1}},
          {"quantile, 0.25", {.kind = DepthRuleKind::kQuantile, .quantile = 0.25}}};
}

/// A scene: the range of a place in the cell, both coordinates in [0, 1), and the nearest of all.
struct Scene {
  std::string name;
  std::function<double(double across, double down)> range_m;
  double nearest_m;
};

std::vector<Scene> scenes(double z_m) {
  const double cell_rad = skyhalo::rad_from_deg(2.0);
  // The ground 1.5 m below, its nearest place at z.
  const double near_pitch = std::asin(1.5 / z_m);
  const auto ground = [=](double, double down) {
    return 1.5 / std::sin(std::max(1e-3, near_pitch - (1.0 - down) * cell_rad));
  };
  return {{"wall", [=](double, double) { return z_m; }, z_m},
          {"wall at 60 degrees",
           [=](double across, double) { return z_m * (1.0 + std::tan(1.047) * across * cell_rad); },
           z_m},
          {"pole before a wall 5 m behind",
           [=](double across, double) { return across < 0.15 ? z_m : z_m + 5.0; },
           z_m},
          {"ground", ground, z_m}};
}

struct Trial {
  double baseline_m;
  int points;
  double outliers;
};

/// Relative errors of the depth over many cells, sorted; infinite where a cell has none.
std::vector<double> errors_of(const DepthRule& rule, const Scene& scene, const Trial& trial) {
  std::mt19937 random(11);
  std::normal_distribution<double> noise_px(0.0, kNoise_px);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  skyhalo::SphericalGrid grid(skyhalo::whole_sphere(skyhalo::rad_from_deg(2.0)), rule);
  const skyhalo::GridCell cell{45, 90};
  const Eigen::Vector3d ray = grid.geometry().center_direction(cell);
  const double px_m = kFocal_px * trial.baseline_m;
  std::vector<double> errors;
  for (int round = 0; round < 400; ++round) {
    grid.clear();
    for (int i = 0; i < trial.points; ++i) {
      const double true_px = px_m / scene.range_m(unit(random), unit(random));
      const double noisy_px = true_px + noise_px(random);
      const double d_px = unit(random) < trial.outliers ? 1.0 + 59.0 * unit(random) : noisy_px;
      if (d_px > 0.0) {
        grid.add(px_m / d_px * ray);
      }
    }
    const auto depth_m = grid.depth_m(cell);
    errors.push_back(depth_m ? *depth_m / scene.nearest_m - 1.0 : INFINITY);
  }
  std::sort(errors.begin(), errors.end());
  return errors;
}

void print_table(double z_m, const Trial& trial) {
  std::printf("\nz %.0f m, B %.2f m, %d points a cell, %.1f %% of them anything\n\n| rule |",
              z_m,
              trial.baseline_m,
              trial.points,
              100.0 * trial.outliers);
  for (const Scene& scene : scenes(z_m)) {
    std::printf(" %s |", scene.name.c_str());
  }
  std::printf("\n|---|---|---|---|---|\n");
  for (const NamedRule& named : rules()) {
    std::printf("| %s |", named.name.c_str());
    for (const Scene& scene : scenes(z_m)) {
      const std::vector<double> errors = errors_of(named.rule, scene, trial);
      const auto percent = [&](double share) {
        return 100.0 *
               errors[static_cast<std::size_t>(share * (static_cast<double>(errors.size()) - 1.0))];
      };
      std::printf(" %+.1f (%+.1f...%+.1f) |", percent(0.5), percent(0.05), percent(0.95));
    }
    std::printf("\n");
  }
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App program("bias and spread of the depth rules in cells whose truth is known");
  bool once = false;
  program.add_flag("--once", once, "only the first table");
  CLI11_PARSE(program, argc, argv);
  std::printf(
      "Median error of the depth against the nearest surface in per cent, and its 5th and 95th "
      "percentile; below zero is too near.\n");
  for (const Trial& trial : {Trial{0.54, 40, 0.005},
                             Trial{0.54, 200, 0.005},
                             Trial{0.15, 200, 0.005},
                             Trial{0.54, 200, 0.02}}) {
    for (const double z_m : {5.0, 10.0, 20.0}) {
      print_table(z_m, trial);
      if (once) {
        return 0;
      }
    }
  }
  return 0;
}

#include "skyhalo/sensor_model/sensor_model_curves.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <variant>

namespace skyhalo {
namespace {

InverseSensorModel model_at(const PairModel& pair, const SensorModelConfig& config, double z_m) {
  return {config, z_m, delta_z_m(pair, z_m, config.delta_d_px)};
}

/// Even steps over the whole curve, the first one close to 0; about z, even steps of the two bells'
/// widths.
std::vector<double> distances_m(const InverseSensorModel& model, double delta_z_m, double end_m) {
  constexpr int kSteps = 100;
  constexpr int kBellSteps = 60;
  constexpr double kBellWidths = 6.0;
  std::vector<double> all{model.z_m(), 1e-3 * end_m};
  for (int i = 1; i <= kSteps; ++i) {
    all.push_back(end_m * i / kSteps);
  }
  for (int i = 1; i <= kBellSteps; ++i) {
    const double widths = kBellWidths * i / kBellSteps;
    all.push_back(model.z_m() - widths * delta_z_m);
    all.push_back(model.z_m() + widths * model.width_behind_m());
  }
  std::erase_if(all, [&](double m_m) { return !(m_m > 0.0 && m_m <= end_m); });
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  return all;
}

/// Four widths behind, exp(-8) = 3e-4 of the peak is left.
double end_of_curves_m(const PairModel& pair,
                       const SensorModelConfig& config,
                       std::span<const double> z_m) {
  double end_m = 0.0;
  for (const double z : z_m) {
    end_m = std::max({end_m, 1.1 * z, z + 4.0 * model_at(pair, config, z).width_behind_m()});
  }
  return end_m;
}

}  // namespace

std::vector<ModelCurve> model_curves(const PairModel& pair,
                                     const SensorModelConfig& config,
                                     std::span<const double> z_m) {
  const double end_m = end_of_curves_m(pair, config, z_m);
  std::vector<ModelCurve> curves;
  for (const double z : z_m) {
    const InverseSensorModel model = model_at(pair, config, z);
    ModelCurve curve{.z_m = z,
                     .delta_z_m = delta_z_m(pair, z, config.delta_d_px),
                     .peak_probability = model.probability(z)};
    for (const double m_m : distances_m(model, curve.delta_z_m, end_m)) {
      curve.samples.push_back({m_m, model.probability(m_m)});
    }
    curves.push_back(std::move(curve));
  }
  return curves;
}

double occupied_until_m(const PairModel& pair,
                        const SensorModelConfig& config,
                        double occupied_probability) {
  const double needed = occupied_probability - config.p_unknown;
  if (!(needed > 0.0)) {
    return std::numeric_limits<double>::infinity();
  }
  // a = k (1 - p_unknown) exp(-delta_z) = needed
  const double limit_m = std::log(config.k * (1.0 - config.p_unknown) / needed);
  return limit_m > 0.0 ? range_at_uncertainty_m(pair, limit_m, config.delta_d_px) : 0.0;
}

std::vector<UncertaintySample> column_uncertainty(const PairModel& pair,
                                                  double u_px,
                                                  std::span<const double> ranges_m,
                                                  double delta_d_px) {
  const double v_px = std::visit([](const auto& model) { return model.principal_v_px; }, pair);
  // Any point of the ray has its direction; a far one exists on every ray.
  const Eigen::Vector3d direction = reproject(pair, u_px, v_px, 1e-3).normalized();
  std::vector<UncertaintySample> samples;
  if (!direction.allFinite()) {
    return samples;
  }
  for (const double range_m : ranges_m) {
    const double d_px = project(pair, range_m * direction).z();
    samples.push_back({u_px, d_px, range_m, uncertainty_m(pair, {u_px, v_px, d_px}, delta_d_px)});
  }
  return samples;
}

}  // namespace skyhalo

#include "skyhalo/sim/sonar.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "skyhalo/sim/random_numbers.hpp"

namespace skyhalo {

std::optional<double> sonar_range_m(const SceneMoment& moment,
                                    const Pose& T_scene_sonar,
                                    std::uint64_t noise_key,
                                    const SonarConfig& config) {
  constexpr int kRays = 256;
  std::vector<SceneRay> rays;
  for (int i = 0; i < kRays; ++i) {
    // A spiral that fills the cap of the sphere evenly.
    const double cosine = 1.0 - (i + 0.5) / kRays * (1.0 - std::cos(config.half_angle_rad));
    const double sine = std::sqrt(1.0 - cosine * cosine);
    const double turn_rad = i * std::numbers::pi * (3.0 - std::sqrt(5.0));
    const Eigen::Vector3d direction(cosine, sine * std::cos(turn_rad), sine * std::sin(turn_rad));
    rays.push_back({T_scene_sonar.translation().cast<float>(),
                    (T_scene_sonar.linear() * direction).cast<float>(),
                    0.5F});
  }
  std::vector<SceneHit> hits(rays.size());
  moment.trace(rays, hits, static_cast<float>(config.max_range_m));
  const auto nearest =
      std::min_element(hits.begin(), hits.end(), [](const SceneHit& a, const SceneHit& b) {
        return a.range_m < b.range_m;
      });
  if (nearest->object == SceneHit::kNothing) {
    return std::nullopt;
  }
  const auto noise = static_cast<double>(gaussian(random_bits({noise_key})));
  const double range_m = static_cast<double>(nearest->range_m) + config.range_sigma_m * noise;
  return std::clamp(range_m, config.min_range_m, config.max_range_m);
}

}  // namespace skyhalo

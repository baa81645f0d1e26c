#include "skyhalo/sim/laser_scanner.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "skyhalo/base/error.hpp"
#include "skyhalo/base/for_each_index.hpp"
#include "skyhalo/geometry/angle.hpp"
#include "skyhalo/sim/random_numbers.hpp"

namespace skyhalo {
namespace {

constexpr float kBrightSurface = 0.8F;

const Material& material_of(const Scene& scene, const SceneHit& hit) {
  const TriangleMesh& mesh =
      hit.object == SceneHit::kFixed ? scene.fixed : scene.movers[hit.object - 1].mesh;
  return scene.materials[mesh.materials[hit.triangle]];
}

/// One firing of all lasers.
std::vector<LaserReturn> fire(const SceneMoment& moment,
                              std::span<const Eigen::Vector3f> beams,
                              const Pose& T_scene_laser,
                              std::uint64_t noise_key,
                              const LaserScannerConfig& config) {
  const Eigen::Matrix3f R_scene_laser = T_scene_laser.linear().cast<float>();
  const Eigen::Vector3f position_m = T_scene_laser.translation().cast<float>();
  std::vector<SceneRay> rays;
  rays.reserve(beams.size());
  for (const Eigen::Vector3f& beam : beams) {
    rays.push_back({position_m, R_scene_laser * beam, 0.5F});
  }
  std::vector<SceneHit> hits(rays.size());
  moment.trace(rays, hits, static_cast<float>(config.max_range_m));
  std::vector<LaserReturn> returns;
  for (std::size_t i = 0; i < hits.size(); ++i) {
    const SceneHit& hit = hits[i];
    if (hit.object == SceneHit::kNothing || hit.range_m < static_cast<float>(config.min_range_m)) {
      continue;
    }
    const float reflectivity = material_of(moment.scene(), hit).laser_reflectivity;
    const float thrown_back = reflectivity * std::abs(hit.normal.dot(rays[i].direction));
    const float reach_m =
        static_cast<float>(config.max_range_m) * std::sqrt(thrown_back / kBrightSurface);
    if (hit.range_m > reach_m) {
      continue;
    }
    const float error_m =
        static_cast<float>(config.range_sigma_m) * gaussian(random_bits({noise_key, i}));
    returns.push_back({(hit.range_m + error_m) * beams[i], reflectivity, hit.object, hit.triangle});
  }
  return returns;
}

}  // namespace

std::vector<double> laser_elevations_rad() {
  constexpr int kPerBlock = 32;
  std::vector<double> elevations_rad;
  elevations_rad.reserve(std::size_t{2} * kPerBlock);
  for (int i = 0; i < kPerBlock; ++i) {
    elevations_rad.push_back(rad_from_deg(2.0 - i / 3.0));
  }
  for (int i = 0; i < kPerBlock; ++i) {
    elevations_rad.push_back(rad_from_deg(-8.83 - 0.5 * i));
  }
  return elevations_rad;
}

std::vector<LaserReturn> scan(const SceneMoment& moment,
                              const PoseAtTime& T_scene_laser,
                              double stamp_s,
                              std::uint64_t noise_key,
                              const LaserScannerConfig& config) {
  const std::vector<double> elevations_rad = laser_elevations_rad();
  std::vector<std::vector<LaserReturn>> firings(static_cast<std::size_t>(config.azimuths));
  for_each_index(firings.size(), [&](std::size_t i) {
    const double turned = (static_cast<double>(i) + 0.5) / config.azimuths - 0.5;  // -0.5 ... 0.5
    const double azimuth_rad = -2.0 * std::numbers::pi * turned;  // clockwise, as it spins
    std::vector<Eigen::Vector3f> beams;
    beams.reserve(elevations_rad.size());
    for (const double elevation_rad : elevations_rad) {
      beams.push_back(Eigen::Vector3d(std::cos(elevation_rad) * std::cos(azimuth_rad),
                                      std::cos(elevation_rad) * std::sin(azimuth_rad),
                                      std::sin(elevation_rad))
                          .cast<float>());
    }
    firings[i] = fire(moment,
                      beams,
                      T_scene_laser(stamp_s + turned * config.turn_s),
                      random_bits({noise_key, i}),
                      config);
  });
  std::vector<LaserReturn> all;
  for (const auto& returns : firings) {
    all.insert(all.end(), returns.begin(), returns.end());
  }
  return all;
}

void check(const LaserScannerConfig& config) {
  const auto expect = [](bool holds, const char* what) {
    if (!holds) {
      throw Error(ErrorKind::kInput, std::string("laser: ") + what);
    }
  };
  expect(config.azimuths >= 1 && config.azimuths <= 36000, "azimuths: expected 1...36000");
  expect(config.range_sigma_m >= 0.0 && config.range_sigma_m <= 1.0,
         "range_sigma_m: expected 0...1");
  expect(config.min_range_m >= 0.0 && config.max_range_m > config.min_range_m &&
             config.max_range_m <= 1000.0,
         "ranges: expected 0 <= min_range_m < max_range_m <= 1000");
  expect(config.turn_s >= 0.0 && config.turn_s <= 1.0, "turn_s: expected 0...1");
}

}  // namespace skyhalo

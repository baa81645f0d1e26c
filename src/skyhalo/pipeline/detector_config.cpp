#include "skyhalo/pipeline/detector_config.hpp"

#include <cmath>
#include <string>

#include "skyhalo/base/error.hpp"
#include "skyhalo/map/log_odds.hpp"

namespace skyhalo {
namespace {

void require(bool holds, const char* key, const char* expected) {
  if (!holds) {
    throw Error(ErrorKind::kInput, std::string(key) + ": expected " + expected);
  }
}

bool positive(double value) noexcept {
  return value > 0.0 && std::isfinite(value);
}

}  // namespace

IntegrationConfig integration_config(const DetectorConfig& config) {
  return {.sensor = config.sensor_model,
          .limit_units = static_cast<int>(std::lround(config.map.log_odds_limit / kLogOddsPerUnit)),
          .method = config.map.method,
          .cell_size_term = config.map.cell_size_term};
}

LocalMap make_local_map(const MapConfig& config) {
  const Eigen::Vector3d size_m(config.local_side_m, config.local_side_m, config.local_height_m);
  return {local_map_cells(size_m, config.voxel_m), config.voxel_m};
}

void check(const DetectorConfig& config) {
  require(config.matching.downscale >= 1 && config.matching.downscale <= 16,
          "matching.downscale",
          "a whole number in 1...16");
  require(config.matching.rcrop_px >= 0, "matching.rcrop_px", "a number of pixels >= 0");
  check(config.matching.matcher);
  check(config.sphere.depth, "sphere");
  check(config.sphere.seen, "sphere");
  require(positive(config.sphere.max_range_m), "sphere.max_range_m", "a length above 0 m");
  require(positive(config.map.voxel_m), "map.voxel_m", "a length above 0 m");
  require(config.map.log_odds_limit >= kLogOddsPerUnit && config.map.log_odds_limit <= 32.0,
          "map.log_odds_limit",
          "a number in 0.001...32");
  check(config.map.decay);
  require(positive(config.map.local_side_m), "map.local_side_m", "a length above 0 m");
  require(positive(config.map.local_height_m), "map.local_height_m", "a length above 0 m");
  require(config.map.memory_mib >= 1 && config.map.memory_mib <= 1048576,
          "map.memory_mib",
          "a whole number of MiB in 1...1048576");
  check(config.sensor_model);
  (void)make_grid_geometry(config.sphere.bounds);
  (void)whole_sphere(config.sphere.bounds.step_rad);
}

}  // namespace skyhalo

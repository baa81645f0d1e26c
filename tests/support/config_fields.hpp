#pragma once

#include <string>
#include <vector>

namespace skyhalo::testing {

/// A key of the configuration with a value in its domain that is not the default.
struct ConfigKey {
  std::string key;
  std::string value;
};

/// Every key of the configuration file. Written out by hand, so that a key that gets lost is seen.
inline std::vector<ConfigKey> config_keys() {
  return {{"dataset.cameras", "colour"},
          {"matching.downscale", "4"},
          {"matching.max_disparity_px", "128"},
          {"matching.rcrop_px", "32"},
          {"matching.masks_px", "[[0, 0, 40, 30], [600, 340, 20, 10]]"},
          {"sgm.p1", "3"},
          {"sgm.p2_min", "6"},
          {"sgm.p2_max", "44"},
          {"sgm.uniqueness_percent", "5"},
          {"sgm.left_right_px", "1.5"},
          {"sgm.texture_min_grey", "4"},
          {"sgm.repetition_px", "60"},
          {"sgm.median_passes", "2"},
          {"sgm.fill_min_px", "9"},
          {"sgm.speckle_size_px", "60"},
          {"sgm.speckle_step_px", "1.25"},
          {"sgm.edge_step_px", "2.5"},
          {"opencv.block_px", "5"},
          {"opencv.paths", "8"},
          {"opencv.uniqueness_percent", "7"},
          {"opencv.left_right_px", "2"},
          {"opencv.speckle_size_px", "50"},
          {"opencv.speckle_range_px", "3"},
          {"sphere.theta_min_deg", "45"},
          {"sphere.theta_max_deg", "135"},
          {"sphere.phi_min_deg", "-60"},
          {"sphere.phi_max_deg", "61"},
          {"sphere.step_deg", "0.5"},
          {"sphere.rule", "quantile"},
          {"sphere.sigma_threshold_m", "0.25"},
          {"sphere.sigma_factor", "2.5"},
          {"sphere.nearest_count", "3"},
          {"sphere.quantile", "0.25"},
          {"sphere.min_seen_share", "0.75"},
          {"sphere.seen_window_deg", "2"},
          {"sphere.near_m", "1.5"},
          {"sphere.max_range_m", "20.125"},
          {"safety.radius_m", "0.4"},
          {"safety.margin_m", "0.1"},
          {"safety.brake_mps2", "2.5"},
          {"safety.brake_vertical_mps2", "1.5"},
          {"safety.delay_s", "0.25"},
          {"safety.unseen", "slow"},
          {"safety.unseen_speed_mps", "0.75"},
          {"safety.look_angle_deg", "90"},
          {"safety.avoidance", "stop"},
          {"sensor_model.k", "0.625"},
          {"sensor_model.p_unknown", "0.45"},
          {"sensor_model.p_free", "0.35"},
          {"sensor_model.delta_d_px", "0.75"},
          {"map.voxel_m", "0.2"},
          {"map.log_odds_limit", "3.5"},
          {"map.method", "rays"},
          {"map.cell_size_term", "false"},
          {"map.half_life_occupied_s", "20"},
          {"map.half_life_free_s", "10.5"},
          {"map.local_side_m", "12"},
          {"map.local_height_m", "6.5"},
          {"map.memory_mib", "64"},
          {"bounds.ahead_m", "10"},
          {"bounds.behind_m", "1.5"},
          {"bounds.side_m", "12.5"},
          {"bounds.bottom_m", "-1"},
          {"bounds.top_m", "4.25"},
          {"evaluation.max_range_m", "25"},
          {"evaluation.occupied_probability", "0.6"},
          {"evaluation.labels_may_end_early", "true"}};
}

}  // namespace skyhalo::testing

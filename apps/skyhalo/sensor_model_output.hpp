#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "skyhalo/camera/pair_model.hpp"
#include "skyhalo/sensor_model/inverse_sensor_model.hpp"

namespace skyhalo::app {

/// What `skyhalo sensor-model` looks at.
struct SensorModelStudy {
  std::string figure{};  ///< of the thesis; empty for none
  PairModel pair{};
  SensorModelConfig config{};
  std::vector<double> z_m{};
  double occupied_probability = 0.7;

  /// Figures 4.1 and 4.2 show the uncertainty by column, all else the inverse sensor model.
  [[nodiscard]] bool by_column() const { return figure.starts_with("4."); }
};

/// `z_m,m_m,delta_z_m,p`, or by column `u_px,d_px,range_m,delta_x_m,delta_y_m,delta_z_m`.
[[nodiscard]] std::string study_csv(const SensorModelStudy& study);

/// Two charts side by side.
[[nodiscard]] std::string study_svg(const SensorModelStudy& study);

/// The table for people, and the same for programs.
[[nodiscard]] std::string study_text(const SensorModelStudy& study);
[[nodiscard]] nlohmann::json study_summary(const SensorModelStudy& study);

}  // namespace skyhalo::app

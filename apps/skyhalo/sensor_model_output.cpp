#include "sensor_model_output.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <initializer_list>
#include <utility>

#include "skyhalo/geometry/angle.hpp"
#include "skyhalo/io/svg_chart.hpp"
#include "skyhalo/sensor_model/sensor_model_curves.hpp"

namespace skyhalo::app {
namespace {

constexpr int kImageWidthPx = 1200;  // of figures 4.1 and 4.2: twice their u0
constexpr int kSteps = 100;

std::string number(double value, const char* format = "%.4g") {
  std::array<char, 64> text{};
  const int length = std::snprintf(text.data(), text.size(), format, value);
  return {text.data(), static_cast<std::size_t>(length)};
}

std::string csv_row(std::initializer_list<double> values) {
  std::string row;
  for (const double value : values) {
    row += (row.empty() ? "" : ",") + number(value, "%.9g");
  }
  return row + "\n";
}

bool is_pinhole(const SensorModelStudy& study) {
  return std::holds_alternative<PinholePair>(study.pair);
}

const char* model_name(const SensorModelStudy& study) {
  return is_pinhole(study) ? "pinhole" : "spherical";
}

/// "B 0.1 m, f 500 px, δd 0.5 px"
std::string pair_words(const SensorModelStudy& study) {
  const auto* pinhole = std::get_if<PinholePair>(&study.pair);
  const std::string lens =
      pinhole != nullptr
          ? "f " + number(pinhole->focal_px) + " px"
          : "δθu " + number(std::get<SphericalPair>(study.pair).delta_theta_u_rad) + " rad";
  return "B " + number(baseline_m(study.pair)) + " m, " + lens + ", δd " +
         number(study.config.delta_d_px) + " px";
}

double farthest_m(const SensorModelStudy& study) {
  return *std::max_element(study.z_m.begin(), study.z_m.end());
}

/// Close to 0, then `kSteps` even steps to the end.
std::vector<double> even_steps(double end) {
  std::vector<double> values{1e-3 * end};
  for (int i = 1; i <= kSteps; ++i) {
    values.push_back(end * i / kSteps);
  }
  return values;
}

// --- the inverse sensor model ---

std::string model_csv(const SensorModelStudy& study) {
  std::string csv = "z_m,m_m,delta_z_m,p\n";
  for (const ModelCurve& curve : model_curves(study.pair, study.config, study.z_m)) {
    for (const ModelSample& sample : curve.samples) {
      csv += csv_row({curve.z_m, sample.m_m, curve.delta_z_m, sample.p});
    }
  }
  return csv;
}

LineChart probability_chart(const SensorModelStudy& study, const std::vector<ModelCurve>& curves) {
  const double end_m = curves.front().samples.back().m_m;
  LineChart chart{.title = std::string("Inverse sensor model, ") + model_name(study),
                  .x_label = "distance along the ray, m (m)",
                  .y_label = "probability of being occupied",
                  .x_range = ChartRange{0.0, end_m},
                  .y_range = ChartRange{0.0, 1.0}};
  const double p = study.occupied_probability;
  chart.series.push_back({"occupied > " + number(p), {{0.0, p}, {end_m, p}}, true});
  for (const ModelCurve& curve : curves) {
    ChartSeries series{.label = "z = " + number(curve.z_m) + " m"};
    for (const ModelSample& sample : curve.samples) {
      series.points.emplace_back(sample.m_m, sample.p);
    }
    chart.series.push_back(std::move(series));
  }
  return chart;
}

LineChart range_uncertainty_chart(const SensorModelStudy& study, double end_m) {
  ChartSeries series{.label = "Δz(z)"};
  for (const double z_m : even_steps(end_m)) {
    series.points.emplace_back(z_m, delta_z_m(study.pair, z_m, study.config.delta_d_px));
  }
  LineChart chart{.title = pair_words(study),
                  .x_label = "measured range z (m)",
                  .y_label = "range uncertainty Δz (m)",
                  .x_range = ChartRange{0.0, end_m},
                  .y_range = ChartRange{0.0, 1.05 * series.points.back().y()},
                  .series = {std::move(series)}};
  const double until_m = occupied_until_m(study.pair, study.config, study.occupied_probability);
  if (until_m > 0.0 && until_m < end_m) {
    const double limit_m = delta_z_m(study.pair, until_m, study.config.delta_d_px);
    chart.series.push_back({"peak p = " + number(study.occupied_probability),
                            {{0.0, limit_m}, {until_m, limit_m}, {until_m, 0.0}},
                            true});
  }
  return chart;
}

std::string model_svg(const SensorModelStudy& study) {
  const std::vector<ModelCurve> curves = model_curves(study.pair, study.config, study.z_m);
  const double end_m = curves.front().samples.back().m_m;
  const std::array charts{probability_chart(study, curves), range_uncertainty_chart(study, end_m)};
  return svg_of(charts);
}

// --- the uncertainty by column (thesis figures 4.1 and 4.2) ---

/// Every `step` columns of the image, and its last.
std::vector<double> columns_px(int step) {
  std::vector<double> columns;
  for (int u_px = 0; u_px < kImageWidthPx - 1; u_px += step) {
    columns.push_back(u_px);
  }
  columns.push_back(kImageWidthPx - 1);
  return columns;
}

std::string column_csv(const SensorModelStudy& study) {
  const std::vector<double> ranges_m = even_steps(farthest_m(study));
  std::string csv = "u_px,d_px,range_m,delta_x_m,delta_y_m,delta_z_m\n";
  for (const double u_px : columns_px(100)) {
    for (const UncertaintySample& sample :
         column_uncertainty(study.pair, u_px, ranges_m, study.config.delta_d_px)) {
      csv += csv_row({sample.u_px,
                      sample.d_px,
                      sample.range_m,
                      sample.delta_m.x(),
                      sample.delta_m.y(),
                      sample.delta_m.z()});
    }
  }
  return csv;
}

/// Angle between the column's ray and the optical axis.
double off_axis_deg(const SensorModelStudy& study, double u_px) {
  const Eigen::Vector3d point_m = reproject(study.pair, u_px, 0.5 * kImageWidthPx, 1e-3);
  return deg_from_rad(std::abs(std::atan2(point_m.x(), point_m.z())));
}

LineChart over_range_chart(const SensorModelStudy& study) {
  const double end_m = farthest_m(study);
  LineChart chart{.title = std::string("Uncertainty on the central row, ") + model_name(study),
                  .x_label = "range of the point (m)",
                  .y_label = "uncertainty along the ray (m)",
                  .x_range = ChartRange{0.0, end_m}};
  for (const double u_px : {600.0, 400.0, 200.0, 0.0}) {
    ChartSeries series{.label = "u = " + number(u_px) + " (" +
                                number(off_axis_deg(study, u_px), "%.0f") + "°)"};
    for (const UncertaintySample& sample :
         column_uncertainty(study.pair, u_px, even_steps(end_m), study.config.delta_d_px)) {
      series.points.emplace_back(sample.range_m, sample.along_ray_m());
    }
    if (!series.points.empty()) {
      chart.series.push_back(std::move(series));
    }
  }
  return chart;
}

LineChart over_column_chart(const SensorModelStudy& study) {
  LineChart chart{.title = pair_words(study),
                  .x_label = "column u (px)",
                  .y_label = "uncertainty along the ray (m)",
                  .x_range = ChartRange{0.0, kImageWidthPx}};
  std::vector<double> ranges_m = study.z_m;
  std::sort(ranges_m.rbegin(), ranges_m.rend());
  for (const double range_m : ranges_m) {
    ChartSeries series{.label = "range " + number(range_m) + " m"};
    for (const double u_px : columns_px(10)) {
      const std::array range{range_m};
      for (const UncertaintySample& sample :
           column_uncertainty(study.pair, u_px, range, study.config.delta_d_px)) {
        series.points.emplace_back(u_px, sample.along_ray_m());
      }
    }
    chart.series.push_back(std::move(series));
  }
  return chart;
}

/// Both charts over the same uncertainties.
std::string column_svg(const SensorModelStudy& study) {
  std::array charts{over_range_chart(study), over_column_chart(study)};
  double largest_m = 0.0;
  for (const LineChart& chart : charts) {
    for (const ChartSeries& series : chart.series) {
      for (const Eigen::Vector2d& point : series.points) {
        largest_m = std::max(largest_m, point.y());
      }
    }
  }
  for (LineChart& chart : charts) {
    chart.y_range = ChartRange{0.0, 1.05 * largest_m};
  }
  return svg_of(charts);
}

}  // namespace

std::string study_csv(const SensorModelStudy& study) {
  return study.by_column() ? column_csv(study) : model_csv(study);
}

std::string study_svg(const SensorModelStudy& study) {
  return study.by_column() ? column_svg(study) : model_svg(study);
}

std::string study_text(const SensorModelStudy& study) {
  const SensorModelConfig& config = study.config;
  std::string text = std::string(model_name(study)) + ": " + pair_words(study) + "; k " +
                     number(config.k) + ", p_free " + number(config.p_free) + ", p_unknown " +
                     number(config.p_unknown) + "\n\n| z (m) | Δz (m) | peak p |\n|---|---|---|\n";
  for (const ModelCurve& curve : model_curves(study.pair, config, study.z_m)) {
    text += "| " + number(curve.z_m) + " | " + number(curve.delta_z_m) + " | " +
            number(curve.peak_probability, "%.3f") + " |\n";
  }
  const double until_m = occupied_until_m(study.pair, config, study.occupied_probability);
  const std::string above = "p = " + number(study.occupied_probability) + " (occupied)";
  if (std::isinf(until_m)) {
    return text + "\nThe peak is above " + above + " at every range.\n";
  }
  return text + (until_m > 0.0 ? "\nThe peak falls to " + above + " at " + number(until_m) + " m.\n"
                               : "\nThe peak reaches " + above + " at no range.\n");
}

nlohmann::json study_summary(const SensorModelStudy& study) {
  const SensorModelConfig& config = study.config;
  nlohmann::json summary = {{"model", model_name(study)},
                            {"baseline_m", baseline_m(study.pair)},
                            {"delta_d_px", config.delta_d_px},
                            {"k", config.k},
                            {"p_free", config.p_free},
                            {"p_unknown", config.p_unknown},
                            {"occupied_probability", study.occupied_probability},
                            {"measurements", nlohmann::json::array()}};
  if (const auto* pinhole = std::get_if<PinholePair>(&study.pair)) {
    summary["focal_px"] = pinhole->focal_px;
  } else {
    summary["delta_theta_u_rad"] = std::get<SphericalPair>(study.pair).delta_theta_u_rad;
  }
  if (!study.figure.empty()) {
    summary["figure"] = study.figure;
  }
  for (const ModelCurve& curve : model_curves(study.pair, config, study.z_m)) {
    summary["measurements"].push_back({{"z_m", curve.z_m},
                                       {"delta_z_m", curve.delta_z_m},
                                       {"peak_probability", curve.peak_probability}});
  }
  const double until_m = occupied_until_m(study.pair, config, study.occupied_probability);
  summary["occupied_until_m"] =
      std::isinf(until_m) ? nlohmann::json(nullptr) : nlohmann::json(until_m);
  return summary;
}

}  // namespace skyhalo::app

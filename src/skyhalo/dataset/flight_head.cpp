#include <nlohmann/json.hpp>

#include "skyhalo/base/error.hpp"
#include "skyhalo/calibration/yaml_value.hpp"
#include "skyhalo/dataset/flight_files.hpp"
#include "skyhalo/dataset/frame_checks.hpp"

namespace skyhalo {
namespace {

bool read_flag(const YamlValue& document, std::string_view key) {
  const YamlValue value = document.at(key);
  const std::string word = value.text();
  if (word != "true" && word != "false") {
    throw value.error("expected true or false, found '" + word + "'");
  }
  return word == "true";
}

Pose read_rows(const YamlValue& value) {
  const std::vector<double> numbers = value.numbers(16);
  Pose T = Pose::Identity();
  T.matrix() = Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(numbers.data());
  const bool last_row = T.matrix().row(3) == Eigen::RowVector4d(0.0, 0.0, 0.0, 1.0);
  if (!last_row || !is_rigid(T)) {
    throw value.error("expected the four rows of a rigid transform");
  }
  return T;
}

nlohmann::json rows_of(const Pose& T) {
  nlohmann::json rows = nlohmann::json::array();
  for (Eigen::Index row = 0; row < 4; ++row) {
    const Eigen::RowVector4d r = T.matrix().row(row);
    rows.push_back({r[0], r[1], r[2], r[3]});
  }
  return rows;
}

}  // namespace

FlightHead read_flight_head(const std::filesystem::path& file) {
  const YamlValue document = YamlValue::load(file);
  if (document.at("format").text() != kFlightFormat) {
    throw document.at("format").error(std::string("expected '") + kFlightFormat + "'");
  }
  const YamlValue version = document.at("version");
  if (version.whole_number() != kFlightVersion) {
    throw version.error("version " + version.text() + " is not known; this program reads version " +
                        std::to_string(kFlightVersion));
  }
  document.refuse_other_keys(
      {"format", "version", "name", "source", "frames", "laser", "sonar", "objects", "true_poses"});
  FlightHead head{.name = document.at("name").text(),
                  .source = {},
                  .frames = document.at("frames").whole_number(),
                  .T_body_laser = {},
                  .has_sonar = read_flag(document, "sonar"),
                  .has_objects = read_flag(document, "objects"),
                  .has_true_poses = read_flag(document, "true_poses")};
  if (head.frames < 1) {
    throw document.at("frames").error("expected at least one frame");
  }
  const YamlValue source = document.at("source");
  for (const std::string& key : source.keys()) {
    head.source[key] = source.at(key).text();
  }
  if (const std::optional<YamlValue> laser = document.find("laser")) {
    laser->refuse_other_keys({"T_body_laser"});
    head.T_body_laser = read_rows(laser->at("T_body_laser"));
  }
  return head;
}

std::string to_json_text(const FlightHead& head) {
  nlohmann::json source = nlohmann::json::object();
  for (const auto& [key, word] : head.source) {
    source[key] = word;
  }
  nlohmann::ordered_json document = {{"format", kFlightFormat},
                                     {"version", kFlightVersion},
                                     {"name", head.name},
                                     {"source", source},
                                     {"frames", head.frames}};
  if (head.T_body_laser) {
    document["laser"]["T_body_laser"] = rows_of(*head.T_body_laser);
  }
  document["sonar"] = head.has_sonar;
  document["objects"] = head.has_objects;
  document["true_poses"] = head.has_true_poses;
  return document.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace skyhalo

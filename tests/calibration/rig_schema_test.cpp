// The JSON Schema of rig files and the reader know the same keys.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <string>

#include "skyhalo/calibration/rig_file.hpp"
#include "skyhalo/io/text_file.hpp"
#include "support/expect_error.hpp"
#include "support/temp_folder.hpp"

namespace skyhalo {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;
using testing::message_of;
using testing::TempFolder;
using Keys = std::set<std::string>;

json schema() {
  return json::parse(kRigSchema);
}

/// JSON is YAML, too.
void read(const json& rig) {
  const TempFolder folder;
  (void)read_rig_file(folder.write("rig.yaml", rig.dump(1)));
}

/// The keys that the schema allows in an object, and those that it asks for.
struct Section {
  std::string title;
  Keys allowed;
  Keys required;
  json::json_pointer place;   ///< of the object in `rig`
  json rig = json::object();  ///< a rig that has every allowed key there, or nearly
  Keys absent = {};           ///< allowed keys that another kind of the object has
};

Keys keys_of(const json& object) {
  Keys keys;
  for (const auto& [key, value] : object.items()) {
    keys.insert(key);
  }
  return keys;
}

json placement() {
  return {{"position_m", {0, 0, 0}}, {"yaw_deg", 0}, {"pitch_deg", 0}, {"roll_deg", 0}};
}

json camera(const std::string& lens, const json& distortion) {
  return {{"size_px", {640, 480}},
          {"lens", lens},
          {"intrinsics_px", {400, 400, 320, 240}},
          {"distortion", distortion}};
}

void add_options(json& pair) {
  pair.update({{"T_body_camera", placement()},
               {"downscale", 2},
               {"rcrop_px", 64},
               {"masks_px", {{0, 0, 1, 1}}},
               {"min_range_m", 1},
               {"max_range_m", 2},
               {"line_time_s", 1e-5}});
}

json raw_rig() {
  json pair = {{"name", "raw"},
               {"left", camera("radial-tangential", {0.1, 0, 0, 0})},
               {"right", camera("kannala-brandt", {0.1, 0, 0, 0})},
               {"T_right_left", {1, 0, 0, -0.1, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}},
               {"rectify_to",
                {{"model", "pinhole"}, {"hfov_deg", 60}, {"vfov_deg", 40}, {"size_px", {64, 48}}}}};
  add_options(pair);
  return {{"rig", "name"}, {"T_body_imu", placement()}, {"pairs", {pair}}};
}

json rectified_rig(const std::string& model) {
  json images = {{"model", model},
                 {"size_px", {640, 480}},
                 {"principal_point_px", {320, 240}},
                 {"baseline_m", 0.1}};
  images.update(model == "pinhole" ? json{{"focal_px", 400}, {"disparity_offset_px", 1}}
                                   : json{{"delta_theta_rad", {0.004, 0.004}}});
  json pair = {{"name", "rectified"}, {"rectified", images}};
  add_options(pair);
  return {{"rig", "name"}, {"T_body_imu", placement()}, {"pairs", {pair}}};
}

Section section(const std::string& title,
                const json& definition,
                const std::string& place,
                const json& rig,
                const Keys& absent = {}) {
  EXPECT_EQ(definition.at("additionalProperties"), false) << title;
  return {title,
          keys_of(definition.at("properties")),
          definition.at("required").get<Keys>(),
          json::json_pointer(place),
          rig,
          absent};
}

std::vector<Section> sections() {
  const json all = schema();
  const json& d = all.at("definitions");
  const json& placed = d.at("pose").at("oneOf").at(2);
  return {section("rig", all, "", raw_rig()),
          section("raw pair", d.at("raw_pair"), "/pairs/0", raw_rig()),
          section("rectified pair", d.at("rectified_pair"), "/pairs/0", rectified_rig("pinhole")),
          section("left", d.at("camera"), "/pairs/0/left", raw_rig()),
          section("right", d.at("camera"), "/pairs/0/right", raw_rig()),
          section("rectify_to", d.at("rectify_to"), "/pairs/0/rectify_to", raw_rig()),
          section("place", placed, "/pairs/0/T_body_camera", raw_rig()),
          section("place of the IMU", placed, "/T_body_imu", raw_rig()),
          section("pinhole",
                  d.at("rectified"),
                  "/pairs/0/rectified",
                  rectified_rig("pinhole"),
                  {"delta_theta_rad"}),
          section("spherical",
                  d.at("rectified"),
                  "/pairs/0/rectified",
                  rectified_rig("spherical"),
                  {"focal_px", "disparity_offset_px"})};
}

TEST(RigSchemaTest, IsTheFileOfTheProject) {
  EXPECT_EQ(kRigSchema,
            read_bytes(std::filesystem::path(SKYHALO_SOURCE_DIR) / "config/rig.schema.json"));
}

TEST(RigSchemaTest, TheReaderTakesEveryKeyOfTheSchema) {
  for (const Section& s : sections()) {
    Keys given = keys_of(s.rig.at(s.place));
    given.insert(s.absent.begin(), s.absent.end());
    EXPECT_EQ(given, s.allowed) << s.title;
    EXPECT_NO_THROW(read(s.rig)) << s.title;
  }
}

TEST(RigSchemaTest, TheReaderKnowsNoOtherKeys) {
  for (const Section& s : sections()) {
    json rig = s.rig;
    rig.at(s.place)["surplus"] = 1;
    const std::string message = message_of([&] { read(rig); });
    EXPECT_THAT(message, HasSubstr("surplus: unknown key")) << s.title;
    const std::string list = "known are ";
    const std::size_t at = message.find(list);
    ASSERT_NE(at, std::string::npos) << message;
    std::istringstream words(message.substr(at + list.size()));
    Keys known(std::istream_iterator<std::string>(words), {});
    for (const std::string& key : s.absent) {
      EXPECT_FALSE(known.contains(key)) << key;
    }
    known.insert(s.absent.begin(), s.absent.end());
    EXPECT_EQ(known, s.allowed) << s.title;
  }
}

TEST(RigSchemaTest, TheReaderAsksForTheSameKeys) {
  for (const Section& s : sections()) {
    for (const std::string& key : keys_of(s.rig.at(s.place))) {
      json rig = s.rig;
      rig.at(s.place).erase(key);
      // Which of the two kinds a lens or a pair is makes these two needed.
      const bool by_kind = key == "distortion" || key == "focal_px" || key == "delta_theta_rad" ||
                           (s.title == "rectified pair" && key == "rectified");
      if (s.required.contains(key) || by_kind) {
        EXPECT_NE(message_of([&] { read(rig); }), "") << s.title << " without " << key;
      } else {
        EXPECT_NO_THROW(read(rig)) << s.title << " without " << key;
      }
    }
  }
}

TEST(RigSchemaTest, WordsAreTheSame) {
  const json d = schema().at("definitions");
  json rig = raw_rig();
  const std::map<std::string, json> distortions = {{"pinhole", json::array()},
                                                   {"radial-tangential", {0.1, 0, 0, 0}},
                                                   {"kannala-brandt", {0.1, 0, 0, 0}},
                                                   {"double-sphere", {-0.2, 0.6}},
                                                   {"extended-unified", {0.6, 1.1}}};
  EXPECT_EQ(d.at("camera").at("properties").at("lens").at("enum").size(), distortions.size());
  for (const json& word : d.at("camera").at("properties").at("lens").at("enum")) {
    rig["pairs"][0]["left"] = camera(word, distortions.at(word.get<std::string>()));
    EXPECT_NO_THROW(read(rig)) << word;
  }
  for (const json& word : d.at("model").at("enum")) {
    rig["pairs"][0]["rectify_to"]["model"] = word;
    EXPECT_NO_THROW(read(rig)) << word;
  }
}

TEST(RigSchemaTest, LimitsAreTheSame) {
  const json d = schema().at("definitions");
  const auto limits = [&](const json& definition, const std::string& key, const json& in_list) {
    for (const auto& [bound, beyond] : {std::pair("minimum", -1), std::pair("maximum", 1)}) {
      const int value = definition.at(bound).get<int>();
      json rig = raw_rig();
      json& place = in_list.is_null() ? rig["pairs"][0][key] : rig["pairs"][0]["left"][key][0];
      place = value;
      EXPECT_NO_THROW(read(rig)) << key << " " << value;
      place = value + beyond;
      EXPECT_THAT(message_of([&] { read(rig); }), HasSubstr(key));
    }
  };
  limits(d.at("downscale"), "downscale", {});
  limits(d.at("rcrop_px"), "rcrop_px", {});
  limits(d.at("size").at("items"), "size_px", true);
}

}  // namespace
}  // namespace skyhalo

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "skyhalo/config/config.hpp"
#include "skyhalo/io/text_file.hpp"
#include "support/config_fields.hpp"
#include "support/temp_folder.hpp"

namespace skyhalo {
namespace {

using testing::config_keys;
using testing::ConfigKey;
using ::testing::HasSubstr;
using testing::TempFolder;

const std::filesystem::path kConfigFolder = std::filesystem::path(SKYHALO_SOURCE_DIR) / "config";

TEST(DumpTest, TheDefaultFileIsTheDefaults) {
  EXPECT_EQ(to_yaml(Config{}), read_bytes(kConfigFolder / "default.yaml"));
}

TEST(DumpTest, TheThesisFileDiffersOnlyInItsStepRuleAndMethod) {
  Config thesis;
  load_config(kConfigFolder / "thesis.yaml", thesis);
  EXPECT_NEAR(thesis.detector.sphere.bounds.step_rad, rad_from_deg(2.0), 1e-12);
  EXPECT_EQ(thesis.detector.sphere.depth.kind, DepthRuleKind::kThesis);
  EXPECT_EQ(thesis.detector.map.method, IntegrationMethod::kRays);
  thesis.detector.map.method = Config{}.detector.map.method;
  thesis.detector.sphere.depth.kind = Config{}.detector.sphere.depth.kind;
  thesis.detector.sphere.bounds.step_rad = Config{}.detector.sphere.bounds.step_rad;
  EXPECT_EQ(to_yaml(thesis), to_yaml(Config{}));
}

TEST(DumpTest, AnglesAreWrittenInWholeDegrees) {
  // 40 deg as radians and back is 40.00000000000001 when printed with all digits.
  Config config;
  config.detector.sphere.bounds.theta_min_rad = rad_from_deg(40.0);
  const std::string yaml = to_yaml(config);
  EXPECT_THAT(yaml, HasSubstr("theta_min_deg: 40 "));
  EXPECT_THAT(yaml, HasSubstr("phi_min_deg: -180 "));
  EXPECT_THAT(yaml, HasSubstr("seen_window_deg: 3 "));
}

TEST(DumpTest, EveryKeyIsInTheFile) {
  const std::string yaml = "\n" + to_yaml(Config{});
  for (const ConfigKey& entry : config_keys()) {
    const std::size_t dot = entry.key.find('.');
    EXPECT_THAT(yaml, HasSubstr("\n" + entry.key.substr(0, dot) + ":\n"));
    EXPECT_THAT(yaml, HasSubstr("\n  " + entry.key.substr(dot + 1) + ": "));
  }
}

TEST(DumpTest, EveryLineSaysWhatItMeans) {
  const TempFolder folder;
  for (const std::string& line : read_lines(folder.write("c.yaml", to_yaml(Config{})))) {
    if (line.starts_with("  ")) {
      EXPECT_THAT(line, HasSubstr(" # "));
    }
  }
}

TEST(DumpTest, TheDocumentationNamesEveryKeyWithItsDefault) {
  const std::string page = to_markdown(Config{});
  for (const ConfigKey& entry : config_keys()) {
    EXPECT_THAT(page, HasSubstr("`" + entry.key + "`"));
  }
  EXPECT_THAT(page, HasSubstr("`matching.matcher`"));
  EXPECT_THAT(page, HasSubstr("| `sphere.phi_max_deg` | 180 |"));
  EXPECT_THAT(page, HasSubstr("| `evaluation.labels_may_end_early` | false |"));
  EXPECT_THAT(page, HasSubstr("| `dataset.cameras` | auto |"));
}

TEST(DumpTest, AChangedValueIsReadBack) {
  const TempFolder folder;
  for (const ConfigKey& entry : config_keys()) {
    SCOPED_TRACE(entry.key);
    Config changed;
    set_value(entry.key + "=" + entry.value, changed);
    const std::string yaml = to_yaml(changed);
    const std::size_t dot = entry.key.find('.');
    EXPECT_THAT(yaml, HasSubstr("\n  " + entry.key.substr(dot + 1) + ": " + entry.value + " "));
    Config loaded;
    load_config(folder.write("c.yaml", yaml), loaded);
    EXPECT_EQ(to_yaml(loaded), yaml);
    EXPECT_NE(yaml, to_yaml(Config{}));
  }
}

}  // namespace
}  // namespace skyhalo

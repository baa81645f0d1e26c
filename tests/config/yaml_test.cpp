#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "skyhalo/config/config.hpp"
#include "support/config_fields.hpp"
#include "support/expect_error.hpp"
#include "support/temp_folder.hpp"

namespace skyhalo {
namespace {

using ::testing::AllOf;
using testing::config_keys;
using testing::ConfigKey;
using ::testing::HasSubstr;
using testing::message_of;
using testing::TempFolder;

/// A file that must be refused; the message must name its line and its key.
struct BadFile {
  std::string text;
  int line = 0;
  std::string key;
};

void expect_refused(const std::vector<BadFile>& cases) {
  const TempFolder folder;
  for (const BadFile& bad : cases) {
    SCOPED_TRACE(bad.text);
    const auto file = folder.write("bad.yaml", bad.text);
    Config config;
    config.bounds.ahead_m = 11.0;
    const std::string before = to_yaml(config);
    EXPECT_THAT(
        message_of([&] { load_config(file, config); }),
        AllOf(HasSubstr(file.string() + ":" + std::to_string(bad.line) + ":"), HasSubstr(bad.key)));
    EXPECT_TRUE(to_yaml(config) == before) << "an error must leave the configuration as it was";
  }
}

TEST(YamlTest, EveryKeyCanBeSet) {
  for (const ConfigKey& entry : config_keys()) {
    SCOPED_TRACE(entry.key);
    Config config;
    EXPECT_NO_THROW(set_value(entry.key + "=" + entry.value, config));
    EXPECT_NE(to_yaml(config), to_yaml(Config{}));
  }
  Config config;
  EXPECT_NO_THROW(set_value("matching.matcher=opencv", config));
}

TEST(YamlTest, SetsWhatItSays) {
  Config config;
  set_value("sphere.step_deg=2", config);
  set_value("opencv.paths=5", config);
  set_value("evaluation.labels_may_end_early=true", config);
  set_value("dataset.cameras=grey", config);
  set_value("bounds.bottom_m=-1.25", config);
  EXPECT_NEAR(config.detector.sphere.bounds.step_rad, 0.03490658503988659, 1e-15);
  EXPECT_EQ(config.detector.matching.matcher.opencv.paths, 5);
  EXPECT_TRUE(config.evaluation.labels_may_end_early);
  EXPECT_EQ(config.dataset.cameras, CameraChoice::kGrey);
  EXPECT_EQ(config.bounds.bottom_m, -1.25);
}

TEST(YamlTest, ReadsOverWhatIsThere) {
  const TempFolder folder;
  Config config;
  config.bounds.side_m = 7.0;
  config.detector.map.voxel_m = 0.25;
  load_config(folder.write("c.yaml", "map:\n  voxel_m: 0.125\nmatching:\n"), config);
  EXPECT_EQ(config.detector.map.voxel_m, 0.125);
  EXPECT_EQ(config.bounds.side_m, 7.0);
}

TEST(YamlTest, AnEmptyFileChangesNothing) {
  const TempFolder folder;
  Config config;
  load_config(folder.write("empty.yaml", ""), config);
  load_config(folder.write("comment.yaml", "# nothing\n"), config);
  EXPECT_EQ(to_yaml(config), to_yaml(Config{}));
}

TEST(YamlTest, ReadsWindowsLines) {
  const TempFolder folder;
  Config config;
  load_config(folder.write("c.yaml", "map:\r\n  voxel_m: 0.125\r\n"), config);
  EXPECT_EQ(config.detector.map.voxel_m, 0.125);
}

TEST(YamlTest, AnUnknownSectionOrKeyIsRefused) {
  expect_refused({{"# rig\nspheres:\n  step_deg: 1\n", 2, "spheres"},
                  {"map:\n  voxel_m: 1\n  voxels: 2\n", 3, "map.voxels"},
                  {"sphere:\n  step_rad: 0.1\n", 2, "sphere.step_rad"},
                  {"sphere:\n  max_range_mm: 3\n", 2, "sphere.max_range_mm"},
                  {"voxel_m: 0.5\n", 1, "voxel_m"}});
}

TEST(YamlTest, AnUnknownKeySaysWhatIsKnown) {
  Config config;
  EXPECT_THAT(message_of([&] { set_value("map.voxel=1", config); }),
              AllOf(HasSubstr("map.voxel"), HasSubstr("voxel_m"), HasSubstr("log_odds_limit")));
}

TEST(YamlTest, AWrongTypeIsRefused) {
  expect_refused({{"matching:\n  downscale: two\n", 2, "matching.downscale"},
                  {"matching:\n  downscale: 1.5\n", 2, "matching.downscale"},
                  {"opencv:\n\n  paths: [3]\n", 3, "opencv.paths"},
                  {"map:\n  voxel_m: 0.5 m\n", 2, "map.voxel_m"},
                  {"sphere:\n  step_deg: {a: 1}\n", 2, "sphere.step_deg"},
                  {"evaluation:\n  labels_may_end_early: 2\n", 2, "labels_may_end_early"},
                  {"dataset:\n  cameras: left\n", 2, "dataset.cameras"},
                  {"matching:\n  masks_px: [1, 2, 3, 4]\n", 2, "matching.masks_px"},
                  {"matching:\n  masks_px: [[1, 2, 3]]\n", 2, "matching.masks_px"},
                  {"matching:\n  masks_px: [[1, 2, 3, 0]]\n", 2, "matching.masks_px"},
                  {"sphere: 3\n", 1, "sphere"},
                  {"sphere: [step_deg]\n", 1, "sphere"}});
}

TEST(YamlTest, AKeyGivenTwiceIsRefused) {
  expect_refused({{"map:\n  voxel_m: 0.5\n  voxel_m: 0.4\n", 3, "map.voxel_m"},
                  {"map:\n  voxel_m: 0.5\nmap:\n  voxel_m: 0.4\n", 3, "map"}});
}

TEST(YamlTest, AKeyWithoutAValueIsRefused) {
  expect_refused({{"map:\n  voxel_m:\n  log_odds_limit: 5\n", 2, "map.voxel_m"},
                  {"map:\n  voxel_m:\n", 2, "map.voxel_m"}});
}

TEST(YamlTest, AValueOutsideItsDomainIsRefused) {
  expect_refused({{"map:\n  voxel_m: -0.5\n", 2, "map.voxel_m"},
                  {"map:\n  voxel_m: .nan\n", 2, "map.voxel_m"},
                  {"bounds:\n  ahead_m: 3\n  side_m: 0\n", 3, "bounds.side_m"},
                  {"sensor_model:\n  k: 1\n", 2, "sensor_model.k"},
                  {"evaluation:\n  occupied_probability: 70\n", 2, "occupied_probability"}});
}

TEST(YamlTest, AMatcherValueOutsideItsDomainIsRefused) {
  expect_refused({{"matching:\n  max_disparity_px: 20\n", 2, "matching.max_disparity_px"},
                  {"opencv:\n  block_px: 2\n", 2, "opencv.block_px"},
                  {"opencv:\n  paths: 7\n", 2, "opencv.paths"}});
}

TEST(YamlTest, AGridThatDoesNotFitIsRefused) {
  expect_refused({{"sphere:\n  step_deg: 0\n", 2, "sphere.step_deg"},
                  {"sphere:\n  theta_max_deg: 181\n", 2, "sphere.theta_max_deg"}});
}

TEST(YamlTest, ASyntaxErrorIsRefused) {
  expect_refused({{"map:\n  voxel_m: [1\n", 3, ""},
                  {"map:\n  voxel_m: 1\n bad: : 2\n", 3, ""},
                  {"map:\n\tvoxel_m: 1\n", 2, ""}});
}

TEST(YamlTest, AFileOfNoSectionsIsRefused) {
  expect_refused({{"- map\n- sphere\n", 1, ""}, {"just words\n", 1, ""}});
}

TEST(YamlTest, AFileThatCannotBeReadIsNamed) {
  const TempFolder folder;
  Config config;
  const auto missing = folder.path() / "missing.yaml";
  EXPECT_THAT(message_of([&] { load_config(missing, config); }), HasSubstr(missing.string()));
  EXPECT_THAT(message_of([&] { load_config(folder.path(), config); }),
              HasSubstr(folder.path().string()));
}

TEST(YamlTest, AFileNamedLikeASectionIsStillNamed) {
  const TempFolder folder;
  const auto before = std::filesystem::current_path();
  (void)folder.write("map", "map:\n  voxel_m: -1\n");
  std::filesystem::current_path(folder.path());
  Config config;
  const std::string message = message_of([&] { load_config("map", config); });
  std::filesystem::current_path(before);
  EXPECT_THAT(message, ::testing::StartsWith("map:"));
}

TEST(YamlTest, AMalformedAssignmentIsRefused) {
  for (const std::string bad : {"",
                                "map",
                                "map.voxel_m",
                                "voxel_m=1",
                                "map=voxel_m.1",
                                "map.voxel_m=",
                                "map.voxel_m=x",
                                "map.voxel_m=[1",
                                "sphere.step_rad=0.1",
                                "maps.voxel_m=1",
                                "map.=1",
                                ".voxel_m=1",
                                "map.voxel_m.x=1",
                                "opencv.paths=3.5"}) {
    SCOPED_TRACE(bad);
    Config config;
    EXPECT_THAT(message_of([&] { set_value(bad, config); }), HasSubstr(bad));
    EXPECT_EQ(to_yaml(config), to_yaml(Config{}));
  }
}

TEST(YamlTest, AnAssignmentOutsideItsDomainIsSeenAtTheLatestByTheCheck) {
  Config config;
  EXPECT_THAT(message_of([&] {
                set_value("map.voxel_m=-1", config);
                check(config);
              }),
              HasSubstr("map.voxel_m"));
}

/// A random configuration inside its domain; numbers have few digits, as people write them.
Config random_config(std::mt19937& random) {
  const auto pick = [&](double from, double to) {
    return std::round(std::uniform_real_distribution(from, to)(random) * 1000.0) / 1000.0;
  };
  const auto whole = [&](int from, int to) {
    return std::uniform_int_distribution(from, to)(random);
  };
  Config config;
  config.dataset.cameras = static_cast<CameraChoice>(whole(0, 2));
  config.detector.matching.downscale = whole(1, 16);
  config.detector.matching.rcrop_px = whole(0, 100);
  config.detector.matching.matcher.max_disparity_px = 16 * whole(1, 16);
  config.detector.matching.matcher.opencv.block_px = 2 * whole(0, 5) + 1;
  config.detector.sphere.bounds.theta_min_rad = rad_from_deg(whole(0, 80));
  config.detector.sphere.bounds.phi_max_rad = rad_from_deg(whole(-40, 180));
  config.detector.sphere.depth.sigma_threshold_m = pick(0.0, 2.0);
  config.detector.sensor_model.k = pick(0.01, 0.99);
  config.detector.sensor_model.p_free = pick(0.01, 0.5);
  config.detector.map.voxel_m = pick(0.01, 2.0);
  config.bounds.behind_m = pick(0.0, 30.0);
  config.bounds.bottom_m = pick(-20.0, 0.0);
  config.evaluation.occupied_probability = pick(0.01, 0.99);
  config.evaluation.labels_may_end_early = whole(0, 1) == 1;
  return config;
}

TEST(YamlProperty, WhatIsWrittenIsReadBackUnchanged) {
  const TempFolder folder;
  std::mt19937 random(20);
  for (int round = 0; round < 50; ++round) {
    const Config config = random_config(random);
    Config loaded;
    load_config(folder.write("c.yaml", to_yaml(config)), loaded);
    EXPECT_EQ(loaded.dataset.cameras, config.dataset.cameras);
    EXPECT_EQ(loaded.detector.matching.downscale, config.detector.matching.downscale);
    EXPECT_EQ(loaded.detector.matching.matcher.opencv.block_px,
              config.detector.matching.matcher.opencv.block_px);
    EXPECT_NEAR(loaded.detector.sphere.bounds.theta_min_rad,
                config.detector.sphere.bounds.theta_min_rad,
                1e-12);
    EXPECT_NEAR(loaded.detector.sphere.bounds.phi_max_rad,
                config.detector.sphere.bounds.phi_max_rad,
                1e-12);
    EXPECT_EQ(loaded.detector.sensor_model.k, config.detector.sensor_model.k);
    EXPECT_EQ(loaded.detector.map.voxel_m, config.detector.map.voxel_m);
    EXPECT_EQ(loaded.bounds.bottom_m, config.bounds.bottom_m);
    EXPECT_EQ(loaded.evaluation.labels_may_end_early, config.evaluation.labels_may_end_early);
    EXPECT_EQ(to_yaml(loaded), to_yaml(config));
  }
}

TEST(YamlProperty, AFileCutOffAnywhereGivesAResultOrAnError) {
  const TempFolder folder;
  const std::string yaml = to_yaml(Config{});
  for (std::size_t length = 0; length < yaml.size(); length += 7) {
    Config config;
    try {
      load_config(folder.write("c.yaml", yaml.substr(0, length)), config);
      EXPECT_NO_THROW(check(config));
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::kInput);
      EXPECT_THAT(error.what(), HasSubstr("c.yaml"));
    }
  }
}

}  // namespace
}  // namespace skyhalo

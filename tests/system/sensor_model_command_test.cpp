// `skyhalo sensor-model` as its users see it: tables, files, figures of the thesis, wrong usage.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "skyhalo/io/text_file.hpp"
#include "support/program.hpp"
#include "support/temp_folder.hpp"
#include "support/xml.hpp"

namespace skyhalo {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using ::testing::AllOf;
using testing::Arguments;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using testing::operator+;
using testing::ProgramResult;
using testing::run_program;
using testing::TempFolder;
using testing::xml_fault;

using Table = std::vector<std::vector<double>>;

const Arguments kPinhole{"--model", "pinhole", "--baseline-m", "0.1", "--focal-px", "500"};
const Arguments kSpherical{
    "--model", "spherical", "--baseline-m", "0.1", "--delta-theta-u-rad", "0.002"};

/// The numbers below the header of a CSV file.
Table numbers_in(const std::vector<std::string>& lines) {
  Table table;
  for (std::size_t i = 1; i < lines.size(); ++i) {
    std::vector<double> row;
    std::istringstream stream(lines[i]);
    for (std::string word; std::getline(stream, word, ',');) {
      row.push_back(parse_number(word).value_or(std::nan("")));
    }
    table.push_back(row);
  }
  return table;
}

class SensorModelSystem : public ::testing::Test {
 protected:
  [[nodiscard]] ProgramResult run(const Arguments& arguments) const {
    return run_program(SKYHALO_PROGRAM, Arguments{"sensor-model"} + arguments, root.path());
  }

  [[nodiscard]] std::string place(const std::string& name) const {
    return (root.path() / name).string();
  }

  [[nodiscard]] json summary(const Arguments& arguments) const {
    const ProgramResult r = run(arguments + Arguments{"--json", "--quiet"});
    EXPECT_EQ(r.exit_code, 0) << r.err;
    return json::parse(r.out, nullptr, false);
  }

  /// The lines of the CSV file that the command writes.
  [[nodiscard]] std::vector<std::string> csv(const Arguments& arguments) const {
    const ProgramResult r = run(arguments + Arguments{"--csv", place("samples.csv")});
    EXPECT_EQ(r.exit_code, 0) << r.err;
    return r.exit_code == 0 ? read_lines(place("samples.csv")) : std::vector<std::string>{};
  }

  void expect_refused(const Arguments& arguments,
                      int exit_code,
                      const std::vector<std::string>& words) const {
    SCOPED_TRACE(::testing::PrintToString(arguments));
    const ProgramResult r = run(arguments);
    EXPECT_EQ(r.exit_code, exit_code);
    EXPECT_EQ(std::count(r.err.begin(), r.err.end(), '\n'), 1) << r.err;
    EXPECT_THAT(r.out, IsEmpty());
    for (const std::string& word : words) {
      EXPECT_THAT(r.err, HasSubstr(word));
    }
  }

  TempFolder root;
};

// --- the inverse sensor model ---

TEST_F(SensorModelSystem, TheTableIsAllWithoutFiles) {
  const ProgramResult r = run(kPinhole);
  EXPECT_EQ(r.exit_code, 0) << r.err;
  // delta_z = z^2 / 100; the peak is 0.5 + 0.375 exp(-delta_z): 0.87127, 0.79205, 0.63795.
  EXPECT_THAT(r.out, AllOf(HasSubstr("| 1 | 0.01 | 0.871 |"), HasSubstr("| 5 | 0.25 | 0.792 |")));
  EXPECT_THAT(r.out, AllOf(HasSubstr("| 10 | 1 | 0.638 |"), HasSubstr("at 7.928 m")));
  EXPECT_THAT(r.out, Not(HasSubstr("Written")));
  EXPECT_THAT(r.err, IsEmpty());
}

TEST_F(SensorModelSystem, TheCsvHasTheModelAlongEachRay) {
  const auto lines = csv(kPinhole + Arguments{"--z", "2,5"});
  ASSERT_FALSE(lines.empty());
  EXPECT_EQ(lines[0], "z_m,m_m,delta_z_m,p");
  std::map<double, int> peaks;
  std::map<double, double> last_m;
  for (const auto& row : numbers_in(lines)) {
    ASSERT_EQ(row.size(), 4U);
    const double z_m = row[0];
    ASSERT_NEAR(row[2], z_m * z_m / 100.0, 1e-9);
    ASSERT_GT(row[1], last_m[z_m]);
    last_m[z_m] = row[1];
    ASSERT_TRUE(row[3] >= 0.3 && row[3] <= 0.875);
    if (row[1] == z_m) {
      ++peaks[z_m];
      EXPECT_NEAR(row[3], 0.5 + 0.375 * std::exp(-z_m * z_m / 100.0), 1e-8);
    }
  }
  EXPECT_EQ(peaks, (std::map<double, int>{{2.0, 1}, {5.0, 1}}));
  // At most 100 even steps, the first one, z, and 60 on either side.
  EXPECT_GT(lines.size(), 2U * 150U);
  EXPECT_LE(lines.size(), 1U + 2U * 222U);
}

TEST_F(SensorModelSystem, TheSphericalModel) {
  // 0.1 * 0.002 * (1 + (2 / 0.1)^2) * 0.5.
  const json result = summary(kSpherical + Arguments{"--z", "2"});
  EXPECT_EQ(result["model"], "spherical");
  EXPECT_NEAR(result["measurements"][0]["delta_z_m"], 0.0401, 1e-12);
  EXPECT_EQ(result["delta_theta_u_rad"], 0.002);
  EXPECT_FALSE(result.contains("focal_px"));
}

TEST_F(SensorModelSystem, TheSvgHasTwoChartsAndIsWellFormed) {
  ASSERT_EQ(run(kPinhole + Arguments{"--svg", place("a.svg")}).exit_code, 0);
  const std::string svg = read_bytes(place("a.svg"));
  EXPECT_EQ(xml_fault(svg), "");
  EXPECT_THAT(svg, AllOf(HasSubstr(">z = 5 m</text>"), HasSubstr(">range uncertainty Δz (m)<")));
  ASSERT_EQ(run(kPinhole + Arguments{"--svg", place("b.svg")}).exit_code, 0);
  EXPECT_EQ(svg, read_bytes(place("b.svg")));
}

TEST_F(SensorModelSystem, AllNumbersCanBeGiven) {
  const json result = summary({"--model",
                               "pinhole",
                               "--baseline-m",
                               "0.5",
                               "--focal-px",
                               "400",
                               "--delta-d-px",
                               "1",
                               "--k",
                               "0.8",
                               "--p-free",
                               "0.2",
                               "--p-unknown",
                               "0.4",
                               "--z",
                               "10"});
  EXPECT_EQ(result["baseline_m"], 0.5);
  EXPECT_EQ(result["focal_px"], 400.0);
  EXPECT_EQ(result["delta_d_px"], 1.0);
  EXPECT_EQ(result["k"], 0.8);
  EXPECT_EQ(result["p_free"], 0.2);
  EXPECT_EQ(result["p_unknown"], 0.4);
  ASSERT_EQ(result["measurements"].size(), 1U);
  EXPECT_NEAR(result["measurements"][0]["delta_z_m"], 0.5, 1e-12);  // 100 * 1 / 200
  EXPECT_NEAR(result["measurements"][0]["peak_probability"], 0.4 + 0.48 * std::exp(-0.5), 1e-12);
}

TEST_F(SensorModelSystem, SettingsOfTheConfigurationAreTheDefaults) {
  const Arguments set{
      "--set", "sensor_model.k=0.5", "--set", "evaluation.occupied_probability=0.5"};
  EXPECT_EQ(summary(kPinhole + set)["k"], 0.5);
  EXPECT_EQ(summary(kPinhole + set + Arguments{"--k", "0.6"})["k"], 0.6);
  EXPECT_TRUE(summary(kPinhole + set)["occupied_until_m"].is_null()) << "above 0.5 everywhere";
  EXPECT_EQ(summary(kPinhole)["delta_d_px"], 0.5);
}

// --- the figures of the thesis ---

TEST_F(SensorModelSystem, FiguresHaveTheThesissParameters) {
  const auto expect = [&](const std::string& figure, const std::string& key, double value) {
    const json result = summary({"--figure", figure});
    EXPECT_EQ(result["figure"], figure);
    EXPECT_EQ(result["model"], key == "focal_px" ? "pinhole" : "spherical");
    EXPECT_EQ(result["baseline_m"], 0.1);
    EXPECT_NEAR(result[key], value, 1e-15);
    EXPECT_EQ(result["k"], 0.75);
    EXPECT_EQ(result["p_unknown"], 0.5);
    EXPECT_EQ(result["p_free"], 0.3);
  };
  expect("4.1", "focal_px", 250.0);
  expect("4.2", "delta_theta_u_rad", 0.002);
  expect("6.1", "focal_px", 500.0);
  expect("6.2", "delta_theta_u_rad", 2.5 / 1200.0);
}

TEST_F(SensorModelSystem, WhatIsGivenWinsOverTheFigure) {
  const json changed = summary({"--figure", "6.1", "--focal-px", "250", "--k", "0.5", "--z", "3"});
  EXPECT_EQ(changed["focal_px"], 250.0);
  EXPECT_EQ(changed["baseline_m"], 0.1);
  EXPECT_EQ(changed["k"], 0.5);
  EXPECT_EQ(changed["measurements"].size(), 1U);
  EXPECT_EQ(summary(Arguments{"--figure", "6.1"} + kSpherical)["model"], "spherical");
}

TEST_F(SensorModelSystem, Figure41IsTheUncertaintyByColumn) {
  const auto lines = csv({"--figure", "4.1"});
  ASSERT_FALSE(lines.empty());
  EXPECT_EQ(lines[0], "u_px,d_px,range_m,delta_x_m,delta_y_m,delta_z_m");
  std::set<double> columns;
  for (const auto& row : numbers_in(lines)) {
    ASSERT_EQ(row.size(), 6U);
    columns.insert(row[0]);
    // eq. 4.2 with B 0.1, u0 600, f 250 and delta_d 0.5; v = v0.
    const double per_px = 0.1 / (row[1] * row[1]) * 0.5;
    EXPECT_NEAR(row[3], std::abs(row[0] - 600.0) * per_px, 1e-7 * row[3] + 1e-12);
    EXPECT_EQ(row[4], 0.0);
    EXPECT_NEAR(row[5], 250.0 * per_px, 1e-7 * row[5]);
    const double depth_m = 250.0 * 0.1 / row[1];
    EXPECT_NEAR(row[2], std::hypot(depth_m, (row[0] - 600.0) * 0.1 / row[1]), 1e-7 * row[2]);
  }
  // Every hundredth column of 1200, and the last.
  EXPECT_EQ(columns.size(), 13U);
  EXPECT_EQ(*columns.begin(), 0.0);
  EXPECT_EQ(*columns.rbegin(), 1199.0);
  EXPECT_EQ(lines.size(), 1U + 13U * 101U);
}

TEST_F(SensorModelSystem, Figure42IsTheUncertaintyByColumn) {
  const auto lines = csv({"--figure", "4.2", "--z", "8"});
  EXPECT_EQ(lines.size(), 1U + 13U * 101U);
  for (const auto& row : numbers_in(lines)) {
    // eq. 4.7 with B 0.1, u0 600, delta_theta 0.002 and delta_d 0.5; v = v0.
    const double alpha = (row[0] - 600.0) * 0.002;
    const double delta = row[1] * 0.002;
    const double along = 0.1 * std::cos(alpha) * 0.002 * (1.0 + 1.0 / std::pow(std::tan(delta), 2));
    EXPECT_NEAR(row[3], std::abs(std::sin(alpha)) * along * 0.5, 1e-6 * row[3] + 1e-12);
    EXPECT_NEAR(row[5], std::cos(alpha) * along * 0.5, 1e-6 * row[5]);
    EXPECT_NEAR(row[2], 0.1 * std::cos(alpha + delta) / std::sin(delta), 1e-6 * row[2] + 1e-8);
    EXPECT_LE(row[2], 8.0);
  }
}

TEST_F(SensorModelSystem, FiguresCanBeDrawn) {
  for (const std::string figure : {"4.1", "4.2", "6.1", "6.2"}) {
    ASSERT_EQ(run({"--figure", figure, "--svg", place("figure.svg")}).exit_code, 0);
    const std::string svg = read_bytes(place("figure.svg"));
    EXPECT_EQ(xml_fault(svg), "");
    EXPECT_THAT(svg, HasSubstr(figure.starts_with("4") ? ">u = 400 (" : ">z = 10 m</text>"));
  }
}

TEST_F(SensorModelSystem, ColumnsWithoutARayAreLeftOut) {
  // 0.005 rad: columns more than 314 px from the centre look backwards.
  const Arguments wide{"--figure", "4.2", "--delta-theta-u-rad", "0.005"};
  EXPECT_EQ(csv(wide).size(), 1U + 7U * 101U);  // 300, 400, ... 900
  ASSERT_EQ(run(wide + Arguments{"--svg", place("figure.svg")}).exit_code, 0);
  EXPECT_EQ(xml_fault(read_bytes(place("figure.svg"))), "");
}

// --- usage ---

TEST_F(SensorModelSystem, TheHelpNamesEveryOption) {
  const ProgramResult r = run({"--help"});
  EXPECT_EQ(r.exit_code, 0);
  for (const std::string option : {"--model",
                                   "--baseline-m",
                                   "--focal-px",
                                   "--delta-theta-u-rad",
                                   "--k ",
                                   "--delta-d-px",
                                   "--p-free",
                                   "--p-unknown",
                                   "--z ",
                                   "--csv",
                                   "--svg",
                                   "--figure",
                                   "--config",
                                   "--set",
                                   "--threads",
                                   "--json",
                                   "--quiet",
                                   "z_m,m_m,delta_z_m,p"}) {
    EXPECT_THAT(r.out, HasSubstr(option));
  }
}

TEST_F(SensorModelSystem, WhatIsMissingIsNamed) {
  expect_refused({}, 2, {"--model"});
  expect_refused({"--model", "pinhole", "--focal-px", "500"}, 2, {"--baseline-m"});
  expect_refused({"--model", "pinhole", "--baseline-m", "0.1"}, 2, {"--focal-px"});
  expect_refused({"--model", "spherical", "--baseline-m", "0.1"}, 2, {"--delta-theta-u-rad"});
  expect_refused({"--figure", "6.1", "--model", "spherical"}, 2, {"--delta-theta-u-rad"});
}

TEST_F(SensorModelSystem, WhatDoesNotGoTogetherIsWrongUsage) {
  expect_refused(kSpherical + Arguments{"--focal-px", "500"}, 2, {"--focal-px", "spherical"});
  expect_refused(
      kPinhole + Arguments{"--delta-theta-u-rad", "0.002"}, 2, {"--delta-theta-u-rad", "pinhole"});
  expect_refused({"--figure", "6.2", "--focal-px", "500"}, 2, {"--focal-px", "spherical"});
}

TEST_F(SensorModelSystem, NumbersOutsideTheirDomainAreWrongUsage) {
  for (const std::string bad : {"0", "-1", "nan", "inf", "wide", "", "0.1m"}) {
    expect_refused(Arguments{"--figure", "6.1", "--baseline-m", bad}, 2, {"--baseline-m", bad});
    expect_refused(Arguments{"--figure", "6.1", "--focal-px", bad}, 2, {"--focal-px", bad});
    expect_refused(
        Arguments{"--figure", "6.2", "--delta-theta-u-rad", bad}, 2, {"--delta-theta-u-rad", bad});
  }
  for (const std::string bad : {"0", "1", "2"}) {
    expect_refused(kPinhole + Arguments{"--k", bad}, 2, {"--k: "});
  }
  expect_refused(kPinhole + Arguments{"--p-free", "0.6"}, 2, {"--p-free: "});
  expect_refused(kPinhole + Arguments{"--p-unknown", "0.2"}, 2, {"--p-unknown: "});
  expect_refused(kPinhole + Arguments{"--delta-d-px", "0"}, 2, {"--delta-d-px: "});
}

TEST_F(SensorModelSystem, MalformedMeasurementsAreWrongUsage) {
  for (const std::string bad :
       {"", ",", "1,,2", "1,2,", "0", "-1", "1,0", "one", "1;2", "nan", "2e6"}) {
    expect_refused(kPinhole + Arguments{"--z", bad}, 2, {"--z " + bad});
  }
}

TEST_F(SensorModelSystem, UnknownWordsAreWrongUsage) {
  for (const Arguments& arguments : std::vector<Arguments>{{"--model", "fisheye"},
                                                           {"--figure", "6.3"},
                                                           {"--figure", ""},
                                                           {"--z"},
                                                           {"--fly"},
                                                           {"6.1"}}) {
    const ProgramResult r = run(arguments);
    EXPECT_EQ(r.exit_code, 2) << ::testing::PrintToString(arguments);
    EXPECT_THAT(r.err, Not(IsEmpty()));
    EXPECT_THAT(r.out, IsEmpty());
  }
}

TEST_F(SensorModelSystem, ABadSettingIsBadInput) {
  expect_refused(kPinhole + Arguments{"--set", "sensor_model.k=2"}, 3, {"sensor_model.k"});
  expect_refused(kPinhole + Arguments{"--config", place("none.yaml")}, 3, {place("none.yaml")});
}

// --- files ---

TEST_F(SensorModelSystem, BothFilesAreNamedAndNothingElseStays) {
  fs::create_directory(place("out"));
  const ProgramResult r =
      run(kPinhole + Arguments{"--csv", place("out/a.csv"), "--svg", place("out/a.svg"), "--json"});
  EXPECT_EQ(r.exit_code, 0) << r.err;
  EXPECT_THAT(r.out, AllOf(HasSubstr("Written: " + place("out/a.csv")), HasSubstr("\"svg\":")));
  std::set<std::string> names;
  for (const fs::directory_entry& entry : fs::directory_iterator(place("out"))) {
    names.insert(entry.path().filename().string());
  }
  EXPECT_EQ(names, (std::set<std::string>{"a.csv", "a.svg"}));
}

TEST_F(SensorModelSystem, AnEarlierFileIsReplaced) {
  (void)root.write("samples.csv", "old");
  EXPECT_EQ(csv(kPinhole).at(0), "z_m,m_m,delta_z_m,p");
}

TEST_F(SensorModelSystem, AnOutputThatCannotBeWrittenIsAFailure) {
  (void)root.write("file", "in the way");
  (void)root.write("folder/inside", "mine");
  for (const std::string option : {"--csv", "--svg"}) {
    for (const std::string name : {"file/a", "folder", "none/a"}) {
      expect_refused(kPinhole + Arguments{option, place(name)}, 1, {place(name)});
    }
  }
  EXPECT_EQ(read_bytes(place("file")), "in the way");
  EXPECT_FALSE(fs::exists(place("none")));
}

TEST_F(SensorModelSystem, FileNamesThatAreNoneAreWrongUsage) {
  expect_refused(kPinhole + Arguments{"--csv", ""}, 2, {"--csv"});
  expect_refused(kPinhole + Arguments{"--svg", place("new") + "/"}, 2, {"--svg"});
  expect_refused(
      kPinhole + Arguments{"--csv", place("a"), "--svg", place("./a")}, 2, {"same file"});
  EXPECT_FALSE(fs::exists(place("a")));
}

TEST_F(SensorModelSystem, QuietPrintsNothing) {
  const ProgramResult r = run(kPinhole + Arguments{"--quiet"});
  EXPECT_EQ(r.exit_code, 0);
  EXPECT_THAT(r.out, IsEmpty());
  EXPECT_THAT(r.err, IsEmpty());
}

}  // namespace
}  // namespace skyhalo

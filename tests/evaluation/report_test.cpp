#include "skyhalo/evaluation/report.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "skyhalo/evaluation/report_template.hpp"

namespace skyhalo {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::SizeIs;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

EvaluationResult some_result() {
  EvaluationResult result;
  result.version = "1.2.3";
  result.sequence = "0042";
  result.source = "a drive";
  result.grid = {.min_m = {0.0, -2.0, -1.0}, .voxel_m = 0.5, .size = {20, 8, 4}};
  result.max_range_m = 33.0;
  result.occupied_cells = 9;
  result.skipped_scans = {3, 5};
  result.rows = {
      {7, {0, 0, 631, 9, 0.9859375, kNan, 0.0, 1.0, 0.9859375, kNan, kNan}},
      {8, {6, 2, 629, 3, 0.9921875, 0.75, 0.6666667, 0.9968304, 0.9952532, 0.061, 0.703}}};
  result.stages = {{"match", 12.5, 20.25}};
  result.pictures = {{"From above", "x to the right", "\x89PNG"}};
  result.duration_s = 1.5;
  result.config_yaml = "map:\n  voxel_m: 0.5\n";
  return result;
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) {
    lines.push_back(line);
  }
  return lines;
}

/// The fields of a line, empty ones too.
std::vector<std::string> fields_of(const std::string& line, char separator) {
  std::vector<std::string> fields;
  std::istringstream stream(line + separator);
  for (std::string field; std::getline(stream, field, separator);) {
    fields.push_back(field);
  }
  return fields;
}

/// The data of a page: what stands between `const data = ` and the end of that line.
json page_data(const std::string& page) {
  const std::string start = "const data = ";
  const std::size_t from = page.find(start) + start.size();
  const std::string text = page.substr(from, page.find(";\n", from) - from);
  return json::parse(text, nullptr, false);
}

TEST(ReportTest, TheCsvHasTheContractsHeader) {
  const auto lines = lines_of(metrics_csv(some_result()));
  ASSERT_THAT(lines, SizeIs(3));
  EXPECT_EQ(lines[0],
            "frame,tp,fp,tn,fn,accuracy,precision,recall,specificity,npv,error,correlation");
}

TEST(ReportTest, TheCsvHasARowForEachFrame) {
  const auto lines = lines_of(metrics_csv(some_result()));
  ASSERT_THAT(lines, SizeIs(3));
  const auto fields = fields_of(lines[2], ',');
  ASSERT_THAT(fields, SizeIs(12));
  const std::vector<double> expected{
      8, 6, 2, 629, 3, 0.9921875, 0.75, 0.6666667, 0.9968304, 0.9952532, 0.061, 0.703};
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_NEAR(std::stod(fields[i]), expected[i], 1e-6) << i;
  }
  EXPECT_EQ(fields[0], "8");
  EXPECT_EQ(fields[3], "629");
}

TEST(ReportTest, AScoreThatIsNotDefinedIsAnEmptyField) {
  const auto lines = lines_of(metrics_csv(some_result()));
  ASSERT_THAT(lines, SizeIs(3));
  const auto fields = fields_of(lines[1], ',');
  ASSERT_THAT(fields, SizeIs(12));
  EXPECT_EQ(fields[6], "");
  EXPECT_NE(fields[7], "");
  EXPECT_EQ(fields[10], "");
  EXPECT_EQ(fields[11], "");
}

TEST(ReportTest, WithoutFramesTheCsvIsItsHeader) {
  EvaluationResult result = some_result();
  result.rows.clear();
  EXPECT_THAT(lines_of(metrics_csv(result)), SizeIs(1));
}

TEST(ReportTest, TheTableHasTheLastRowInTheColumnsOfTheThesis) {
  const auto lines = lines_of(metrics_table(some_result()));
  ASSERT_THAT(lines, SizeIs(4));  // the thesis prints no sequence 0042
  EXPECT_EQ(lines[0],
            "| seq | TP | FP | TN | FN | accuracy | precision | recall | specificity | npv | error "
            "| correlation |");
  EXPECT_EQ(lines[2],
            "| 0042 | 6 | 2 | 629 | 3 | 0.992 | 0.750 | 0.667 | 0.997 | 0.995 | 0.061 | 0.703 |");
  EXPECT_THAT(lines[3], HasSubstr("| 0042, observed cells |"));
}

TEST(ReportTest, TheTableHasTheThesisRowWhereThereIsOne) {
  EvaluationResult result = some_result();
  result.sequence = "0003";
  const auto lines = lines_of(metrics_table(result));
  ASSERT_THAT(lines, SizeIs(5));
  EXPECT_THAT(lines[2], HasSubstr("| 6 | 2 | 629 | 3 |"));
  EXPECT_THAT(lines[4], HasSubstr("thesis"));
  EXPECT_THAT(lines[4],
              HasSubstr("| 17995 | 5544 | 843943 | 12518 | 0.979 | 0.764 | 0.590 | 0.993 "
                        "| 0.985 | 0.084 | 0.534 |"));
}

TEST(ReportTest, EveryRowOfTheTableHasTheSameColumns) {
  EvaluationResult result = some_result();
  result.sequence = "0003";
  result.rows.pop_back();  // the last row now has scores that are not defined
  for (const std::string& line : lines_of(metrics_table(result))) {
    EXPECT_EQ(std::count(line.begin(), line.end(), '|'), 13) << line;
  }
}

TEST(ReportTest, TheSummaryHasTheLastRowByTheNamesOfTheCsv) {
  const EvaluationResult result = some_result();
  const json summary = metrics_summary(result);
  for (const std::string& name : fields_of(lines_of(metrics_csv(result)).front(), ',')) {
    EXPECT_TRUE(summary.contains(name)) << name;
  }
  EXPECT_EQ(summary["frame"], 8);
  EXPECT_EQ(summary["tp"], 6);
  EXPECT_EQ(summary["precision"], 0.75);
  ASSERT_THAT(summary["sequences"], SizeIs(1));
  EXPECT_EQ(summary["sequences"][0]["sequence"], "0042");
  EXPECT_EQ(summary["sequences"][0]["recall"], 0.6666667);
}

TEST(ReportTest, TheSummarySaysWhatWasDone) {
  const json summary = metrics_summary(some_result());
  EXPECT_EQ(summary["version"], "1.2.3");
  EXPECT_EQ(summary["source"], "a drive");
  EXPECT_EQ(summary["frames"], 2);
  EXPECT_EQ(summary["cells"], 640);  // 20 * 8 * 4
  EXPECT_EQ(summary["occupied_cells"], 9);
  EXPECT_EQ(summary["bounds_m"], json({0.0, 10.0, -2.0, 2.0, -1.0, 1.0}));
  EXPECT_EQ(summary["voxel_m"], 0.5);
  EXPECT_EQ(summary["skipped_scans"], json({3, 5}));
}

TEST(ReportTest, AScoreThatIsNotDefinedIsNull) {
  EvaluationResult result = some_result();
  result.rows.pop_back();
  const json summary = metrics_summary(result);
  EXPECT_TRUE(summary["precision"].is_null());
  EXPECT_TRUE(summary["correlation"].is_null());
  EXPECT_EQ(summary["recall"], 0.0);
  EXPECT_TRUE(summary["sequences"][0]["error"].is_null());
  EXPECT_THAT(summary.dump(), Not(HasSubstr("nan")));
}

TEST(ReportTest, WithoutFramesThereIsStillASummary) {
  EvaluationResult result = some_result();
  result.rows.clear();
  const json summary = metrics_summary(result);
  EXPECT_EQ(summary["frames"], 0);
  EXPECT_TRUE(summary["sequences"].empty());
}

TEST(ReportTest, ThePageTakesThePlaceOfTheTemplatesData) {
  const std::string placeholder = "/*SKYHALO_DATA*/null";
  ASSERT_THAT(std::string(kReportTemplate), HasSubstr(placeholder));
  EXPECT_THAT(metrics_report(some_result()), Not(HasSubstr(placeholder)));
}

TEST(ReportTest, ThePageHoldsTheDataAsJson) {
  const json data = page_data(metrics_report(some_result()));
  ASSERT_TRUE(data.is_object());
  EXPECT_EQ(data["sequence"], "0042");
  ASSERT_THAT(data["rows"], SizeIs(2));
  EXPECT_EQ(data["rows"][0]["frame"], 7);
  EXPECT_TRUE(data["rows"][0]["precision"].is_null());
  EXPECT_EQ(data["rows"][1]["tn"], 629);
  EXPECT_TRUE(data["reference"].is_null());
  EXPECT_EQ(data["config_yaml"], "map:\n  voxel_m: 0.5\n");
  EXPECT_EQ(data["stages"][0]["p95_ms"], 20.25);
  ASSERT_THAT(data["pictures"], SizeIs(1));
  EXPECT_EQ(data["pictures"][0]["caption"], "From above");
  EXPECT_EQ(data["pictures"][0]["png_base64"], "iVBORw==");  // 89 50 4E 47
}

TEST(ReportTest, PicturesAreBase64) {
  // The test vectors of RFC 4648.
  const std::vector<std::pair<std::string, std::string>> vectors{{"", ""},
                                                                 {"f", "Zg=="},
                                                                 {"fo", "Zm8="},
                                                                 {"foo", "Zm9v"},
                                                                 {"foob", "Zm9vYg=="},
                                                                 {"fooba", "Zm9vYmE="},
                                                                 {"foobar", "Zm9vYmFy"}};
  EvaluationResult result = some_result();
  result.pictures.clear();
  for (const auto& [bytes, text] : vectors) {
    result.pictures.push_back({"", "", bytes});
  }
  const json data = page_data(metrics_report(result));
  for (std::size_t i = 0; i < vectors.size(); ++i) {
    EXPECT_EQ(data["pictures"][i]["png_base64"], vectors[i].second);
  }
}

TEST(ReportTest, ThePageComparesWithTheThesisWhereItCan) {
  EvaluationResult result = some_result();
  result.sequence = "0003";
  const json data = page_data(metrics_report(result));
  EXPECT_EQ(data["reference"]["tp"], 17995);
  EXPECT_EQ(data["reference"]["correlation"], 0.534);
}

TEST(ReportTest, NoTextCanEndThePagesScript) {
  EvaluationResult result = some_result();
  const std::string hostile = "</script><script>alert(1)</script><!-- <SCRIPT>";
  result.config_yaml = hostile;
  result.source = hostile;
  result.sequence = hostile;
  result.pictures[0].caption = hostile;
  const std::string page = metrics_report(result);
  EXPECT_THAT(page, Not(HasSubstr("alert(1)</script>")));
  EXPECT_THAT(page, Not(HasSubstr("<!-- <SCRIPT>")));
  const json data = page_data(page);
  ASSERT_TRUE(data.is_object());
  EXPECT_EQ(data["config_yaml"], hostile);
  EXPECT_EQ(data["pictures"][0]["caption"], hostile);
}

TEST(ReportTest, ThePlaceholderInTheDataIsText) {
  EvaluationResult result = some_result();
  result.config_yaml = "/*SKYHALO_DATA*/null";
  const json data = page_data(metrics_report(result));
  ASSERT_TRUE(data.is_object());
  EXPECT_EQ(data["config_yaml"], "/*SKYHALO_DATA*/null");
}

TEST(ReportTest, TextThatIsNoUtf8StillGivesAPage) {
  EvaluationResult result = some_result();
  result.source = "drive \xFF\xFE";
  EXPECT_TRUE(page_data(metrics_report(result)).is_object());
}

TEST(ReportTest, ThePageOpensOffline) {
  const std::string page = metrics_report(some_result());
  for (const std::string outside : {"src=\"http", "href=\"http", "src=\"//", "@import", "fetch("}) {
    EXPECT_THAT(page, Not(HasSubstr(outside)));
  }
}

}  // namespace
}  // namespace skyhalo

#include "skyhalo/evaluation/thesis_table.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

namespace skyhalo {
namespace {

std::vector<std::string> sequences() {
  std::vector<std::string> names;
  names.reserve(10);
  for (int i = 0; i < 10; ++i) {
    names.push_back("000" + std::to_string(i));
  }
  return names;
}

double quotient(std::int64_t part, std::int64_t whole) {
  return static_cast<double>(part) / static_cast<double>(whole);
}

TEST(ThesisTableTest, HasTheRowsThatThePaperPrints) {
  for (const std::string& name : sequences()) {
    EXPECT_TRUE(thesis_row(name).has_value()) << name;
  }
  for (const std::string name : {"", "3", "003", "0010", "00003", "2011_09_26_drive_0013_sync"}) {
    EXPECT_FALSE(thesis_row(name).has_value()) << name;
  }
}

TEST(ThesisTableTest, RowThreeIsAsPrinted) {
  const Metrics m = thesis_row("0003").value_or(Metrics{});
  EXPECT_EQ(m.tp, 17995);
  EXPECT_EQ(m.fp, 5544);
  EXPECT_EQ(m.tn, 843943);
  EXPECT_EQ(m.fn, 12518);
  EXPECT_EQ(m.accuracy, 0.979);
  EXPECT_EQ(m.precision, 0.764);
  EXPECT_EQ(m.recall, 0.590);
  EXPECT_EQ(m.specificity, 0.993);
  EXPECT_EQ(m.npv, 0.985);
  EXPECT_EQ(m.error, 0.084);
  EXPECT_EQ(m.correlation, 0.534);
  EXPECT_EQ(m.tp + m.fp + m.tn + m.fn, 880000);
}

/// A printed ratio and what the printed counts of its row give.
struct Ratio {
  std::string name;
  double printed = 0.0;
  double counted = 0.0;
};

std::vector<Ratio> ratios(const std::string& sequence) {
  const Metrics m = thesis_row(sequence).value_or(Metrics{});
  return {
      {sequence + " accuracy", m.accuracy, quotient(m.tp + m.tn, m.tp + m.fp + m.tn + m.fn)},
      {sequence + " precision", m.precision, quotient(m.tp, m.tp + m.fp)},
      {sequence + " recall", m.recall, quotient(m.tp, m.tp + m.fn)},
      {sequence + " specificity", m.specificity, quotient(m.tn, m.tn + m.fp)},
      {sequence + " npv", m.npv, quotient(m.tn, m.tn + m.fn)},
  };
}

TEST(ThesisTableTest, ThePrintedRatiosFollowFromThePrintedCounts) {
  // Four printed ratios do not: by 0.0103, 0.0275, 0.0343 and 0.00102.
  const std::vector<std::string> inconsistent{
      "0002 recall", "0005 precision", "0005 recall", "0006 precision"};
  for (const std::string& sequence : sequences()) {
    for (const Ratio& ratio : ratios(sequence)) {
      const double difference = std::abs(ratio.printed - ratio.counted);
      const bool known = std::count(inconsistent.begin(), inconsistent.end(), ratio.name) > 0;
      EXPECT_EQ(difference > 0.001, known) << ratio.name << " differs by " << difference;
      EXPECT_LT(difference, 0.035) << ratio.name;
    }
  }
}

}  // namespace
}  // namespace skyhalo

#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <functional>
#include <string>
#include <vector>

#include "support/expect_error.hpp"
#include "support/temp_folder.hpp"

namespace skyhalo::testing {

/// The text with the first `from` in it replaced; fails the test when there is none.
inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

/// A change to a good file that must be refused, and what the message must hold besides the file.
struct BadChange {
  std::string from;
  std::string to;
  std::vector<std::string> words;
};

/// Writes the good text with each change to `name` in a folder of its own and has it read.
inline void expect_refused(const std::string& good,
                           const std::string& name,
                           const std::vector<BadChange>& changes,
                           const std::function<void(const std::filesystem::path&)>& read) {
  for (const BadChange& change : changes) {
    SCOPED_TRACE(change.from + " -> " + change.to);
    const TempFolder folder;
    const auto file = folder.write(name, replaced(good, change.from, change.to));
    const std::string message = message_of([&] { read(file); });
    EXPECT_THAT(message, ::testing::HasSubstr(file.string()));
    for (const std::string& word : change.words) {
      EXPECT_THAT(message, ::testing::HasSubstr(word));
    }
  }
}

/// Empty files and missing ones are refused by name.
inline void expect_no_content_refused(
    const std::string& name, const std::function<void(const std::filesystem::path&)>& read) {
  const TempFolder folder;
  const auto file = folder.path() / name;
  EXPECT_THAT(
      message_of([&] { read(file); }),
      ::testing::AllOf(::testing::HasSubstr(file.string()), ::testing::HasSubstr("no such file")));
  (void)folder.write(name, "");
  EXPECT_THAT(message_of([&] { read(file); }),
              ::testing::AllOf(::testing::HasSubstr(file.string()), ::testing::HasSubstr("empty")));
}

inline void expect_matrix(const Eigen::MatrixXd& actual,
                          const Eigen::MatrixXd& expected,
                          double tolerance = 1e-12) {
  EXPECT_LE((actual - expected).cwiseAbs().maxCoeff(), tolerance) << actual << "\nexpected\n"
                                                                  << expected;
}

}  // namespace skyhalo::testing

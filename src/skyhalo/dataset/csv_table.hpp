#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "skyhalo/base/error.hpp"
#include "skyhalo/base/timestamp.hpp"

namespace skyhalo {

/// A line of a CSV file that knows where it stands. Columns count from 0. Internal to this layer,
/// as all of this header.
class CsvRow {
 public:
  /// Throws `Error` (input) with file and line for another number of columns.
  CsvRow(const std::filesystem::path& file, int line, const std::string& text, std::size_t columns);

  [[nodiscard]] const std::string& text(std::size_t column) const { return fields_.at(column); }

  /// A finite number; throws `Error` (input) with file, line and column, as the others do.
  [[nodiscard]] double number(std::size_t column) const;

  [[nodiscard]] int whole_number(std::size_t column) const;

  /// Whole nanoseconds since 1970, not below 0.
  [[nodiscard]] Timestamp stamp(std::size_t column) const;

  /// An input error with file and line.
  [[nodiscard]] Error error(std::string_view message) const;

 private:
  [[nodiscard]] Error wrong(std::size_t column, std::string_view expected) const;

  std::filesystem::path file_;
  int line_;
  std::vector<std::string> fields_;
};

/// The lines of a CSV file after its first one, which must be `header`; a line has as many columns.
/// Empty lines are passed over. Throws `Error` (input) with file and line.
[[nodiscard]] std::vector<CsvRow> read_csv(const std::filesystem::path& file,
                                           std::string_view header);

}  // namespace skyhalo

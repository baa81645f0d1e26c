#include "skyhalo/dataset/csv_table.hpp"

#include <algorithm>
#include <optional>

#include "skyhalo/dataset/stamp_text.hpp"
#include "skyhalo/io/text_file.hpp"

namespace skyhalo {

CsvRow::CsvRow(const std::filesystem::path& file,
               int line,
               const std::string& text,
               std::size_t columns)
    : file_(file), line_(line) {
  std::size_t from = 0;
  while (from <= text.size()) {
    const std::size_t comma = std::min(text.find(',', from), text.size());
    fields_.push_back(text.substr(from, comma - from));
    from = comma + 1;
  }
  if (fields_.size() != columns) {
    throw error("expected " + std::to_string(columns) + " values separated by commas, found '" +
                text + "'");
  }
}

double CsvRow::number(std::size_t column) const {
  const std::optional<double> value = parse_number(text(column));
  if (!value) {
    throw wrong(column, "a finite number");
  }
  return *value;
}

int CsvRow::whole_number(std::size_t column) const {
  const std::optional<int> value = parse_whole_number(text(column));
  if (!value) {
    throw wrong(column, "a whole number");
  }
  return *value;
}

Timestamp CsvRow::stamp(std::size_t column) const {
  const std::optional<Timestamp> stamp = parse_stamp(text(column));
  if (!stamp) {
    throw wrong(column, "whole nanoseconds since 1970");
  }
  return *stamp;
}

Error CsvRow::error(std::string_view message) const {
  return input_error(file_, line_, message);
}

Error CsvRow::wrong(std::size_t column, std::string_view expected) const {
  return error("column " + std::to_string(column + 1) + ": expected " + std::string(expected) +
               ", found '" + text(column) + "'");
}

std::vector<CsvRow> read_csv(const std::filesystem::path& file, std::string_view header) {
  const std::vector<std::string> lines = read_lines(file);
  if (lines.empty() || lines.front() != header) {
    throw input_error(file, 1, "expected the line '" + std::string(header) + "'");
  }
  const auto columns = static_cast<std::size_t>(std::ranges::count(header, ',')) + 1;
  std::vector<CsvRow> rows;
  for (std::size_t i = 1; i < lines.size(); ++i) {
    if (!lines[i].empty()) {
      rows.emplace_back(file, static_cast<int>(i) + 1, lines[i], columns);
    }
  }
  return rows;
}

}  // namespace skyhalo

#include "skyhalo/dataset/euroc_table.hpp"

#include <optional>
#include <string_view>

#include "skyhalo/base/error.hpp"
#include "skyhalo/dataset/stamp_text.hpp"
#include "skyhalo/io/text_file.hpp"

namespace skyhalo {
namespace {

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kBlanks = " \t\r";
  const std::size_t first = text.find_first_not_of(kBlanks);
  if (first == std::string_view::npos) {
    return {};
  }
  return text.substr(first, text.find_last_not_of(kBlanks) - first + 1);
}

std::vector<std::string> split_fields(std::string_view line) {
  std::vector<std::string> fields;
  while (true) {
    const std::size_t comma = line.find(',');
    fields.emplace_back(trimmed(line.substr(0, comma)));
    if (comma == std::string_view::npos) {
      return fields;
    }
    line.remove_prefix(comma + 1);
  }
}

EurocRow parse_row(const std::filesystem::path& file,
                   int line,
                   std::string_view text,
                   std::size_t fields) {
  EurocRow row{.line = line, .stamp = {}, .fields = split_fields(text)};
  if (row.fields.size() != fields + 1) {
    throw input_error(file,
                      line,
                      "expected a time stamp and " + std::to_string(fields) +
                          " more values separated by commas, found '" + std::string(text) + "'");
  }
  const std::optional<Timestamp> stamp = parse_stamp(row.fields.front());
  if (!stamp) {
    throw input_error(file,
                      line,
                      "expected a time stamp in whole nanoseconds since 1970, found '" +
                          row.fields.front() + "'");
  }
  row.stamp = *stamp;
  row.fields.erase(row.fields.begin());
  return row;
}

}  // namespace

std::vector<EurocRow> read_euroc_table(const std::filesystem::path& file, std::size_t fields) {
  std::vector<EurocRow> rows;
  int line = 0;
  for (const std::string& whole : read_lines(file)) {
    ++line;
    const std::string_view text = trimmed(whole);
    if (text.empty() || text.starts_with('#')) {
      continue;
    }
    EurocRow row = parse_row(file, line, text, fields);
    if (!rows.empty() && row.stamp <= rows.back().stamp) {
      throw input_error(file,
                        line,
                        "the time stamp is not after the one of line " +
                            std::to_string(rows.back().line) + "; they must grow");
    }
    rows.push_back(std::move(row));
  }
  if (rows.empty()) {
    throw input_error(file, "holds no data");
  }
  return rows;
}

}  // namespace skyhalo

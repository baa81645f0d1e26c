#include "skyhalo/sim/number_table.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <optional>
#include <string_view>
#include <system_error>
#include <utility>

#include "skyhalo/base/error.hpp"

namespace skyhalo {
namespace {

constexpr std::string_view kBlanks = " \t\r\v\f";
constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(kBlanks);
  if (first == std::string_view::npos) {
    return {};
  }
  return text.substr(first, text.find_last_not_of(kBlanks) - first + 1);
}

std::vector<std::string_view> comma_fields(std::string_view line) {
  std::vector<std::string_view> fields;
  while (true) {
    const std::size_t comma = line.find(',');
    fields.push_back(trimmed(line.substr(0, comma)));
    if (comma == std::string_view::npos) {
      return fields;
    }
    line.remove_prefix(comma + 1);
  }
}

std::vector<std::string_view> blank_fields(std::string_view line) {
  std::vector<std::string_view> fields;
  while (!line.empty()) {
    const std::size_t blank = line.find_first_of(kBlanks);
    fields.push_back(line.substr(0, blank));
    line = blank == std::string_view::npos ? std::string_view{} : trimmed(line.substr(blank));
  }
  return fields;
}

/// Any number, NaN and infinity too.
std::optional<double> parse_number(std::string_view text) {
  if (text.starts_with('+') && !text.starts_with("+-")) {
    text.remove_prefix(1);
  }
  double value = 0.0;
  const auto [end, status] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (status != std::errc() || end != text.data() + text.size()) {
    return std::nullopt;
  }
  return value;
}

/// What an error says of a text that may be long.
std::string quoted(std::string_view text) {
  constexpr std::size_t kMost = 60;
  return "'" + std::string(text.substr(0, kMost)) + (text.size() > kMost ? "...'" : "'");
}

/// Reads lines and puts them where they belong.
class TableReader {
 public:
  TableReader(std::filesystem::path file, TableLayout layout)
      : file_(std::move(file)), layout_(std::move(layout)), count_(layout_.columns) {}

  void take(std::string_view text, int line) {
    if (is_first_ && !begins_with_number(text)) {
      take_header(text, line);
    } else {
      take_row(text, line);
    }
    is_first_ = false;
  }

  [[nodiscard]] NumberTable table() && { return std::move(table_); }

 private:
  [[nodiscard]] bool has_header() const { return table_.header_line > 0; }

  /// Of a CSV without a header, too: that its row is wrong says more than an unknown column.
  [[nodiscard]] static bool begins_with_number(std::string_view text) {
    return parse_number(trimmed(text.substr(0, text.find_first_of(", \t")))).has_value();
  }

  void take_header(std::string_view text, int line) {
    for (const std::string_view name : comma_fields(text)) {
      check_name(name, line);
      table_.columns.emplace_back(name);
    }
    table_.header_line = line;
    count_ = table_.columns.size();
  }

  void check_name(std::string_view name, int line) const {
    const bool is_known =
        std::find(layout_.names.begin(), layout_.names.end(), name) != layout_.names.end();
    const bool is_new =
        std::find(table_.columns.begin(), table_.columns.end(), name) == table_.columns.end();
    if (is_known && is_new) {
      return;
    }
    std::string names;
    for (const std::string_view known : layout_.names) {
      names += (names.empty() ? "" : ",") + std::string(known);
    }
    throw input_error(file_,
                      line,
                      "column " + quoted(name) + (is_known ? " is there twice" : " is unknown") +
                          "; expected a header out of " + names + ", or rows of " +
                          std::to_string(layout_.columns) + " numbers separated by spaces");
  }

  void take_row(std::string_view text, int line) {
    const auto fields = has_header() ? comma_fields(text) : blank_fields(text);
    if (fields.size() != count_) {
      throw input_error(file_,
                        line,
                        "found " + std::to_string(fields.size()) + " values, expected " +
                            std::to_string(count_) +
                            (has_header() ? " separated by commas, as in the header"
                                          : " separated by spaces (or a header line with the "
                                            "names of columns before values with commas)"));
    }
    NumberRow row{.values = {}, .line = line};
    for (const std::string_view field : fields) {
      const std::optional<double> value = parse_number(field);
      if (!value || !std::isfinite(*value)) {
        throw input_error(file_, line, quoted(field) + " is no finite number");
      }
      row.values.push_back(*value);
    }
    table_.rows.push_back(std::move(row));
  }

  std::filesystem::path file_;
  TableLayout layout_;
  NumberTable table_;
  std::size_t count_ = 0;
  bool is_first_ = true;
};

}  // namespace

NumberTable read_number_table(const std::filesystem::path& file, const TableLayout& layout) {
  std::error_code status;
  std::ifstream stream(file, std::ios::binary);
  if (!stream || std::filesystem::is_directory(file, status)) {
    throw input_error(file, "cannot be read");
  }
  TableReader reader(file, layout);
  std::string whole;
  for (int line = 1; std::getline(stream, whole); ++line) {
    std::string_view text = whole;
    if (line == 1 && text.starts_with(kByteOrderMark)) {
      text.remove_prefix(kByteOrderMark.size());
    }
    text = trimmed(text);
    if (!text.empty() && !text.starts_with('#')) {
      reader.take(text, line);
    }
  }
  if (stream.bad()) {
    throw input_error(file, "cannot be read to its end");
  }
  return std::move(reader).table();
}

}  // namespace skyhalo

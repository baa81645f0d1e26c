#include <charconv>
#include <chrono>
#include <string>

#include "skyhalo/base/error.hpp"
#include "skyhalo/dataset/kitti_raw.hpp"
#include "skyhalo/io/text_file.hpp"

namespace skyhalo {
namespace {

/// The whole number that fills text[from, from + length); -1 if it is none.
int digits(std::string_view text, std::size_t from, std::size_t length) noexcept {
  if (from + length > text.size()) {
    return -1;
  }
  for (const char c : text.substr(from, length)) {
    if (c < '0' || c > '9') {
      return -1;
    }
  }
  return parse_whole_number(text.substr(from, length)).value_or(-1);
}

std::optional<Timestamp> parse_timestamp(std::string_view text) noexcept {
  constexpr std::string_view kShape = "YYYY-MM-DD HH:MM:SS";
  if (text.size() < kShape.size() || text[4] != '-' || text[7] != '-' || text[10] != ' ' ||
      digits(text, 17, 2) < 0 || text[13] != ':' || text[16] != ':') {
    return std::nullopt;
  }
  const int hour = digits(text, 11, 2);
  const int minute = digits(text, 14, 2);
  const std::optional<double> second = parse_number(text.substr(17));
  const std::chrono::year_month_day day{
      std::chrono::year(digits(text, 0, 4)),
      std::chrono::month(static_cast<unsigned>(digits(text, 5, 2))),
      std::chrono::day(static_cast<unsigned>(digits(text, 8, 2)))};
  // Nanoseconds since 1970 reach from 1678 to 2261.
  const bool year_fits =
      day.year() >= std::chrono::year(1970) && day.year() <= std::chrono::year(2261);
  if (!day.ok() || !year_fits || hour < 0 || hour > 23 || minute < 0 || minute > 59 || !second ||
      *second < 0.0 || *second >= 61.0) {
    return std::nullopt;
  }
  const auto within_minute =
      std::chrono::round<std::chrono::nanoseconds>(std::chrono::duration<double>(*second));
  return std::chrono::sys_days(day) + std::chrono::hours(hour) + std::chrono::minutes(minute) +
         within_minute;
}

}  // namespace

std::vector<Timestamp> read_kitti_timestamps(const std::filesystem::path& file) {
  std::vector<Timestamp> stamps;
  int number = 0;
  for (const std::string& line : read_lines(file)) {
    ++number;
    if (split_words(line).empty()) {
      continue;
    }
    const std::optional<Timestamp> stamp = parse_timestamp(line);
    if (!stamp) {
      throw input_error(
          file, number, "expected YYYY-MM-DD HH:MM:SS.nnnnnnnnn, found '" + line + "'");
    }
    stamps.push_back(*stamp);
  }
  if (stamps.empty()) {
    throw input_error(file, "holds no time stamp");
  }
  return stamps;
}

}  // namespace skyhalo

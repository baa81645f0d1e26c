#include "skyhalo/io/text_file.hpp"

#include <charconv>
#include <cmath>
#include <fstream>
#include <iterator>
#include <system_error>

#include "skyhalo/base/error.hpp"

namespace skyhalo {

std::string read_bytes(const std::filesystem::path& file) {
  std::error_code ignored;
  if (!std::filesystem::exists(file, ignored)) {
    throw input_error(file, "no such file");
  }
  if (std::filesystem::is_directory(file, ignored)) {
    throw input_error(file, "is a folder, expected a file");
  }
  std::ifstream stream(file, std::ios::binary);
  std::string bytes{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  if (!stream) {
    throw input_error(file, "cannot be read");
  }
  return bytes;
}

std::vector<std::string> read_lines(const std::filesystem::path& file) {
  const std::string text = read_bytes(file);
  std::vector<std::string> lines;
  std::size_t from = 0;
  while (from < text.size()) {
    std::size_t end = text.find('\n', from);
    end = end == std::string::npos ? text.size() : end;
    const bool windows = end > from && text[end - 1] == '\r';
    lines.push_back(text.substr(from, end - from - (windows ? 1 : 0)));
    from = end + 1;
  }
  return lines;
}

std::vector<std::string_view> split_words(std::string_view line) {
  constexpr std::string_view kBlanks = " \t";
  std::vector<std::string_view> words;
  std::size_t from = line.find_first_not_of(kBlanks);
  while (from != std::string_view::npos) {
    const std::size_t end = std::min(line.find_first_of(kBlanks, from), line.size());
    words.push_back(line.substr(from, end - from));
    from = line.find_first_not_of(kBlanks, end);
  }
  return words;
}

std::optional<double> parse_number(std::string_view word) noexcept {
  if (word.starts_with('+') && !word.starts_with("+-")) {
    word.remove_prefix(1);
  }
  double value = 0.0;
  const auto [end, status] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (status != std::errc() || end != word.data() + word.size() || !std::isfinite(value)) {
    return std::nullopt;
  }
  return value;
}

std::optional<int> parse_whole_number(std::string_view word) noexcept {
  int value = 0;
  const auto [end, status] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (status != std::errc() || end != word.data() + word.size()) {
    return std::nullopt;
  }
  return value;
}

}  // namespace skyhalo

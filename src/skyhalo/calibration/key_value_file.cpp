#include "skyhalo/calibration/key_value_file.hpp"

#include <utility>

#include "skyhalo/io/text_file.hpp"

namespace skyhalo {

KeyValueFile::KeyValueFile(std::filesystem::path file) : file_(std::move(file)) {
  int line_number = 0;
  for (const std::string& line : read_lines(file_)) {
    ++line_number;
    const std::vector<std::string_view> words = split_words(line);
    if (words.empty() || (words.size() == 1 && !words.front().ends_with(':'))) {
      continue;
    }
    std::string_view key = words.front();
    const std::size_t key_end = line.find(key) + key.size();
    key.remove_suffix(key.ends_with(':') ? 1 : 0);
    entries_[std::string(key)] = {line_number, line.substr(key_end)};
  }
}

std::vector<double> KeyValueFile::numbers(const std::string& key, std::size_t count) const {
  const auto entry = entries_.find(key);
  if (entry == entries_.end()) {
    throw input_error(
        file_, key + ": this key is missing; expected " + std::to_string(count) + " numbers");
  }
  const std::vector<std::string_view> words = split_words(entry->second.values);
  if (words.size() != count) {
    throw error(
        key,
        "expected " + std::to_string(count) + " numbers, found " + std::to_string(words.size()));
  }
  std::vector<double> values;
  for (const std::string_view word : words) {
    const std::optional<double> value = parse_number(word);
    if (!value) {
      throw error(key, "expected a finite number, found '" + std::string(word) + "'");
    }
    values.push_back(*value);
  }
  return values;
}

Error KeyValueFile::error(const std::string& key, const std::string& message) const {
  const auto entry = entries_.find(key);
  const std::string text = key + ": " + message;
  return entry == entries_.end() ? input_error(file_, text)
                                 : input_error(file_, entry->second.line, text);
}

}  // namespace skyhalo

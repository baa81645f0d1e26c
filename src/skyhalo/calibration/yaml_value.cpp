#include "skyhalo/calibration/yaml_value.hpp"

#include <algorithm>
#include <set>
#include <utility>

#include "skyhalo/io/text_file.hpp"

namespace skyhalo {
namespace {

/// yaml-cpp knows no `%YAML:1.0`, with which OpenCV's files begin; the line stays as a comment, so
/// that the numbers of the others stay right.
std::string without_opencv_directive(std::string text) {
  if (text.starts_with("%YAML:")) {
    text.front() = '#';
  }
  return text;
}

bool is_empty(std::string_view text) {
  return text.find_first_not_of(" \t\r\n") == std::string_view::npos;
}

}  // namespace

YamlValue::YamlValue(std::string file, std::string path, int line, const YAML::Node& node)
    : file_(std::move(file)), path_(std::move(path)), line_(line), node_(node) {}

YamlValue YamlValue::load(const std::filesystem::path& file) {
  return parse(read_bytes(file), file);
}

YamlValue YamlValue::parse(std::string_view bytes, const std::filesystem::path& file) {
  const std::string text = without_opencv_directive(std::string(bytes));
  if (is_empty(text)) {
    throw input_error(file, "is empty");
  }
  try {
    const YAML::Node node = YAML::Load(text);
    if (!node.IsMap()) {
      throw input_error(file, "expected keys with values");
    }
    return {file.string(), "", 0, node};
  } catch (const YAML::Exception& error) {
    throw input_error(file, error.mark.line + 1, error.msg);
  }
}

std::optional<YamlValue> YamlValue::find(std::string_view key) const {
  if (!node_.IsMap()) {
    throw wrong_type("keys with values");
  }
  std::optional<YamlValue> found;
  for (const auto& entry : node_) {
    if (!entry.first.IsScalar() || entry.first.Scalar() != key) {
      continue;
    }
    if (found) {
      throw found->error("is given twice");
    }
    found.emplace(YamlValue(file_, path_to(key), entry.first.Mark().line + 1, entry.second));
  }
  return found;
}

YamlValue YamlValue::at(std::string_view key) const {
  std::optional<YamlValue> value = find(key);
  if (!value) {
    throw error(key, "this key is missing");
  }
  return *std::move(value);
}

void YamlValue::refuse_other_keys(std::initializer_list<std::string_view> known,
                                  std::span<const std::string_view> more) const {
  std::vector<std::string_view> all(known);
  all.insert(all.end(), more.begin(), more.end());
  std::set<std::string> seen;
  for (const std::string& key : keys()) {
    if (std::find(all.begin(), all.end(), key) == all.end()) {
      std::string message = "unknown key; known are";
      for (const std::string_view other : all) {
        message += " " + std::string(other);
      }
      throw error(key, message);
    }
    if (!seen.insert(key).second) {
      throw error(key, "is given twice");
    }
  }
}

std::vector<std::string> YamlValue::keys() const {
  if (!node_.IsMap()) {
    throw wrong_type("keys with values");
  }
  std::vector<std::string> keys;
  for (const auto& entry : node_) {
    keys.push_back(entry.first.IsScalar() ? entry.first.Scalar() : "");
  }
  return keys;
}

std::vector<YamlValue> YamlValue::items() const {
  if (!node_.IsSequence()) {
    throw wrong_type("a list");
  }
  std::vector<YamlValue> items;
  for (std::size_t i = 0; i < node_.size(); ++i) {
    const YAML::Node& item = node_[i];
    const int line = item.Mark().line >= 0 ? item.Mark().line + 1 : line_;
    items.push_back(YamlValue(file_, path_ + "[" + std::to_string(i) + "]", line, item));
  }
  return items;
}

double YamlValue::number() const {
  const std::optional<double> value =
      node_.IsScalar() ? parse_number(node_.Scalar()) : std::nullopt;
  if (!value) {
    throw wrong_type("a finite number");
  }
  return *value;
}

int YamlValue::whole_number() const {
  const std::optional<int> value =
      node_.IsScalar() ? parse_whole_number(node_.Scalar()) : std::nullopt;
  if (!value) {
    throw wrong_type("a whole number");
  }
  return *value;
}

std::string YamlValue::text() const {
  if (!node_.IsScalar()) {
    throw wrong_type("a word or text");
  }
  return node_.Scalar();
}

std::vector<double> YamlValue::numbers() const {
  if (!node_.IsSequence()) {
    throw wrong_type("a list of numbers");
  }
  std::vector<double> numbers;
  collect_numbers(node_, 0, numbers);
  return numbers;
}

std::vector<double> YamlValue::numbers(std::size_t count) const {
  std::vector<double> values = numbers();
  if (values.size() != count) {
    throw error("expected " + std::to_string(count) + " numbers, found " +
                std::to_string(values.size()));
  }
  return values;
}

Error YamlValue::error(std::string_view message) const {
  const std::string text =
      path_.empty() ? std::string(message) : path_ + ": " + std::string(message);
  return line_ > 0 ? input_error(file_, line_, text) : input_error(file_, text);
}

Error YamlValue::error(std::string_view key, std::string_view message) const {
  const std::optional<YamlValue> entry = node_.IsMap() ? find(key) : std::nullopt;
  return YamlValue(file_, path_to(key), entry ? entry->line_ : line_, node_).error(message);
}

Error YamlValue::error_below(std::string_view message) const {
  const std::string path(message.substr(0, message.find(": ")));
  YamlValue deepest = *this;
  std::string word;
  for (const char c : path + ".") {
    if (c != '.' && c != '[' && c != ']') {
      word += c;
      continue;
    }
    if (word.empty()) {
      continue;
    }
    const std::optional<int> index = parse_whole_number(word);
    if (index && deepest.is_list() && *index < static_cast<int>(deepest.node_.size())) {
      deepest = deepest.items()[static_cast<std::size_t>(*index)];
    } else if (const auto next = deepest.is_map() ? deepest.find(word) : std::nullopt) {
      deepest = *next;
    } else {
      break;
    }
    word.clear();
  }
  return deepest.line_ > 0 ? input_error(file_, deepest.line_, message)
                           : input_error(file_, message);
}

Error YamlValue::wrong_type(std::string_view expected) const {
  const std::string found = node_.IsScalar()     ? "'" + node_.Scalar() + "'"
                            : node_.IsSequence() ? "a list"
                            : node_.IsMap()      ? "keys with values"
                                                 : "nothing";
  return error("expected " + std::string(expected) + ", found " + found);
}

std::string YamlValue::path_to(std::string_view key) const {
  return path_.empty() ? std::string(key) : path_ + "." + std::string(key);
}

void YamlValue::collect_numbers(const YAML::Node& node,
                                int depth,
                                std::vector<double>& numbers) const {
  constexpr int kDeepest = 4;  // a list may hold itself
  if (node.IsSequence() && depth < kDeepest) {
    for (const auto& item : node) {
      collect_numbers(item, depth + 1, numbers);
    }
    return;
  }
  const std::optional<double> value = node.IsScalar() ? parse_number(node.Scalar()) : std::nullopt;
  if (!value) {
    throw error("expected a finite number, found '" + (node.IsScalar() ? node.Scalar() : "") + "'");
  }
  numbers.push_back(*value);
}

}  // namespace skyhalo

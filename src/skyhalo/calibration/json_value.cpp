#include "skyhalo/calibration/json_value.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "skyhalo/calibration/nesting.hpp"
#include "skyhalo/io/text_file.hpp"

namespace skyhalo {
namespace {

/// JSON has no word for NaN and infinity, but C++ programs write them; as texts they are refused
/// only where a number is asked for.
std::string with_quoted_words(const std::string& text) {
  std::string quoted;
  bool in_text = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    in_text = in_text != (text[i] == '"' && (i == 0 || text[i - 1] != '\\'));
    const std::string_view rest = std::string_view(text).substr(i);
    const std::string_view word = rest.starts_with("NaN") || rest.starts_with("nan") ? "NaN"
                                  : rest.starts_with("Infinity")                     ? "Infinity"
                                                                                     : "";
    if (in_text || word.empty()) {
      quoted += text[i];
      continue;
    }
    if (quoted.ends_with('-')) {
      quoted.pop_back();
    }
    quoted += "\"" + std::string(word) + "\"";
    i += word.size() - 1;
  }
  return quoted;
}

/// The library's complaint without its own numbering and its words for the place.
std::string complaint_of(const nlohmann::json::exception& error) {
  std::string_view text = error.what();
  const auto remove_to = [&](std::string_view start, std::string_view end) {
    const std::size_t at = text.starts_with(start) ? text.find(end) : std::string_view::npos;
    text.remove_prefix(at == std::string_view::npos ? 0 : at + end.size());
  };
  remove_to("[json.exception.", "] ");
  remove_to("parse error at ", ": ");
  return "not valid JSON: " + std::string(text);
}

nlohmann::json parse(const std::filesystem::path& file, const std::string& text) {
  try {
    return nlohmann::json::parse(text);
  } catch (const nlohmann::json::parse_error& error) {
    const std::size_t read = std::min(error.byte > 0 ? error.byte - 1 : 0, text.size());
    const auto end = text.begin() + static_cast<std::ptrdiff_t>(read);
    const auto lines = std::count(text.begin(), end, '\n');
    throw input_error(file, static_cast<int>(lines) + 1, complaint_of(error));
  } catch (const nlohmann::json::exception& error) {
    throw input_error(file, complaint_of(error));
  }
}

}  // namespace

JsonValue::JsonValue(std::string file, std::string path, nlohmann::json node)
    : file_(std::move(file)), path_(std::move(path)), node_(std::move(node)) {}

JsonValue JsonValue::load(const std::filesystem::path& file) {
  const std::string text = read_bytes(file);
  if (text.find_first_not_of(" \t\r\n") == std::string::npos) {
    throw input_error(file, "is empty");
  }
  refuse_deep_nesting(file, text);  // values are copied, level by level
  nlohmann::json document = parse(file, with_quoted_words(text));
  if (!document.is_object()) {
    throw input_error(file, "expected a JSON object");
  }
  return {file.string(), "", std::move(document)};
}

JsonValue JsonValue::at(const std::string& key) const {
  const std::string path = path_.empty() ? key : path_ + "." + key;
  if (!node_.is_object()) {
    throw wrong_type("an object");
  }
  const auto entry = node_.find(key);
  if (entry == node_.end()) {
    throw input_error(file_, path + ": this key is missing");
  }
  return {file_, path, *entry};
}

std::vector<JsonValue> JsonValue::items() const {
  if (!node_.is_array()) {
    throw wrong_type("a list");
  }
  std::vector<JsonValue> items;
  for (const nlohmann::json& item : node_) {
    items.push_back(JsonValue(file_, path_ + "[" + std::to_string(items.size()) + "]", item));
  }
  return items;
}

double JsonValue::number() const {
  const double value =
      node_.is_number() ? node_.get<double>() : std::numeric_limits<double>::quiet_NaN();
  if (!std::isfinite(value)) {
    throw wrong_type("a finite number");
  }
  return value;
}

int JsonValue::whole_number() const {
  const double value = number();
  constexpr double kLargest = std::numeric_limits<int>::max();
  if (std::trunc(value) != value || std::abs(value) > kLargest) {
    throw wrong_type("a whole number");
  }
  return static_cast<int>(value);
}

std::string JsonValue::text() const {
  if (!node_.is_string()) {
    throw wrong_type("a text");
  }
  return node_.get<std::string>();
}

Error JsonValue::error(std::string_view message) const {
  return input_error(file_, path_ + ": " + std::string(message));
}

Error JsonValue::wrong_type(std::string_view expected) const {
  const bool simple = node_.is_primitive();
  const std::string found =
      simple ? node_.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace)
             : std::string("a") + (node_.is_array() ? " list" : "n object");
  return error("expected " + std::string(expected) + ", found " + found);
}

}  // namespace skyhalo

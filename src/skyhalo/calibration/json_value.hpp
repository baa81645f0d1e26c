#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "skyhalo/base/error.hpp"

namespace skyhalo {

/// A value of a JSON file that knows its file and path (`value0.intrinsics[0].intrinsics.fx`), so
/// that every complaint about it names them. Internal to this layer and not installed.
class JsonValue {
 public:
  /// The document of a file. Throws `Error` (input) when the file cannot be read, is empty, no JSON
  /// object or nested deeper than 100 levels, with the line where its syntax is wrong. NaN and
  /// Infinity are read as texts, though JSON has no such words.
  [[nodiscard]] static JsonValue load(const std::filesystem::path& file);

  [[nodiscard]] bool has(const std::string& key) const { return node_.contains(key); }

  /// The entry of an object; throws `Error` (input) naming the key when it is absent or this is no
  /// object.
  [[nodiscard]] JsonValue at(const std::string& key) const;

  /// The entries of a list.
  [[nodiscard]] std::vector<JsonValue> items() const;

  /// A finite number.
  [[nodiscard]] double number() const;

  /// A whole number that fits an int.
  [[nodiscard]] int whole_number() const;

  [[nodiscard]] std::string text() const;

  /// `FILE: PATH: message`.
  [[nodiscard]] Error error(std::string_view message) const;

 private:
  JsonValue(std::string file, std::string path, nlohmann::json node);

  [[nodiscard]] Error wrong_type(std::string_view expected) const;

  std::string file_;
  std::string path_;
  nlohmann::json node_;
};

}  // namespace skyhalo

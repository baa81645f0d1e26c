#pragma once

#include <yaml-cpp/yaml.h>

#include <filesystem>
#include <initializer_list>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "skyhalo/base/error.hpp"

namespace skyhalo {

/// A value of a YAML or JSON file that knows its file, line and path (`pairs[0].left.size_px`), so
/// that every complaint about it names them. Internal to the layers that read files, and
/// not installed.
class YamlValue {
 public:
  /// The document of a file. OpenCV's `%YAML:1.0` in front is passed over. Throws `Error` (input)
  /// when the file cannot be read, is empty or malformed.
  [[nodiscard]] static YamlValue load(const std::filesystem::path& file);

  /// The document of a text that complaints call `name`. Throws likewise.
  [[nodiscard]] static YamlValue parse(std::string_view bytes, const std::filesystem::path& name);

  /// The entry of a map; none when it is absent. Throws `Error` (input) when this is no map or has
  /// the key twice.
  [[nodiscard]] std::optional<YamlValue> find(std::string_view key) const;

  /// The entry of a map; throws `Error` (input) naming the key when it is absent.
  [[nodiscard]] YamlValue at(std::string_view key) const;

  /// Throws for the first key of this map that neither list has, and for one that is given twice.
  void refuse_other_keys(std::initializer_list<std::string_view> known,
                         std::span<const std::string_view> more = {}) const;

  /// The keys of this map, in the order of the file.
  [[nodiscard]] std::vector<std::string> keys() const;

  /// The entries of a list.
  [[nodiscard]] std::vector<YamlValue> items() const;

  [[nodiscard]] bool is_map() const { return node_.IsMap(); }

  [[nodiscard]] bool is_list() const { return node_.IsSequence(); }

  /// A finite number.
  [[nodiscard]] double number() const;

  /// A whole number that fits an int.
  [[nodiscard]] int whole_number() const;

  [[nodiscard]] std::string text() const;

  /// A list of finite numbers, of any length, or of exactly `count`. Nested lists (the rows of a
  /// matrix) count as one.
  [[nodiscard]] std::vector<double> numbers() const;
  [[nodiscard]] std::vector<double> numbers(std::size_t count) const;

  /// `PATH: message` with file and line.
  [[nodiscard]] Error error(std::string_view message) const;

  /// `PATH.KEY: message` with file and line of the entry, or of this map where it has none.
  [[nodiscard]] Error error(std::string_view key, std::string_view message) const;

  /// The same for a message that begins with a path below this value, `PATH: message`: the line is
  /// that of the deepest entry of the path that there is.
  [[nodiscard]] Error error_below(std::string_view message) const;

  [[nodiscard]] const std::string& path() const noexcept { return path_; }

 private:
  YamlValue(std::string file, std::string path, int line, const YAML::Node& node);

  [[nodiscard]] Error wrong_type(std::string_view expected) const;
  [[nodiscard]] std::string path_to(std::string_view key) const;
  void collect_numbers(const YAML::Node& node, int depth, std::vector<double>& numbers) const;

  std::string file_;
  std::string path_;
  int line_ = 0;  // from 1; 0 for unknown
  YAML::Node node_;
};

}  // namespace skyhalo

#include <yaml-cpp/yaml.h>

#include <array>
#include <fstream>
#include <map>
#include <optional>
#include <set>
#include <sstream>

#include "skyhalo/base/error.hpp"
#include "skyhalo/config/config.hpp"
#include "skyhalo/config/fields.hpp"

namespace skyhalo {
namespace {

/// Where a document came from, for messages: `FILE:LINE` or `--set`.
class Source {
 public:
  Source(std::string name, bool has_lines) : name_(std::move(name)), has_lines_(has_lines) {}

  [[nodiscard]] Error error(const YAML::Mark& mark, const std::string& message) const {
    if (has_lines_ && mark.line >= 0) {
      return input_error(name_, mark.line + 1, message);
    }
    return input_error(name_, message);
  }

 private:
  std::string name_;
  bool has_lines_;
};

std::string wrong_type(const YAML::Node& node, const std::string& path, const char* expected) {
  return path + ": expected " + expected + ", found '" +
         (node.IsScalar() ? node.Scalar()
                          : std::string(node.IsNull() ? "nothing" : "a list or map")) +
         "'";
}

/// An entry of a map: its key knows its line even where the value is empty.
struct Entry {
  YAML::Node key;
  YAML::Node value;
};

std::optional<Entry> find_entry(const YAML::Node& map, std::string_view name) {
  if (map.IsMap()) {
    for (const auto& entry : map) {
      if (entry.first.IsScalar() && entry.first.Scalar() == name) {
        return Entry{entry.first, entry.second};
      }
    }
  }
  return std::nullopt;
}

constexpr const char* kRectangles = "a list of [u, v, width, height], whole numbers, sizes above 0";

std::optional<cv::Rect> to_rectangle(const YAML::Node& node) {
  std::array<int, 4> v{};
  if (!node.IsSequence() || node.size() != v.size()) {
    return std::nullopt;
  }
  for (std::size_t i = 0; i < v.size(); ++i) {
    if (!node[i].IsScalar() || !YAML::convert<int>::decode(node[i], v.at(i))) {
      return std::nullopt;
    }
  }
  return v[2] > 0 && v[3] > 0 ? std::optional(cv::Rect(v[0], v[1], v[2], v[3])) : std::nullopt;
}

/// Reads the fields that a document has; the others stay.
class Loader {
 public:
  Loader(const YAML::Node& document, const Source& source) : document_(document), source_(source) {}

  void section(std::string_view name, std::string_view) {
    section_ = name;
    fields_.reset();
    known_.try_emplace(section_);
    if (const std::optional<Entry> found = find_entry(document_, name)) {
      if (!found->value.IsMap() && !found->value.IsNull()) {
        throw source_.error(found->key.Mark(), section_ + ": expected a section with keys");
      }
      fields_.reset(found->value);
    }
  }

  template <class T>
  void field(std::string_view key, T&& value, std::string_view) {
    known_[section_].insert(std::string(key));
    if (const std::optional<Entry> found = find_entry(fields_, key)) {
      read(*found, section_ + "." + std::string(key), value);
    }
  }

  /// Throws for the first key of the document that no field has.
  void refuse_unknown_keys() const {
    std::set<std::string> sections_seen;
    for (const auto& section : document_) {
      const auto name = section.first.as<std::string>();
      const auto known = known_.find(name);
      if (known == known_.end()) {
        throw source_.error(section.first.Mark(),
                            name + ": unknown section; known are " + sections());
      }
      refuse_repeated(section.first, name, sections_seen);
      std::set<std::string> keys_seen;
      for (const auto& entry : section.second) {
        refuse_unknown_key(entry.first, name, known->second);
        refuse_repeated(entry.first, name + "." + entry.first.Scalar(), keys_seen);
      }
    }
  }

 private:
  void refuse_repeated(const YAML::Node& key,
                       const std::string& path,
                       std::set<std::string>& seen) const {
    if (!seen.insert(path).second) {
      throw source_.error(key.Mark(), path + ": is given twice");
    }
  }

  void refuse_unknown_key(const YAML::Node& key,
                          const std::string& section,
                          const std::set<std::string>& known) const {
    const auto name = key.as<std::string>();
    if (known.contains(name)) {
      return;
    }
    std::string message = section + "." + name + ": unknown key; known are";
    for (const std::string& other : known) {
      message += " " + other;
    }
    throw source_.error(key.Mark(), message);
  }

  [[nodiscard]] std::string sections() const {
    std::string text;
    for (const auto& [name, keys] : known_) {
      text += text.empty() ? name : ", " + name;
    }
    return text;
  }

  template <class T>
  void read_scalar(const Entry& entry, const std::string& path, T& value, const char* expected) {
    if (!entry.value.IsScalar() || !YAML::convert<T>::decode(entry.value, value)) {
      throw source_.error(entry.key.Mark(), wrong_type(entry.value, path, expected));
    }
  }

  void read(const Entry& entry, const std::string& path, int& value) {
    read_scalar(entry, path, value, "a whole number");
  }

  void read(const Entry& entry, const std::string& path, double& value) {
    read_scalar(entry, path, value, "a number");
  }

  void read(const Entry& entry, const std::string& path, bool& value) {
    read_scalar(entry, path, value, "true or false");
  }

  void read(const Entry& entry, const std::string& path, InDegrees<double>& value) {
    double angle_deg = 0.0;
    read_scalar(entry, path, angle_deg, "an angle in degrees");
    value.angle_rad = rad_from_deg(angle_deg);
  }

  void read(const Entry& entry, const std::string& path, std::vector<cv::Rect>& rectangles) {
    if (!entry.value.IsSequence()) {
      throw source_.error(entry.key.Mark(), wrong_type(entry.value, path, kRectangles));
    }
    rectangles.clear();
    for (const YAML::Node& item : entry.value) {
      const std::optional<cv::Rect> rectangle = to_rectangle(item);
      if (!rectangle) {
        throw source_.error(entry.key.Mark(), wrong_type(item, path, kRectangles));
      }
      rectangles.push_back(*rectangle);
    }
  }

  template <class Enum>
  requires std::is_enum_v<Enum>

  void read(const Entry& entry, const std::string& path, Enum& value) {
    std::string expected = "one of";
    for (const auto& [candidate, word] : EnumWords<Enum>::kWords) {
      if (entry.value.IsScalar() && entry.value.Scalar() == word) {
        value = candidate;
        return;
      }
      expected += " " + std::string(word);
    }
    throw source_.error(entry.key.Mark(), wrong_type(entry.value, path, expected.c_str()));
  }

  YAML::Node document_;
  const Source& source_;
  std::string section_;
  YAML::Node fields_;
  std::map<std::string, std::set<std::string>> known_;
};

void apply(const YAML::Node& document, const Source& source, Config& config) {
  if (document.IsNull()) {
    return;
  }
  if (!document.IsMap()) {
    throw source.error(document.Mark(), "expected sections with keys");
  }
  Config changed = config;
  Loader loader(document, source);
  visit_fields(changed, loader);
  loader.refuse_unknown_keys();
  config = changed;
}

YAML::Node parse(const std::string& text, const Source& source) {
  try {
    return YAML::Load(text);
  } catch (const YAML::Exception& error) {
    throw source.error(error.mark, error.msg);
  }
}

std::string read_text(const std::filesystem::path& file) {
  const std::ifstream stream(file);
  std::ostringstream text;
  text << stream.rdbuf();
  if (!stream || std::filesystem::is_directory(file)) {
    throw input_error(file, "cannot be read");
  }
  return text.str();
}

/// Where the document sets the key that a message "section.key: ..." is about; nowhere if it does
/// not.
YAML::Mark mark_of(const YAML::Node& document, std::string_view message) {
  const std::string_view path = message.substr(0, message.find(':'));
  const std::size_t dot = path.find('.');
  if (dot == std::string_view::npos) {
    return YAML::Mark::null_mark();
  }
  const std::optional<Entry> section = find_entry(document, path.substr(0, dot));
  const std::optional<Entry> entry =
      section ? find_entry(section->value, path.substr(dot + 1)) : std::nullopt;
  return entry ? entry->key.Mark() : YAML::Mark::null_mark();
}

}  // namespace

void load_config(const std::filesystem::path& file, Config& config) {
  const Source source(file.string(), true);
  const YAML::Node document = parse(read_text(file), source);
  Config changed = config;
  try {
    apply(document, source, changed);
  } catch (const YAML::Exception& error) {
    throw source.error(error.mark, error.msg);
  }
  try {
    check(changed);
  } catch (const Error& error) {
    throw source.error(mark_of(document, error.what()), error.what());
  }
  config = changed;
}

void set_value(std::string_view assignment, Config& config) {
  const Source source("--set " + std::string(assignment), false);
  const std::size_t dot = assignment.find('.');
  const std::size_t equals = assignment.find('=');
  if (dot == std::string_view::npos || equals == std::string_view::npos || dot > equals) {
    throw source.error(YAML::Mark::null_mark(), "expected section.key=value");
  }
  const std::string section(assignment.substr(0, dot));
  const std::string key(assignment.substr(dot + 1, equals - dot - 1));
  YAML::Node document;
  document[section][key] = parse(std::string(assignment.substr(equals + 1)), source);
  apply(document, source, config);
}

}  // namespace skyhalo

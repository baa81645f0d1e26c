#include <yaml-cpp/yaml.h>

#include <fstream>
#include <map>
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

std::string number_error(const YAML::Node& node, const std::string& path, const char* expected) {
  return path + ": expected " + expected + ", found '" +
         (node.IsScalar() ? node.Scalar() : std::string("a list or map")) + "'";
}

/// Reads the fields that a document has; the others stay.
class Loader {
 public:
  Loader(const YAML::Node& document, const Source& source) : document_(document), source_(source) {}

  void section(std::string_view name, std::string_view) {
    section_ = name;
    node_.reset();
    const YAML::Node& document = document_;
    if (const YAML::Node found = document[section_]) {
      if (!found.IsMap() && !found.IsNull()) {
        throw source_.error(found.Mark(), section_ + ": expected a section with keys");
      }
      node_.reset(found);
    }
  }

  template <class T>
  void field(std::string_view key, T&& value, std::string_view) {
    const std::string name(key);
    known_[section_].insert(name);
    const YAML::Node& node = node_;
    if (!node.IsMap()) {
      return;
    }
    if (const YAML::Node found = node[name]) {
      read(found, section_ + "." + name, value);
    }
  }

  /// Throws for the first key of the document that no field has.
  void refuse_unknown_keys() const {
    for (const auto& section : document_) {
      const auto name = section.first.as<std::string>();
      const auto known = known_.find(name);
      if (known == known_.end()) {
        throw source_.error(section.first.Mark(),
                            name + ": unknown section; known are " + sections());
      }
      for (const auto& entry : section.second) {
        refuse_unknown_key(entry.first, name, known->second);
      }
    }
  }

 private:
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
  void read_scalar(const YAML::Node& node,
                   const std::string& path,
                   T& value,
                   const char* expected) {
    if (!node.IsScalar() || !YAML::convert<T>::decode(node, value)) {
      throw source_.error(node.Mark(), number_error(node, path, expected));
    }
  }

  void read(const YAML::Node& node, const std::string& path, int& value) {
    read_scalar(node, path, value, "a whole number");
  }

  void read(const YAML::Node& node, const std::string& path, double& value) {
    read_scalar(node, path, value, "a number");
  }

  void read(const YAML::Node& node, const std::string& path, bool& value) {
    read_scalar(node, path, value, "true or false");
  }

  void read(const YAML::Node& node, const std::string& path, InDegrees<double>& value) {
    double angle_deg = 0.0;
    read_scalar(node, path, angle_deg, "an angle in degrees");
    value.angle_rad = rad_from_deg(angle_deg);
  }

  template <class Enum>
  requires std::is_enum_v<Enum>

  void read(const YAML::Node& node, const std::string& path, Enum& value) {
    std::string expected = "one of";
    for (const auto& [candidate, word] : EnumWords<Enum>::kWords) {
      if (node.IsScalar() && node.Scalar() == word) {
        value = candidate;
        return;
      }
      expected += " " + std::string(word);
    }
    throw source_.error(node.Mark(), number_error(node, path, expected.c_str()));
  }

  YAML::Node document_;
  const Source& source_;
  std::string section_;
  YAML::Node node_;
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

}  // namespace

void load_config(const std::filesystem::path& file, Config& config) {
  const std::ifstream stream(file);
  std::ostringstream text;
  text << stream.rdbuf();
  if (!stream || std::filesystem::is_directory(file)) {
    throw input_error(file, "cannot be read");
  }
  const Source source(file.string(), true);
  Config changed = config;
  try {
    apply(parse(text.str(), source), source, changed);
    check(changed);
  } catch (const YAML::Exception& error) {
    throw source.error(error.mark, error.msg);
  } catch (const Error& error) {
    const bool has_file = std::string_view(error.what()).starts_with(file.string());
    throw has_file ? error : input_error(file, error.what());
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

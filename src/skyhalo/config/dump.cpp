#include <array>
#include <cstdio>
#include <sstream>

#include "skyhalo/config/config.hpp"
#include "skyhalo/config/fields.hpp"

namespace skyhalo {
namespace {

std::string text_of(int value) {
  return std::to_string(value);
}

std::string text_of(bool value) {
  return value ? "true" : "false";
}

std::string text_of(double value) {
  std::array<char, 32> text{};
  // Twelve digits hide what the change between degrees and radians adds.
  const int length = std::snprintf(text.data(), text.size(), "%.12g", value);
  return {text.data(), static_cast<std::size_t>(length)};
}

std::string text_of(InDegrees<const double> value) {
  return text_of(deg_from_rad(value.angle_rad));
}

std::string text_of(const std::vector<cv::Rect>& rectangles) {
  std::string text;
  for (const cv::Rect& r : rectangles) {
    text += (text.empty() ? "[" : ", [") + std::to_string(r.x) + ", " + std::to_string(r.y) + ", " +
            std::to_string(r.width) + ", " + std::to_string(r.height) + "]";
  }
  return "[" + text + "]";
}

template <class Enum>

requires std::is_enum_v<Enum> std::string text_of(Enum value) {
  for (const auto& [candidate, word] : EnumWords<Enum>::kWords) {
    if (candidate == value) {
      return std::string(word);
    }
  }
  return "";
}

class YamlDumper {
 public:
  void section(std::string_view name, std::string_view meaning) {
    out_ << (out_.tellp() > 0 ? "\n" : "") << "# " << meaning << "\n" << name << ":\n";
  }

  template <class T>
  void field(std::string_view key, T&& value, std::string_view meaning) {
    const std::string entry = "  " + std::string(key) + ": " + text_of(value);
    constexpr std::size_t kCommentColumn = 32;
    const std::size_t gap = entry.size() + 2 < kCommentColumn ? kCommentColumn - entry.size() : 2;
    out_ << entry << std::string(gap, ' ') << "# " << meaning << "\n";
  }

  [[nodiscard]] std::string text() const { return out_.str(); }

 private:
  std::ostringstream out_;
};

class MarkdownDumper {
 public:
  void section(std::string_view name, std::string_view meaning) {
    out_ << "\n## " << name << "\n\n"
         << meaning << "\n\n| key | default | meaning |\n|---|---|---|\n";
    section_ = name;
  }

  template <class T>
  void field(std::string_view key, T&& value, std::string_view meaning) {
    out_ << "| `" << section_ << "." << key << "` | " << text_of(value) << " | " << meaning
         << " |\n";
  }

  [[nodiscard]] std::string text() const { return out_.str(); }

 private:
  std::ostringstream out_;
  std::string section_;
};

}  // namespace

std::string to_yaml(const Config& config) {
  YamlDumper dumper;
  visit_fields(config, dumper);
  return dumper.text();
}

std::string to_markdown(const Config& config) {
  MarkdownDumper dumper;
  visit_fields(config, dumper);
  return "# Configuration\n\nEvery setting with its default. A file (`--config FILE`) or "
         "`--set section.key=value` changes them; keys end in their unit. This page is "
         "`skyhalo config --markdown`.\n" +
         dumper.text();
}

}  // namespace skyhalo

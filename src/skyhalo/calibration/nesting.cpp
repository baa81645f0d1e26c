#include "skyhalo/calibration/nesting.hpp"

#include <algorithm>
#include <string>

#include "skyhalo/base/error.hpp"

namespace skyhalo {
namespace {

constexpr int kDeepest = 100;
constexpr int kMostOpened = 10000;

/// How deep a text is nested as its bytes pass.
struct Nesting {
  int depth = 0;
  int opened = 0;

  void open() noexcept {
    ++depth;
    ++opened;
  }

  void close() noexcept { depth = std::max(depth - 1, 0); }

  [[nodiscard]] bool too_deep() const noexcept { return depth > kDeepest || opened > kMostOpened; }
};

/// Lists and maps in brackets, of YAML and JSON.
bool brackets_too_deep(std::string_view text) noexcept {
  Nesting nesting;
  for (const char c : text) {
    if (c == '[' || c == '{') {
      nesting.open();
    } else if (c == ']' || c == '}') {
      nesting.close();
    }
    if (nesting.too_deep()) {
      return true;
    }
  }
  return false;
}

/// Lists and maps of YAML without brackets: as deep as the line is indented, and one deeper for
/// each `-` and `:` that may open another one on the same line.
bool indentation_too_deep(std::string_view text) noexcept {
  int depth = 0;
  bool indented = true;  // nothing but blanks in this line so far
  bool block = true;     // no bracket or comment in this line so far
  for (const char c : text) {
    if (c == '\n') {
      depth = 0;
      indented = true;
      block = true;
      continue;
    }
    block = block && c != '[' && c != '{' && c != '#';
    indented = indented && c == ' ';
    const bool deeper = indented || c == '-' || c == ':';
    depth += block && deeper ? 1 : 0;
    if (depth > kDeepest && !indented) {
      return true;
    }
  }
  return false;
}

bool tags_too_deep(std::string_view text) noexcept {
  Nesting nesting;
  for (std::size_t i = 0; i + 1 < text.size(); ++i) {
    const char next = text[i + 1];
    const bool tag = text[i] == '<' && next != '?' && next != '!';
    if ((tag && next == '/') || (text[i] == '/' && next == '>')) {
      nesting.close();
    } else if (tag) {
      nesting.open();
    }
    if (nesting.too_deep()) {
      return true;
    }
  }
  return false;
}

bool is_too_deep(std::string_view text) noexcept {
  const std::size_t start = text.find_first_not_of(" \t\r\n");
  const char first = start == std::string_view::npos ? ' ' : text[start];
  if (first == '<') {
    return tags_too_deep(text);
  }
  return brackets_too_deep(text) || (first != '{' && indentation_too_deep(text));
}

}  // namespace

void refuse_deep_nesting(const std::filesystem::path& file, std::string_view text) {
  if (is_too_deep(text)) {
    throw input_error(file,
                      "is nested too deep; expected at most " + std::to_string(kDeepest) +
                          " levels and " + std::to_string(kMostOpened) + " lists, maps or tags");
  }
}

}  // namespace skyhalo

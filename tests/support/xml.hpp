#pragma once

#include <cctype>
#include <string>
#include <string_view>
#include <vector>

namespace skyhalo::testing {

/// A small check that text is a well-formed XML document without comments, declarations and
/// processing instructions: nested tags, quoted attributes that do not repeat, known entities.
class XmlCheck {
 public:
  explicit XmlCheck(std::string_view text) : text_(text) {}

  /// What is wrong first; empty when nothing is.
  [[nodiscard]] std::string fault() {
    bool begun = false;
    while (at_ < text_.size() && fault_.empty()) {
      if (text_[at_] == '<') {
        if (begun && open_.empty()) {
          fail("a second root");
        }
        begun = true;
        tag();
      } else {
        content(open_.empty());
      }
    }
    if (fault_.empty() && (!begun || !open_.empty())) {
      fail("an element is not closed");
    }
    return fault_;
  }

 private:
  void fail(const std::string& what) {
    if (fault_.empty()) {
      fault_ = what + " at byte " + std::to_string(at_);
    }
  }

  [[nodiscard]] char peek() const { return at_ < text_.size() ? text_[at_] : '\0'; }

  void skip_blanks() {
    while (std::isspace(static_cast<unsigned char>(peek())) != 0) {
      ++at_;
    }
  }

  std::string name() {
    const std::size_t from = at_;
    while (std::isalnum(static_cast<unsigned char>(peek())) != 0 || peek() == '-' ||
           peek() == ':') {
      ++at_;
    }
    if (from == at_) {
      fail("a name is missing");
    }
    return std::string(text_.substr(from, at_ - from));
  }

  /// One letter of content or of an attribute.
  void letter() {
    const auto byte = static_cast<unsigned char>(peek());
    if (peek() == '&') {
      for (const std::string_view entity : {"&amp;", "&lt;", "&gt;", "&quot;", "&apos;"}) {
        if (text_.substr(at_).starts_with(entity)) {
          at_ += entity.size();
          return;
        }
      }
      fail("an unknown entity");
    } else if (peek() == '<' || (byte < 0x20 && byte != '\n' && byte != '\t')) {
      fail("a forbidden letter");
    }
    ++at_;
  }

  void content(bool outside) {
    if (outside && std::isspace(static_cast<unsigned char>(peek())) == 0) {
      fail("text outside the root");
    }
    letter();
  }

  void attributes() {
    std::vector<std::string> names;
    for (skip_blanks(); fault_.empty() && peek() != '>' && peek() != '/'; skip_blanks()) {
      const std::string attribute = name();
      for (const std::string& other : names) {
        if (other == attribute) {
          fail("an attribute repeats");
        }
      }
      names.push_back(attribute);
      if (!text_.substr(at_).starts_with("=\"")) {
        fail("an attribute without a quoted value");
        return;
      }
      at_ += 2;
      while (fault_.empty() && peek() != '"') {
        letter();
      }
      ++at_;
    }
  }

  void tag() {
    ++at_;
    const bool closes = peek() == '/';
    at_ += closes ? 1 : 0;
    const std::string element = name();
    if (closes) {
      if (open_.empty() || open_.back() != element) {
        fail("</" + element + "> closes nothing");
        return;
      }
      open_.pop_back();
    } else {
      attributes();
      if (peek() == '/') {
        ++at_;
      } else {
        open_.push_back(element);
      }
    }
    if (peek() != '>') {
      fail("a tag does not end");
    }
    ++at_;
  }

  std::string_view text_;
  std::size_t at_ = 0;
  std::vector<std::string> open_;
  std::string fault_;
};

/// What is wrong with the XML; empty when nothing is.
inline std::string xml_fault(std::string_view text) {
  return XmlCheck(text).fault();
}

}  // namespace skyhalo::testing

#include "skyhalo/calibration/opencv_storage.hpp"

#include <cmath>
#include <exception>
#include <opencv2/core.hpp>
#include <utility>

#include "skyhalo/calibration/nesting.hpp"
#include "skyhalo/io/text_file.hpp"

namespace skyhalo {
namespace {

/// OpenCV takes no YAML without this line, which other programs leave out.
std::string with_yaml_directive(const std::string& text) {
  const std::size_t start = text.find_first_not_of(" \t\r\n");
  const std::string_view body = std::string_view(text).substr(start);
  const bool known = body.starts_with("%YAML") || body.starts_with('{') || body.starts_with('<');
  return known ? text.substr(start) : "%YAML:1.0\n---\n" + text;
}

cv::FileStorage parse(const std::filesystem::path& file, const std::string& text) {
  try {
    return {with_yaml_directive(text), cv::FileStorage::READ | cv::FileStorage::MEMORY};
  } catch (const cv::Exception& error) {
    throw input_error(file, "OpenCV cannot read it: " + error.err);
  } catch (const std::exception& error) {  // its parser also lets through what strings throw
    throw input_error(file, std::string("OpenCV cannot read it: ") + error.what());
  }
}

/// OpenCV 4.6 crashes on some XML files that end in the middle.
void refuse_cut_xml(const std::filesystem::path& file, std::string_view text) {
  text.remove_prefix(text.find_first_not_of(" \t\r\n"));
  text = text.substr(0, text.find_last_not_of(" \t\r\n") + 1);
  if (text.starts_with('<') && !text.ends_with("</opencv_storage>")) {
    throw input_error(file, "breaks off: expected </opencv_storage> at its end");
  }
}

cv::FileStorage open(const std::filesystem::path& file) {
  const std::string text = read_bytes(file);
  if (text.find_first_not_of(" \t\r\n") == std::string::npos) {
    throw input_error(file, "is empty");
  }
  refuse_deep_nesting(file, text);
  refuse_cut_xml(file, text);
  cv::FileStorage storage = parse(file, text);
  if (!storage.isOpened() || storage.root().empty()) {
    throw input_error(file, "is no YAML, XML or JSON that OpenCV can read");
  }
  return storage;
}

bool is_matrix(const cv::FileNode& node) {
  return node.isMap() && !node["data"].empty();
}

void collect(const OpencvEntry& entry, const cv::FileNode& node, std::vector<double>& numbers) {
  if (node.isSeq()) {
    for (const cv::FileNode& item : node) {
      collect(entry, item, numbers);
    }
    return;
  }
  const bool number = node.isInt() || node.isReal();
  if (!number || !std::isfinite(node.real())) {
    throw entry.error("expected finite numbers" +
                      (node.isString() ? ", found '" + node.string() + "'" : std::string()));
  }
  numbers.push_back(node.real());
}

}  // namespace

Error OpencvEntry::error(std::string_view message) const {
  return input_error(file, key + ": " + std::string(message));
}

std::vector<double> OpencvEntry::numbers() const {
  std::vector<double> numbers;
  collect(*this, is_matrix(node) ? node["data"] : node, numbers);
  if (is_matrix(node)) {
    const auto rows = static_cast<double>(node["rows"]);
    const auto cols = static_cast<double>(node["cols"]);
    if (rows * cols != static_cast<double>(numbers.size())) {
      throw error("expected rows x cols numbers, found " + std::to_string(numbers.size()));
    }
  }
  return numbers;
}

std::vector<double> OpencvEntry::numbers(std::size_t count) const {
  std::vector<double> values = numbers();
  if (values.size() != count) {
    throw error("expected " + std::to_string(count) + " numbers, found " +
                std::to_string(values.size()));
  }
  return values;
}

std::string OpencvEntry::text() const {
  if (node.isString()) {
    return node.string();
  }
  return node.isInt() ? std::to_string(static_cast<int>(node)) : "";
}

OpencvStorage::OpencvStorage(std::span<const std::filesystem::path> files) {
  for (const std::filesystem::path& file : files) {
    files_.push_back({file, open(file)});
  }
}

std::optional<OpencvEntry> OpencvStorage::find(std::span<const std::string_view> keys) const {
  for (const std::string_view key : keys) {
    if (auto entry = find(key)) {
      return entry;
    }
  }
  return std::nullopt;
}

std::optional<OpencvEntry> OpencvStorage::find(std::string_view key) const {
  for (const File& file : files_) {
    const cv::FileNode root = file.storage.root();
    const cv::FileNode node = root.isMap() ? root[std::string(key)] : cv::FileNode();
    if (!node.empty()) {
      return OpencvEntry{file.path, std::string(key), node};
    }
  }
  return std::nullopt;
}

OpencvEntry OpencvStorage::at(std::span<const std::string_view> keys) const {
  std::optional<OpencvEntry> entry = find(keys);
  if (!entry) {
    std::string others;
    for (const std::string_view key : keys.subspan(1)) {
      others += (others.empty() ? " (nor " : ", ") + std::string(key);
    }
    others += others.empty() ? "" : ")";
    throw error(std::string(keys.front()) + others + ": this key is missing");
  }
  return *std::move(entry);
}

Error OpencvStorage::error(std::string_view message) const {
  std::string names;
  for (const File& file : files_) {
    names += (names.empty() ? "" : ", ") + file.path.string();
  }
  return input_error(names, message);
}

}  // namespace skyhalo

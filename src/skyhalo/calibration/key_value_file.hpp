#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "skyhalo/base/error.hpp"

namespace skyhalo {

/// A file of lines `KEY: numbers`, as KITTI's calibration comes. The colon may be missing, lines
/// may end the Windows way, and lines without a key are skipped. Values that are not numbers matter
/// only when asked for.
class KeyValueFile {
 public:
  /// Throws `Error` (input) when the file cannot be read.
  explicit KeyValueFile(std::filesystem::path file);

  /// Exactly `count` finite numbers. Throws `Error` (input) with file, line and key when the key is
  /// missing, a word is no finite number or their count differs.
  [[nodiscard]] std::vector<double> numbers(const std::string& key, std::size_t count) const;

  [[nodiscard]] bool has(const std::string& key) const { return entries_.contains(key); }

  /// An input error about a key, with file and line.
  [[nodiscard]] Error error(const std::string& key, const std::string& message) const;

 private:
  struct Entry {
    int line = 0;
    std::string values;
  };

  std::filesystem::path file_;
  std::map<std::string, Entry> entries_;
};

}  // namespace skyhalo

#pragma once

#include <filesystem>
#include <opencv2/core/persistence.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "skyhalo/base/error.hpp"

namespace skyhalo {

/// An entry of an OpenCV file, with the file it is from.
struct OpencvEntry {
  std::filesystem::path file;
  std::string key;
  cv::FileNode node;

  /// `FILE: KEY: message`.
  [[nodiscard]] Error error(std::string_view message) const;

  /// Finite numbers: of a matrix row by row, of a list, or a single one.
  [[nodiscard]] std::vector<double> numbers() const;

  /// The same, exactly `count`.
  [[nodiscard]] std::vector<double> numbers(std::size_t count) const;

  /// A word, or a number as text.
  [[nodiscard]] std::string text() const;
};

/// The entries of one or several files of `cv::FileStorage`, taken together. Internal to this
/// layer.
class OpencvStorage {
 public:
  /// Throws `Error` (input) naming the file when one cannot be read, is empty, malformed
  /// or nested deeper than 100 levels.
  explicit OpencvStorage(std::span<const std::filesystem::path> files);

  /// The first of these keys that is there; none when none is.
  [[nodiscard]] std::optional<OpencvEntry> find(std::span<const std::string_view> keys) const;
  [[nodiscard]] std::optional<OpencvEntry> find(std::string_view key) const;

  /// As `find`; throws `Error` (input) naming the files and the keys when none is there.
  [[nodiscard]] OpencvEntry at(std::span<const std::string_view> keys) const;

  /// An error about all the files.
  [[nodiscard]] Error error(std::string_view message) const;

 private:
  struct File {
    std::filesystem::path path;
    cv::FileStorage storage;
  };

  std::vector<File> files_;
};

}  // namespace skyhalo

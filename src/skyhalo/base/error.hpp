#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>
#include <string_view>

namespace skyhalo {

/// Whose fault an error is: decides the exit code of the program.
enum class ErrorKind {
  kFailure,    ///< failed while running, for instance an unwritable output
  kInput,      ///< a file, calibration or configuration is wrong
  kCancelled,  ///< the caller asked to stop
};

/// The one exception type of the library's edges. The message is complete: what is wrong, where
/// (file, line, key) and what was expected.
class Error : public std::runtime_error {
 public:
  Error(ErrorKind kind, const std::string& message) : std::runtime_error(message), kind_(kind) {}

  [[nodiscard]] ErrorKind kind() const noexcept { return kind_; }

 private:
  ErrorKind kind_;
};

/// An input error that names the file: `FILE: message`.
[[nodiscard]] Error input_error(const std::filesystem::path& file, std::string_view message);

/// An input error that names file and line (counted from 1): `FILE:LINE: message`.
[[nodiscard]] Error input_error(const std::filesystem::path& file,
                                int line,
                                std::string_view message);

}  // namespace skyhalo

#include "skyhalo/base/error.hpp"

namespace skyhalo {

Error input_error(const std::filesystem::path& file, std::string_view message) {
  return {ErrorKind::kInput, file.string() + ": " + std::string(message)};
}

Error input_error(const std::filesystem::path& file, int line, std::string_view message) {
  return {ErrorKind::kInput,
          file.string() + ":" + std::to_string(line) + ": " + std::string(message)};
}

}  // namespace skyhalo

#include "skyhalo/calibration/file_status.hpp"

#include <system_error>

#include "skyhalo/base/error.hpp"

namespace skyhalo {
namespace {

std::filesystem::file_status status_of(const std::filesystem::path& path) {
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(path, error);
  if (!status_known(status)) {
    throw input_error(path, "cannot be read: " + error.message());
  }
  return status;
}

}  // namespace

bool is_there(const std::filesystem::path& path) {
  return exists(status_of(path));
}

bool is_folder(const std::filesystem::path& path) {
  return is_directory(status_of(path));
}

}  // namespace skyhalo

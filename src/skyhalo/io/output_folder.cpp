#include "skyhalo/io/output_folder.hpp"

#include <unistd.h>

#include <fstream>
#include <string>
#include <system_error>
#include <utility>

#include "skyhalo/base/error.hpp"

namespace skyhalo {
namespace {

namespace fs = std::filesystem;

Error cannot_write(const fs::path& path, const std::error_code& reason) {
  return {ErrorKind::kFailure, path.string() + ": cannot be written (" + reason.message() + ")"};
}

/// The topmost part of the path that does not exist yet; empty if all of it does.
fs::path first_missing(const fs::path& path) {
  fs::path missing;
  std::error_code ignored;
  for (fs::path p = fs::absolute(path).lexically_normal(); !p.empty() && !fs::exists(p, ignored);
       p = p.parent_path()) {
    missing = p;
  }
  return missing;
}

}  // namespace

void write_bytes(const fs::path& file, std::string_view bytes) {
  std::ofstream stream(file, std::ios::binary);
  stream.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  stream.close();
  if (!stream) {
    throw cannot_write(file, std::error_code(errno, std::generic_category()));
  }
}

OutputFolder::OutputFolder(fs::path folder)
    : folder_(std::move(folder)), created_(first_missing(folder_)) {
  staging_ = folder_ / (".unfinished-" + std::to_string(::getpid()));
  std::error_code status;
  fs::create_directories(staging_, status);
  if (status) {
    std::error_code ignored;
    fs::remove_all(created_.empty() ? staging_ : created_, ignored);
    throw cannot_write(folder_, status);
  }
}

OutputFolder::~OutputFolder() {
  std::error_code ignored;
  fs::remove_all(staging_, ignored);
  if (!committed_ && !created_.empty()) {
    fs::remove_all(created_, ignored);
  }
}

void OutputFolder::commit() {
  std::error_code status;
  for (const fs::directory_entry& entry : fs::directory_iterator(staging_)) {
    fs::rename(entry.path(), folder_ / entry.path().filename(), status);
    if (status) {
      throw cannot_write(folder_ / entry.path().filename(), status);
    }
  }
  committed_ = true;
}

}  // namespace skyhalo

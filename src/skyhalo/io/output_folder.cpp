#include "skyhalo/io/output_folder.hpp"

#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
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

/// The permissions that new files do not get.
fs::perms current_mask() {
  const mode_t mask = ::umask(0);
  ::umask(mask);
  return static_cast<fs::perms>(mask);
}

/// Removes a folder and its parents up to `topmost`, as far as they are empty: others may use them
/// too.
void remove_empty(fs::path folder, const fs::path& topmost) {
  std::error_code status;
  folder = fs::absolute(folder).lexically_normal();
  while (!topmost.empty() && fs::remove(folder, status) && folder != topmost) {
    folder = folder.parent_path();
  }
}

}  // namespace

void write_bytes(const fs::path& file, std::string_view bytes) {
  errno = 0;
  std::ofstream stream(file, std::ios::binary);
  stream.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  stream.close();
  if (!stream) {
    throw cannot_write(file, std::error_code(errno, std::generic_category()));
  }
}

void replace_file(const fs::path& file, std::string_view bytes) {
  std::error_code ignored;
  const fs::file_status there = fs::symlink_status(file, ignored);
  if (fs::exists(there) && !fs::is_regular_file(there)) {
    write_bytes(file, bytes);
    return;
  }
  std::string beside = file.string() + ".unfinished-XXXXXX";
  const int handle = ::mkstemp(beside.data());
  if (handle < 0) {
    throw cannot_write(file, std::error_code(errno, std::generic_category()));
  }
  ::close(handle);
  std::error_code status;
  try {
    write_bytes(beside, bytes);
    const fs::perms wanted = fs::exists(file, ignored) ? fs::status(file, ignored).permissions()
                                                       : fs::perms(0666) & ~current_mask();
    fs::permissions(beside, wanted, status);
    fs::rename(beside, file, status);
  } catch (const Error&) {
    fs::remove(beside, ignored);
    throw cannot_write(file, std::make_error_code(std::errc::io_error));
  }
  if (status) {
    fs::remove(beside, ignored);
    throw cannot_write(file, status);
  }
}

OutputFolder::OutputFolder(fs::path folder) : folder_(std::move(folder)) {
  if (folder_.empty()) {
    throw Error(ErrorKind::kFailure, "output folder: expected a name, found nothing");
  }
  created_ = first_missing(folder_);
  std::error_code status;
  fs::create_directories(folder_, status);
  // A name of its own even where process numbers repeat, as in containers.
  std::string name = (folder_ / ".unfinished-XXXXXX").string();
  if (!status && ::mkdtemp(name.data()) == nullptr) {
    status = std::error_code(errno, std::generic_category());
  }
  if (status) {
    // Of the folders on the way, the deepest that was made comes first.
    fs::path made = fs::absolute(folder_).lexically_normal();
    std::error_code ignored;
    while (!created_.empty() && made != created_ && !fs::exists(made, ignored)) {
      made = made.parent_path();
    }
    remove_empty(made, created_);
    throw cannot_write(folder_, status);
  }
  staging_ = name;
  fs::permissions(staging_, fs::status(folder_).permissions(), status);
}

OutputFolder::~OutputFolder() {
  std::error_code ignored;
  fs::remove_all(staging_, ignored);
  if (!committed_) {
    remove_empty(folder_, created_);
  }
}

void OutputFolder::commit() {
  std::error_code status;
  for (const fs::directory_entry& entry : fs::directory_iterator(staging_)) {
    const fs::path target = folder_ / entry.path().filename();
    if (fs::is_directory(target, status)) {
      throw cannot_write(target, std::make_error_code(std::errc::is_a_directory));
    }
  }
  for (const fs::directory_entry& entry : fs::directory_iterator(staging_)) {
    fs::rename(entry.path(), folder_ / entry.path().filename(), status);
    if (status) {
      throw cannot_write(folder_ / entry.path().filename(), status);
    }
  }
  for (const std::string& name : left_out_) {
    const fs::path earlier = folder_ / name;
    if (!fs::is_directory(earlier, status) && !fs::remove(earlier, status) && status) {
      throw cannot_write(earlier, status);
    }
  }
  committed_ = true;
}

}  // namespace skyhalo

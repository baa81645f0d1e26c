#include "skyhalo/io/staged_folder.hpp"

#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <string>
#include <system_error>

#include "skyhalo/base/error.hpp"

namespace skyhalo {
namespace {

namespace fs = std::filesystem;

Error cannot_write_folder(const fs::path& path, const std::string& reason) {
  return {ErrorKind::kFailure, path.string() + ": cannot be written (" + reason + ")"};
}

/// An absolute path without a slash at its end; links are followed.
fs::path plain_folder(const fs::path& folder) {
  if (folder.empty()) {
    throw Error(ErrorKind::kFailure, "output folder: expected a name, found nothing");
  }
  std::error_code status;
  const fs::path whole = fs::weakly_canonical(fs::absolute(folder, status), status);
  fs::path plain = whole.filename().empty() ? whole.parent_path() : whole;
  if (status || plain.filename().empty()) {
    throw cannot_write_folder(folder, status ? status.message() : "is no name for a folder");
  }
  return plain;
}

void make_folders(const fs::path& folder) {
  std::error_code status;
  fs::create_directories(folder, status);
  if (status) {
    throw cannot_write_folder(folder, status.message());
  }
}

void move(const fs::path& from, const fs::path& to) {
  std::error_code status;
  fs::rename(from, to, status);
  if (status) {
    throw cannot_write_folder(to, status.message());
  }
}

}  // namespace

void expect_unused(const fs::path& folder) {
  std::error_code status;
  if (fs::exists(fs::symlink_status(folder, status)) &&
      !(fs::is_directory(folder, status) && fs::is_empty(folder, status) && !status)) {
    throw cannot_write_folder(folder, "something is there already");
  }
}

StagedFolder::StagedFolder(const fs::path& folder) : folder_(plain_folder(folder)) {
  make_folders(folder_.parent_path());
  const std::string hidden = "." + folder_.filename().string() + ".unfinished-XXXXXX";
  std::string name = (folder_.parent_path() / hidden).string();
  if (::mkdtemp(name.data()) == nullptr) {
    throw cannot_write_folder(folder_, std::error_code(errno, std::generic_category()).message());
  }
  staging_ = name;
  const mode_t mask = ::umask(0);
  ::umask(mask);
  std::error_code ignored;
  fs::permissions(staging_, fs::perms(0777) & ~static_cast<fs::perms>(mask), ignored);
}

StagedFolder::~StagedFolder() {
  std::error_code ignored;
  fs::remove_all(staging_, ignored);
}

fs::path StagedFolder::file(const fs::path& relative) const {
  if (committed_) {
    throw cannot_write_folder(folder_ / relative, "the folder is finished");
  }
  fs::path file = staging_ / relative;
  make_folders(file.parent_path());
  return file;
}

void StagedFolder::commit() {
  if (committed_) {
    throw cannot_write_folder(folder_, "the folder is finished");
  }
  expect_unused(folder_);
  move(staging_, folder_);
  committed_ = true;
}

void StagedFolder::commit(const std::vector<fs::path>& parts) {
  if (committed_) {
    throw cannot_write_folder(folder_, "the folder is finished");
  }
  for (const fs::path& part : parts) {
    expect_unused(folder_ / part);
  }
  std::size_t moved = 0;
  try {
    for (; moved < parts.size(); ++moved) {
      make_folders((folder_ / parts[moved]).parent_path());
      move(staging_ / parts[moved], folder_ / parts[moved]);
    }
  } catch (...) {  // all of them or none
    std::error_code ignored;
    while (moved > 0) {
      --moved;
      fs::rename(folder_ / parts[moved], staging_ / parts[moved], ignored);
    }
    throw;
  }
  committed_ = true;
}

}  // namespace skyhalo

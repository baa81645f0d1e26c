#include "skyhalo/io/unfinished_file.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <random>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

#include "skyhalo/base/error.hpp"

namespace skyhalo {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kMark = ".unfinished-";
constexpr std::size_t kRandomLetters = 6;

Error cannot_write(const fs::path& file, int reason) {
  const std::error_code code(reason, std::generic_category());
  return {ErrorKind::kFailure, file.string() + ": cannot be written (" + code.message() + ")"};
}

/// How the unfinished files of a name begin.
std::string prefix_of(const fs::path& target) {
  return "." + target.filename().string() + std::string(kMark);
}

/// The name that an unfinished file is to get; empty for other files.
std::string target_name(const std::string& name) {
  constexpr std::size_t kEnd = kMark.size() + kRandomLetters;
  if (!name.starts_with('.') || name.size() <= kEnd + 1 ||
      name.compare(name.size() - kEnd, kMark.size(), kMark) != 0) {
    return "";
  }
  return name.substr(1, name.size() - kEnd - 1);
}

fs::path folder_of(const fs::path& target) {
  return target.has_parent_path() ? target.parent_path() : fs::path(".");
}

std::string random_letters() {
  constexpr std::string_view kLetters = "abcdefghijklmnopqrstuvwxyz0123456789";
  std::random_device random;
  std::string letters;
  for (std::size_t i = 0; i < kRandomLetters; ++i) {
    letters += kLetters[random() % kLetters.size()];
  }
  return letters;
}

/// Removes an unfinished file unless a program still holds its lock.
void remove_if_abandoned(const fs::path& file) {
  const int handle = ::open(file.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
  if (handle < 0) {
    return;
  }
  if (::flock(handle, LOCK_EX | LOCK_NB) == 0) {
    ::unlink(file.c_str());
  }
  ::close(handle);
}

/// A new file with the lock held, or -1 (see `errno`). Between making and locking it, another
/// program may take it for abandoned: then it is made again.
int create_locked(const fs::path& file) {
  const int handle = ::open(file.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);

  struct stat status {};

  if (handle >= 0 && ::flock(handle, LOCK_EX) == 0 && ::fstat(handle, &status) == 0 &&
      status.st_nlink == 0) {
    ::close(handle);
    errno = EEXIST;
    return -1;
  }
  return handle;
}

/// Brings a folder's entries to the disk. File systems that cannot do so have nothing to lose.
void sync_folder(const fs::path& folder) {
  const int handle = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (handle >= 0) {
    ::fsync(handle);
    ::close(handle);
  }
}

}  // namespace

void remove_unfinished_files(const fs::path& folder,
                             const std::function<bool(const std::string& name)>& is_name) {
  std::error_code ignored;
  for (fs::directory_iterator entry(folder, ignored), end; entry != end; entry.increment(ignored)) {
    const std::string name = target_name(entry->path().filename().string());
    if (!name.empty() && is_name(name) && fs::is_regular_file(entry->symlink_status(ignored))) {
      remove_if_abandoned(entry->path());
    }
  }
}

UnfinishedFile::UnfinishedFile(fs::path file, Leftovers leftovers) : name_(std::move(file)) {
  std::error_code status;
  if (fs::is_directory(name_, status)) {
    throw cannot_write(name_, EISDIR);
  }
  if (fs::exists(name_, status) && !fs::is_regular_file(name_, status)) {
    path_ = name_;
    return;
  }
  target_ = fs::is_symlink(name_, status) ? fs::weakly_canonical(name_, status) : name_;
  if (target_.filename().empty()) {
    throw cannot_write(name_, ENOENT);
  }
  if (leftovers == Leftovers::kRemove) {
    remove_unfinished_files(folder_of(target_),
                            [&](const std::string& name) { return name == target_.filename(); });
  }
  create();
}

void UnfinishedFile::create() {
  constexpr int kTries = 100;
  for (int i = 0; i < kTries && handle_ < 0; ++i) {
    path_ = folder_of(target_) / (prefix_of(target_) + random_letters());
    handle_ = create_locked(path_);
    if (handle_ < 0 && errno != EEXIST) {
      break;
    }
  }
  if (handle_ < 0) {
    throw cannot_write(name_, errno);
  }
}

UnfinishedFile::~UnfinishedFile() {
  if (handle_ >= 0) {
    ::unlink(path_.c_str());
    ::close(handle_);
  }
}

void UnfinishedFile::commit(std::ofstream& stream) {
  stream.close();
  if (!stream) {
    throw cannot_write(name_, errno);
  }
  commit();
}

void UnfinishedFile::commit() {
  if (handle_ < 0) {
    return;
  }

  struct stat earlier {};

  if (::stat(target_.c_str(), &earlier) == 0) {
    // Kept as far as the system allows it.
    (void)!::fchmod(handle_, earlier.st_mode & 07777U);
  }
  if (::fsync(handle_) != 0 || ::rename(path_.c_str(), target_.c_str()) != 0) {
    throw cannot_write(name_, errno);
  }
  ::close(handle_);
  handle_ = -1;
  sync_folder(folder_of(target_));
}

}  // namespace skyhalo

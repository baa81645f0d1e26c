#include "skyhalo/io/folder_lock.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

#include "skyhalo/base/error.hpp"

namespace skyhalo {

FolderLock::FolderLock(const std::filesystem::path& folder)
    : handle_(::open((folder / ".lock").c_str(), O_RDWR | O_CREAT | O_NOFOLLOW | O_CLOEXEC, 0666)) {
  if (handle_ < 0) {
    const std::error_code reason(errno, std::generic_category());
    throw Error(
        ErrorKind::kFailure,
        (folder / ".lock").string() + ": cannot be opened for writing (" + reason.message() + ")");
  }
  if (::flock(handle_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
    ::close(handle_);
    throw input_error(folder, "is in use by another run; wait for its end or take another folder");
  }
}

FolderLock::~FolderLock() {
  ::close(handle_);
}

}  // namespace skyhalo

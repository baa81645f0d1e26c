#pragma once

#include <filesystem>

namespace skyhalo {

/// Keeps a folder for one program at a time, by a lock on the file `.lock` in it. The lock is gone
/// with this object or with the program, however it ends; the file stays, since removing it could
/// let two programs in. On file systems without locks it keeps nobody out.
class FolderLock {
 public:
  /// Throws `Error`: input when somebody has the folder, failure when the file cannot be made.
  explicit FolderLock(const std::filesystem::path& folder);
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;
  FolderLock(FolderLock&&) = delete;
  FolderLock& operator=(FolderLock&&) = delete;
  ~FolderLock();

 private:
  int handle_;
};

}  // namespace skyhalo

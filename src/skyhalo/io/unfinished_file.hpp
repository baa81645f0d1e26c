#pragma once

#include <filesystem>
#include <fstream>
#include <functional>
#include <string>

namespace skyhalo {

/// What to do about unfinished files that killed programs left of a name.
enum class Leftovers {
  kRemove,  ///< looks through the whole folder for them
  kLeave,   ///< for many files in one folder, with `remove_unfinished_files` once before
};

/// Removes what killed programs left in a folder of files whose names `is_name` accepts; what is
/// still being written stays. Does nothing where it may not.
void remove_unfinished_files(const std::filesystem::path& folder,
                             const std::function<bool(const std::string& name)>& is_name);

/// A file that appears whole or not at all, whatever happens to the program or the machine: it is
/// written beside its place, as `.NAME.unfinished-XXXXXX`, and `commit` brings it to the disk and
/// renames it. What a killed program left of an earlier try is removed by the next one for the same
/// name, unless it is told to leave it; another program's that is still being written is not.
class UnfinishedFile {
 public:
  /// Creates the file to write to. Links are followed; what is no regular file, such as
  /// /dev/stdout, is written directly. Missing folders are not made. Throws `Error` (failure)
  /// naming the file.
  explicit UnfinishedFile(std::filesystem::path file, Leftovers leftovers = Leftovers::kRemove);
  UnfinishedFile(const UnfinishedFile&) = delete;
  UnfinishedFile& operator=(const UnfinishedFile&) = delete;
  UnfinishedFile(UnfinishedFile&&) = delete;
  UnfinishedFile& operator=(UnfinishedFile&&) = delete;

  /// Removes what was not committed.
  ~UnfinishedFile();

  /// Where to write until `commit`.
  [[nodiscard]] const std::filesystem::path& path() const noexcept { return path_; }

  /// Replaces the file of the name by the one that was written. On return it has reached the disk.
  /// Throws `Error` (failure) naming the file, and leaves an earlier one as it was.
  void commit();

  /// The same after closing the stream that wrote it; throws too when anything was not written.
  void commit(std::ofstream& stream);

 private:
  void create();

  std::filesystem::path name_;    // as the caller said it, for messages
  std::filesystem::path target_;  // where links lead to
  std::filesystem::path path_;
  int handle_ = -1;  // holds the lock that tells others the file is in work; -1: written directly
};

}  // namespace skyhalo

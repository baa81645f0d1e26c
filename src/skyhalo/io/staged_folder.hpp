#pragma once

#include <filesystem>
#include <vector>

namespace skyhalo {

/// A folder, with folders in it, whose content appears whole: it is written beside its place, as
/// `.NAME.unfinished-XXXXXX`, and `commit` renames it. Without a commit nothing of it stays; a
/// killed program leaves the hidden folder.
class StagedFolder {
 public:
  /// Makes the hidden folder, and the missing folders above. Throws `Error` (failure) when it
  /// cannot be made.
  explicit StagedFolder(const std::filesystem::path& folder);
  StagedFolder(const StagedFolder&) = delete;
  StagedFolder& operator=(const StagedFolder&) = delete;
  StagedFolder(StagedFolder&&) = delete;
  StagedFolder& operator=(StagedFolder&&) = delete;

  /// Removes what was not committed.
  ~StagedFolder();

  /// Where the content appears: an absolute path.
  [[nodiscard]] const std::filesystem::path& folder() const noexcept { return folder_; }

  /// Where to write a file until `commit`, for a path below the folder. Missing folders on the way
  /// are made. Throws `Error` (failure) when that cannot be done, or after `commit`.
  [[nodiscard]] std::filesystem::path file(const std::filesystem::path& relative) const;

  /// Whether `commit` has been called.
  [[nodiscard]] bool committed() const noexcept { return committed_; }

  /// Renames the whole folder to its name, where nothing or an empty folder is. Throws `Error`
  /// (failure) when something else is.
  void commit();

  /// Moves only these files and folders (paths below the folder, in this order) into a folder that
  /// may hold others already. Throws `Error` (failure), before it moves any, when one of them is
  /// there already.
  void commit(const std::vector<std::filesystem::path>& parts);

 private:
  std::filesystem::path folder_;
  std::filesystem::path staging_;
  bool committed_ = false;
};

/// Throws `Error` (failure) when something other than an empty folder is at the path.
void expect_unused(const std::filesystem::path& folder);

}  // namespace skyhalo

#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace skyhalo {

/// Writes a whole file. Throws `Error` (failure) naming the file when it cannot be written.
void write_bytes(const std::filesystem::path& file, std::string_view bytes);

/// Writes a whole file under a name that is never seen half written: beside it first, then renamed
/// over it; links and what is no file, such as /dev/stdout, are written directly. Missing folders
/// are not made. Throws `Error` (failure) naming the file, and leaves an earlier one as it was.
void replace_file(const std::filesystem::path& file, std::string_view bytes);

/// A folder of results that appear all at once: files are written to a hidden folder inside, and
/// `commit` moves them to their names. Without a commit nothing of them stays, and earlier results
/// in the folder are untouched.
class OutputFolder {
 public:
  /// Creates the folder and its parents. Throws `Error` (failure) at once when it cannot be written
  /// to.
  explicit OutputFolder(std::filesystem::path folder);
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;
  OutputFolder(OutputFolder&&) = delete;
  OutputFolder& operator=(OutputFolder&&) = delete;

  /// Removes what was not committed, and the folder too if this object created it and nobody else
  /// uses it.
  ~OutputFolder();

  /// Where to write the file called `name` until `commit`.
  [[nodiscard]] std::filesystem::path file(std::string_view name) const { return staging_ / name; }

  /// The folder that the results appear in.
  [[nodiscard]] const std::filesystem::path& folder() const noexcept { return folder_; }

  /// From `commit` on there is no file called `name`: an earlier result that these lack must not
  /// seem to be one of them.
  void leave_out(std::string_view name) { left_out_.emplace_back(name); }

  /// Moves all files to their names, replacing earlier ones. Throws `Error` (failure).
  void commit();

 private:
  std::filesystem::path folder_;
  std::filesystem::path staging_;
  std::filesystem::path created_;  // the topmost folder that did not exist before; empty for none
  std::vector<std::string> left_out_;
  bool committed_ = false;
};

}  // namespace skyhalo

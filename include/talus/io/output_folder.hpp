#pragma once
#include <filesystem>
#include <string>
#include <string_view>

namespace talus::io {

/// A folder of results that appears under its name complete, or not at all.
///
/// Everything is written into a hidden folder beside it, `.NAME.talus-PID`, so that a rename is all that `commit` has
/// to do. Without `commit` (an exception, an interruption, a full disk) the hidden folder is removed.
class OutputFolder {
 public:
  /// @param overwrite  an earlier result of talus (it holds a run.json, calibration.json or diagnosis.json) may be
  /// replaced Throws InputError where the name is taken or nothing can be written there.
  OutputFolder(const std::filesystem::path& path, bool overwrite);
  ~OutputFolder();
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;

  /// Where to write until `commit`.
  const std::filesystem::path& temporary() const { return temporary_; }
  /// Absolute; what the user will find.
  const std::filesystem::path& final_path() const { return final_; }

  /// Throws InputError where `file` lies in a folder that `commit` would replace: an input must not be deleted.
  void protect(const std::filesystem::path& file) const;

  /// Brings all files to the disk and gives the folder its name. An earlier result is moved aside first, put back where
  /// the rename fails, and removed last. Throws std::runtime_error.
  void commit();

 private:
  std::filesystem::path final_, temporary_;
  bool committed_ = false;
};

/// Writes a text file. Throws std::runtime_error, one line with the file and the cause; no half file is left.
void write_text(const std::filesystem::path& file, std::string_view text);

/// Writes a text file beside others of a finished folder: under a hidden name first, renamed when it is complete. What
/// had the name before is replaced. Throws as `write_text`.
void replace_text(const std::filesystem::path& file, std::string_view text);

/// Why a library could not write into a folder: that the disk is full, where it is; else the first of its messages.
std::string cause_of_failure(const std::filesystem::path& folder, const std::string& messages);

}  // namespace talus::io

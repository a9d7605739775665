#pragma once
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

namespace talus::io {

class FolderLock;

/// A folder of results that appears under its name complete, or not at all.
///
/// Everything is written into a hidden folder beside it, `.NAME.talus-PID`, so that a rename is all that `commit` has
/// to do. Without `commit` (an exception, an interruption, a full disk) the hidden folder is removed, unless it is to
/// be kept for a run that goes on.
class OutputFolder {
 public:
  /// What to do with the hidden folder of an interrupted run of this name. While a process has one, no other may
  /// begin a run of this name; what was killed before it kept anything is removed.
  enum class Unfinished {
    Ignore,  ///< this command leaves none
    Refuse,  ///< InputError with the way out; where `overwrite` is given, it is removed
    Resume   ///< it becomes this one's, where there is one, with the maps that it had finished
  };

  /// @param overwrite  an earlier result of talus (it holds a run.json, part.json, calibration.json or diagnosis.json)
  /// may be replaced. Throws InputError where the name is taken or nothing can be written there.
  OutputFolder(const std::filesystem::path& path, bool overwrite, Unfinished unfinished = Unfinished::Ignore);
  ~OutputFolder();
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;

  /// Where to write until `commit`.
  const std::filesystem::path& temporary() const { return temporary_; }
  /// Where in it a run keeps its work while it goes on: what is looked for by `Unfinished`.
  std::filesystem::path work() const { return temporary_ / kWork; }
  static constexpr const char* kWork = "unfinished";
  /// The hidden folder stays where there is no `commit`.
  void keep() { kept_ = true; }
  /// Absolute; what the user will find.
  const std::filesystem::path& final_path() const { return final_; }

  /// Throws InputError where `file` lies in a folder that `commit` would replace: an input must not be deleted.
  void protect(const std::filesystem::path& file) const;

  /// Brings all files to the disk and gives the folder its name, if that is still free or may be overwritten. An
  /// earlier result is moved aside first, put back where the rename fails, and removed last. Throws std::runtime_error.
  void commit();
  /// The same of `work` alone, which becomes the folder of results in one step.
  void commit_work();

 private:
  /// Makes `work`, and marks it as in use until this process ends, however that comes.
  void hold_work();
  void commit(const std::filesystem::path& folder);
  std::filesystem::path final_, temporary_;
  bool overwrite_, committed_ = false, kept_ = false;
  std::unique_ptr<FolderLock> lock_;  // of `work`
};

/// From now on what grows with the map lies in a file beside the results as far as it does not fit into so many bytes.
/// Before anything is read. Throws InputError where there is no folder for the results to go into.
void limit_memory(const std::filesystem::path& results, std::size_t bytes);

/// Waits until a file, or the entries of a folder, are on the disk: some file systems tell only now that it is full.
/// Throws std::runtime_error.
void synchronise(const std::filesystem::path& path);

/// Writes a text file. Throws std::runtime_error, one line with the file and the cause; no half file is left.
void write_text(const std::filesystem::path& file, std::string_view text);

/// Writes a text file beside others of a finished folder: under a hidden name first, renamed when it is complete. What
/// had the name before is replaced. Throws as `write_text`.
void replace_text(const std::filesystem::path& file, std::string_view text);

/// Why a library could not write into a folder: that the disk is full, where it is; else the first of its messages.
std::string cause_of_failure(const std::filesystem::path& folder, const std::string& messages);

}  // namespace talus::io

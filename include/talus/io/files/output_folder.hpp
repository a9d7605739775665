#pragma once
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "talus/io/files/made_folders.hpp"
#include "talus/io/files/staged_path.hpp"

namespace talus::io {

class FolderLock;

/// A folder of results that appears under its name complete, or not at all.
///
/// Everything is written into a hidden folder beside it, `.NAME.talus-PID` (`StagedPath`), so that a rename is all that
/// `commit` has to do. Without `commit` (an exception, an interruption, a full disk) the hidden folder is removed,
/// unless `keep` was called, so that the run can be resumed. Folders above it that are not there are made, and removed
/// again if nothing came into them.
class OutputFolder {
 public:
  /// Treatment of the hidden folders with saved work that interrupted runs of this name have left. Those without saved
  /// work, of processes that were killed, are removed.
  enum class Unfinished {
    Ignore,  ///< this command saves no work: that of others stays
    Refuse,  ///< throws InputError with the way out; with `overwrite` removes them
    Resume   ///< takes over the latest, if there is one, with its finished maps
  };

  /// Throws InputError if the name is taken, if another process writes a result of this name, if there are files in it
  /// that are not of this result, or if nothing can be written there.
  /// @param overwrite  an earlier result of the same command may be replaced (it holds a run.json, part.json,
  /// calibration.json, diagnosis.json or compare.json)
  /// @param command    that writes the results; parts and merged ones are those of "talus run", too
  OutputFolder(const std::filesystem::path& path, bool overwrite, Unfinished unfinished = Unfinished::Ignore,
               std::string command = "talus run");
  ~OutputFolder();
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;

  /// Where to write until `commit`.
  const std::filesystem::path& temporary() const { return staged_.hidden(); }
  /// Folder inside it where a run saves its work. `Unfinished` looks for this folder.
  std::filesystem::path work() const { return temporary() / kWork; }
  static constexpr const char* kWork = "unfinished";
  /// Without `commit` the hidden folder stays.
  void keep() { staged_.keep(); }
  /// Absolute path of the folder after `commit`.
  const std::filesystem::path& final_path() const { return staged_.path(); }

  /// Throws InputError if `file` lies in a folder that `commit` would replace: an input must not be deleted.
  void protect(const std::filesystem::path& file) const;

  /// A line that names the files of later commands (hazard, barrier, report) which `commit` would remove; empty if
  /// there are none.
  std::string later_results_note() const;

  /// Brings all files to the disk and gives the folder its name, if that is still free or may be overwritten. An
  /// earlier result is moved aside first, put back if the rename fails, and removed last. Throws std::runtime_error.
  void commit();
  /// Makes `work` alone the folder of results, in one step, and removes the rest.
  void commit_work();

 private:
  /// Makes `work` and marks it as in use until this process ends, even if it is killed.
  void hold_work();
  /// Keeps finished results that cannot get their name. Without a lock no later command takes them for what a killed
  /// process has left.
  void keep_results();
  void commit(const std::filesystem::path& folder);
  MadeFolders parents_;  // before `staged_`: removed after it
  StagedPath staged_;
  bool overwrite_;
  std::string command_;
  std::unique_ptr<FolderLock> lock_;  // of `work`
};

/// The absolute name of a folder of results, through symbolic links, without a slash at its end. Throws InputError if
/// no folder can have this name.
std::filesystem::path full_name(const std::filesystem::path& path);

/// Throws InputError, with the way out, where a folder holds no run.json: it is no folder of results.
void require_results(const std::filesystem::path& folder);

/// Writes a text file. Throws std::runtime_error, one line with the file and the cause; no half file is left.
/// @param name  of the file in the message, where the file has a hidden name; empty: its own
void write_text(const std::filesystem::path& file, std::string_view text, const std::string& name = {});

/// Writes a text file beside others of a finished folder: under a hidden name first, renamed when it is complete. An
/// earlier file of this name is replaced. Throws as `write_text`.
void replace_text(const std::filesystem::path& file, std::string_view text);

/// Whether `calibrate` and `diagnose` write a file of this name, so that no folder among their results can have it.
bool is_fit_file(const std::string& name);

/// The names of the files in a folder, in the order of the alphabet.
std::vector<std::string> files_in(const std::filesystem::path& folder);

}  // namespace talus::io

#pragma once
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "talus/io/files/staged_path.hpp"

namespace talus::io {

class FolderLock;

/// Files that are added to a folder of results: written into a hidden folder inside it, `.NAME.talus-PID`, and renamed
/// one by one at the end, a record of them last. Without `commit` nothing changes.
class StagedFiles {
 public:
  static constexpr const char* kIncomplete = "incomplete";  ///< status of a record whose files are being replaced

  /// @param record  file that names, in `files`, all that belong together: "hazard.json". If it is there, the files
  /// that it names are replaced
  /// Throws InputError if `folder` has no results, if the record is there and `overwrite` is not given, if another
  /// process is replacing the record, or if nothing can be written there. Removes what killed processes have left.
  StagedFiles(const std::filesystem::path& folder, const std::string& record, bool overwrite);
  ~StagedFiles();
  StagedFiles(const StagedFiles&) = delete;
  StagedFiles& operator=(const StagedFiles&) = delete;

  /// Where to write until `commit`.
  const std::filesystem::path& temporary() const { return staged_.hidden(); }
  /// Names of what was written so far, in the order of the alphabet.
  std::vector<std::string> files() const;
  /// The earlier files that have no successor: `commit` removes them. Call it when all new files are written.
  std::vector<std::string> to_remove() const;
  /// Gives the new files their names, in place of earlier ones, and removes the earlier files that have no successor. A
  /// program that is killed meanwhile leaves each file, earlier or new, and a record with the status `kIncomplete`.
  /// Throws std::runtime_error; what has not got its name yet then stays in `temporary`.
  void commit();

 private:
  /// Refuses a second process, and removes the hidden folders of those that were killed.
  void look_at_others() const;
  void mark_incomplete(const std::vector<std::string>& names);
  void give_name(const std::string& name);
  std::filesystem::path folder_;
  std::string record_;
  std::unique_ptr<FolderLock> lock_;  // of `temporary`; before `staged_`: given back after the folder is gone
  StagedPath staged_;
  std::vector<std::string> earlier_;
};

}  // namespace talus::io

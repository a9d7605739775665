#pragma once
#include <filesystem>
#include <vector>

namespace talus::io {

/// Folders that were made for a result. Those that are empty at the end are removed again: nothing is left behind of a
/// run that was refused.
class MadeFolders {
 public:
  MadeFolders() = default;
  ~MadeFolders();
  MadeFolders(const MadeFolders&) = delete;
  MadeFolders& operator=(const MadeFolders&) = delete;

  /// Makes a folder with all folders above it that are not there. Throws InputError if that cannot be done.
  void make(const std::filesystem::path& folder);

 private:
  std::vector<std::filesystem::path> made_;  // the outermost first
};

}  // namespace talus::io

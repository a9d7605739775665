#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "talus/io/files/made_folders.hpp"
#include "talus/io/files/staged_path.hpp"

namespace talus::io {

/// A single file of results that appears under its name complete, or not at all; `OutputFolder` is the same for
/// folders.
///
/// It is written beside its place as `.STEM.talus-PID.EXTENSION` (`StagedPath`), which `commit` renames. Without
/// `commit` it is removed.
class OutputFile {
 public:
  /// @param extension  ".gpkg": what the name must end in
  /// @param overwrite  a GeoPackage of this name may be replaced, if Talus has written it with these layers alone
  /// @param layers     that the command writes
  /// Throws InputError if the name has another extension or is taken, or if its folder cannot be made or
  /// written.
  OutputFile(const std::filesystem::path& path, const std::string& extension, bool overwrite,
             const std::vector<std::string>& layers = {});

  /// Where to write until `commit`.
  const std::filesystem::path& temporary() const { return staged_.hidden(); }

  /// Throws InputError if `input` is the file that `commit` would replace.
  void protect(const std::filesystem::path& input) const;

  /// Gives the file its name. Throws std::filesystem::filesystem_error.
  void commit();

 private:
  MadeFolders parents_;  // before `staged_`: removed after it
  StagedPath staged_;
};

}  // namespace talus::io

#pragma once
#include <filesystem>
#include <string>

#include "talus/io/files/made_folders.hpp"

namespace talus::io {

/// What is asked of a page on a run.
struct RunPageRequest {
  std::filesystem::path folder;  ///< OUT of talus run
  std::string title;             ///< empty: the name of the folder
  std::string attribution;       ///< of the terrain and the maps; empty: what the DEM states
};

/// The page of a run, one self-contained HTML file: docs/report.md. Throws InputError if the folder is none of talus
/// run, or if a file in it cannot be understood.
std::string run_page(const RunPageRequest& request);

/// The file of a page. Folders that are made for it are removed again if no page is written.
class RunPageFile {
 public:
  /// @param overwrite  a file of this name may be replaced, if it is a page of `talus report`
  /// @param folder     the results that the page shows
  /// Throws InputError if the name is taken, if its folder cannot be made or written, or if `folder` has no results.
  RunPageFile(const std::filesystem::path& file, bool overwrite, const std::filesystem::path& folder);

  /// Writes the page; it has its name when it is complete. Throws std::runtime_error.
  void write(const std::string& page) const;

 private:
  MadeFolders parents_;
  std::filesystem::path file_;
};

}  // namespace talus::io

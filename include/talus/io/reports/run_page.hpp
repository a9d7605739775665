#pragma once
#include <filesystem>
#include <string>

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

/// Throws InputError if a page cannot get this name: it is taken (unless `overwrite` is given and the file is a page of
/// `talus report`), its folder is not there, or `folder` has no results.
void check_page_name(const std::filesystem::path& file, bool overwrite, const std::filesystem::path& folder);

/// Writes a page; it has its name when it is complete. Throws std::runtime_error.
void write_run_page(const std::filesystem::path& file, const std::string& page);

}  // namespace talus::io
